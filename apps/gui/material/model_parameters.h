// The parameters that the active model's file declares, each with its widget.
#pragma once

#include <QWidget>
#include <vector>

#include "gui/widgets/param_widget.h"
#include "gui/window/desk.h"

class QLabel;
class QVBoxLayout;

namespace searchlight::gui {

class ModelParameters : public QWidget {
    Q_OBJECT

public:
    explicit ModelParameters(Desk& desk, QWidget* parent = nullptr);

private:
    void rebuild();
    void show();

    Desk& desk_;
    QVBoxLayout* column_;
    QLabel* title_;
    std::string built_for_;
    std::vector<ParamWidget*> widgets_;
};

}  // namespace searchlight::gui
