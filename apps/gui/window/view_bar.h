// Above the object view: the model, the technique, what it is compared with, and how it is shown.
#pragma once

#include <QWidget>
#include <functional>
#include <vector>

#include "gui/window/desk.h"

class QComboBox;
class QToolButton;

namespace searchlight::gui {

class NumberSlider;
class Segments;

class ViewBar : public QWidget {
    Q_OBJECT

public:
    explicit ViewBar(Desk& desk, QWidget* parent = nullptr);

private:
    void refresh();
    void refillModels();
    QToolButton* makeTechniqueButton();
    QComboBox* makeBox(const QString& name, const QString& doc);
    QComboBox* makeOption(const char* option, const QString& name);

    Desk& desk_;
    QComboBox *model_, *technique_, *against_;
    Segments* compare_;
    NumberSlider* exposure_;
    NumberSlider* difference_;
    QToolButton* auto_;
    std::vector<std::function<void()>> refresh_;
};

}  // namespace searchlight::gui
