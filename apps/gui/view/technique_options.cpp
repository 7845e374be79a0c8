#include "gui/view/technique_options.h"

#include <QLabel>
#include <QPushButton>
#include <QScreen>
#include <QScrollArea>
#include <QVBoxLayout>
#include <algorithm>

#include "base/error.h"
#include "gui/window/theme.h"
#include "render/technique.h"

namespace searchlight::gui {

namespace {

constexpr int sheet_width = 360;

QString textOf(std::string_view text) { return QString::fromUtf8(text.data(), static_cast<qsizetype>(text.size())); }

}  // namespace

QString techniqueTitle(std::string_view id) {
    QString title = textOf(id).replace('_', ' ').replace('-', ' ');
    if (title.size() <= 3) return title.toUpper();
    title[0] = title[0].toUpper();
    return title;
}

TechniqueOptions::TechniqueOptions(Desk& desk, QWidget* parent) : QFrame(parent, Qt::Popup), desk_(desk) {
    setObjectName("sheet");
    setAccessibleName(tr("Options of the technique"));
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(Space::m, Space::m, Space::m, Space::m);
    column->setSpacing(Space::s);
    title_ = new QLabel(this);
    title_->setProperty("role", "heading");
    column->addWidget(title_);
    summary_ = new QLabel(this);
    summary_->setProperty("role", "muted");
    summary_->setWordWrap(true);
    column->addWidget(summary_);
    auto* area = new QScrollArea(this);
    area->setWidgetResizable(true);
    area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    auto* holder = new QWidget(area);
    rows_ = new QVBoxLayout(holder);
    rows_->setContentsMargins(0, 0, Space::s, 0);
    rows_->setSpacing(Space::xs);
    area->setWidget(holder);
    column->addWidget(area, 1);
    defaults_ = new QPushButton(tr("Defaults"), this);
    defaults_->setToolTip(tr("What the technique takes by itself"));
    column->addWidget(defaults_, 0, Qt::AlignRight);
    connect(defaults_, &QPushButton::clicked, this, [this] {
        desk_.workspace.edit(tr("Options of the technique"), {}, [](State& state) { state.technique_options.clear(); });
    });
    connect(&desk_.workspace, &Workspace::changed, this, [this](Change change) {
        if (!change.has(Part::technique)) return;
        rebuild();
        refresh();
    });
    rebuild();
    refresh();
}

void TechniqueOptions::rebuild() {
    const std::string& id = desk_.workspace.state().technique;
    if (id == built_for_) return;
    built_for_ = id;
    // A widget may be in the middle of telling of its edit.
    for (ParamWidget* widget : widgets_) widget->deleteLater();
    widgets_.clear();
    const TechniqueEntry& entry = findTechnique(id);
    title_->setText(techniqueTitle(id));
    summary_->setText(entry.options.empty() ? textOf(entry.summary) + tr(". It takes no options.")
                                            : textOf(entry.summary));
    for (const Param& param : entry.options) {
        auto* widget = new ParamWidget(desk_.theme, param, rows_->parentWidget());
        rows_->addWidget(widget);
        widgets_.push_back(widget);
        const QString text = labelOf(param);
        connect(widget, &ParamWidget::edited, this, [this, name = param.name, text](const ParamValue& value) {
            desk_.workspace.edit(text, "technique." + text,
                                 [&](State& state) { state.technique_options[name] = value; });
        });
        connect(widget, &ParamWidget::finished, &desk_.workspace, &Workspace::endGesture);
    }
    if (isVisible()) close();
}

void TechniqueOptions::refresh() {
    const ParamValues& values = desk_.workspace.state().technique_options;
    for (ParamWidget* widget : widgets_) {
        try {
            // A file may hold a value in another shape: 1 for 1.0.
            const ParamValue value = parseValue(widget->param(), valueText(valueOf(widget->param(), values)));
            if (value != widget->value()) widget->setValue(value);
        } catch (const Error&) {
            widget->setValue(widget->param().value);
        }
    }
    defaults_->setEnabled(!values.empty());
}

void TechniqueOptions::openBelow(const QWidget* button) {
    const QRect screen = button->screen()->availableGeometry();
    const QMargins margins = layout()->contentsMargins();
    summary_->setFixedWidth(sheet_width - margins.left() - margins.right());
    int high = margins.top() + margins.bottom() + 2 * Space::s;
    high += title_->sizeHint().height() + summary_->heightForWidth(summary_->width()) + defaults_->sizeHint().height();
    high += rows_->sizeHint().height() + 2 * Space::s;
    const QPoint corner = button->mapToGlobal(QPoint(button->width() - sheet_width, button->height() + Space::xs));
    resize(sheet_width, std::min(high, screen.bottom() - corner.y() - Space::s));
    move(std::clamp(corner.x(), screen.left(), std::max(screen.left(), screen.right() - sheet_width)), corner.y());
    show();
    if (!widgets_.empty()) widgets_.front()->setFocus();
    focusNextChild();
}

}  // namespace searchlight::gui
