// A row of small controls, each of which shows one option of a section and sets it.
#pragma once

#include <QStringList>
#include <QWidget>
#include <functional>

#include "gui/window/desk.h"

class QAbstractButton;
class QComboBox;
class QDoubleSpinBox;

namespace searchlight::gui {

class FlowRow;

class OptionBar : public QWidget {
    Q_OBJECT

public:
    /// Of that section. Wraps where it is too narrow for one row.
    OptionBar(Desk& desk, std::string section, QWidget* parent = nullptr);

    /// A choice; `labels` in the order of the Param's choices.
    QComboBox* addChoice(const std::string& option, const QString& title, const QStringList& labels);
    /// A number with its unit; `decimals` shown.
    QDoubleSpinBox* addNumber(const std::string& option, const QString& title, int decimals, double step);
    /// A button that is down while the option is true; the icon may be empty.
    QAbstractButton* addToggle(const std::string& option, const QString& title, const QString& icon);
    /// Anything else.
    void addWidget(QWidget* widget);

private:
    const Param& param(const std::string& option) const;
    void bind(const std::string& option, QWidget* widget, std::function<void(const ParamValue&)> show);

    Desk& desk_;
    std::string section_;
    FlowRow* row_;
};

}  // namespace searchlight::gui
