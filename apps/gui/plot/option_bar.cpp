#include "gui/plot/option_bar.h"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QSignalBlocker>
#include <QToolButton>
#include <algorithm>

#include "gui/widgets/flow_row.h"
#include "gui/window/theme.h"

namespace searchlight::gui {

OptionBar::OptionBar(Desk& desk, std::string section, QWidget* parent)
    : QWidget(parent), desk_(desk), section_(std::move(section)) {
    row_ = new FlowRow(this);
    // Nothing at the right: at 1280 pixels all tools of the plot stand in one row.
    row_->setContentsMargins(Space::s, Space::xs, 0, Space::xs);
}

const Param& OptionBar::param(const std::string& option) const {
    const auto found = std::ranges::find(sections(), section_, &Section::name);
    return findParam(found->options, option, "option");
}

void OptionBar::bind(const std::string& option, QWidget* widget, std::function<void(const ParamValue&)> show) {
    const Param& about = param(option);
    widget->setObjectName(QString::fromStdString(section_ + "." + option));
    if (widget->toolTip().isEmpty()) widget->setToolTip(QString::fromStdString(about.doc));
    widget->setAccessibleDescription(QString::fromStdString(about.doc));
    const auto refresh = [this, widget, option, show = std::move(show)] {
        const QSignalBlocker quiet(widget);
        show(optionOf(desk_.workspace.state(), section_, option));
    };
    refresh();
    connect(&desk_.workspace, &Workspace::changed, widget, [refresh](Change change) {
        if (change.has(Part::options)) refresh();
    });
    addWidget(widget);
}

QComboBox* OptionBar::addChoice(const std::string& option, const QString& title, const QStringList& labels) {
    auto* box = new QComboBox(this);
    box->setAccessibleName(title);
    const std::vector<std::string> choices = param(option).choices;
    for (int i = 0; i < labels.size(); ++i) box->addItem(labels[i]);
    connect(box, &QComboBox::activated, this, [this, option, title, choices](int index) {
        desk_.workspace.setOption(title, section_, option, choices[static_cast<std::size_t>(index)]);
        desk_.workspace.endGesture();
    });
    bind(option, box, [box, choices](const ParamValue& value) {
        const auto at = std::ranges::find(choices, std::get<std::string>(value)) - choices.begin();
        box->setCurrentIndex(static_cast<int>(at));
    });
    return box;
}

QDoubleSpinBox* OptionBar::addNumber(const std::string& option, const QString& title, int decimals, double step) {
    auto* box = new QDoubleSpinBox(this);
    const Param& about = param(option);
    box->setAccessibleName(title);
    box->setRange(about.min, about.max);
    box->setDecimals(decimals);
    box->setSingleStep(step);
    box->setKeyboardTracking(false);
    const QString unit = QString::fromStdString(about.unit);
    if (unit == QLatin1String("deg"))
        box->setSuffix(QStringLiteral("°"));
    else if (!unit.isEmpty())
        box->setSuffix(QLatin1Char(' ') + unit);
    connect(box, &QDoubleSpinBox::valueChanged, this, [this, option, title](double value) {
        desk_.workspace.edit(title, QString::fromStdString(section_ + "." + option),
                             [&](State& state) { state.options[section_][option] = value; });
    });
    connect(box, &QDoubleSpinBox::editingFinished, &desk_.workspace, &Workspace::endGesture);
    bind(option, box, [box](const ParamValue& value) { box->setValue(std::get<double>(value)); });
    return box;
}

QAbstractButton* OptionBar::addToggle(const std::string& option, const QString& title, const QString& icon) {
    auto* button = new QToolButton(this);
    button->setCheckable(true);
    button->setText(title);
    button->setAccessibleName(title);
    if (!icon.isEmpty()) {
        button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
        const auto paint = [this, button, icon] { button->setIcon(desk_.theme.icon(icon)); };
        paint();
        connect(&desk_.theme, &Theme::changed, button, paint);
    }
    connect(button, &QAbstractButton::toggled, this, [this, option, title](bool on) {
        desk_.workspace.setOption(title, section_, option, on);
        desk_.workspace.endGesture();
    });
    bind(option, button, [button](const ParamValue& value) { button->setChecked(std::get<bool>(value)); });
    return button;
}

void OptionBar::addWidget(QWidget* widget) { row_->addWidget(widget); }

}  // namespace searchlight::gui
