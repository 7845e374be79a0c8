// What the technique of the object view takes: the options that its row of the program's table declares.
#pragma once

#include <QFrame>
#include <string>
#include <string_view>
#include <vector>

#include "gui/widgets/param_widget.h"
#include "gui/window/desk.h"

class QLabel;
class QPushButton;
class QVBoxLayout;

namespace searchlight::gui {

/// "Brute force" of brute_force; what is no longer than an acronym is one: "TSM".
QString techniqueTitle(std::string_view id);

/// A sheet that opens below its button, closed by Escape or a click elsewhere. A row per option, built anew when
/// another technique is chosen; every change is a step of undo.
class TechniqueOptions : public QFrame {
    Q_OBJECT

public:
    TechniqueOptions(Desk& desk, QWidget* parent);

    /// Below that widget, within its screen.
    void openBelow(const QWidget* button);

private:
    void rebuild();
    void refresh();

    Desk& desk_;
    std::string built_for_;
    QLabel *title_, *summary_;
    QVBoxLayout* rows_;
    QPushButton* defaults_;
    std::vector<ParamWidget*> widgets_;
};

}  // namespace searchlight::gui
