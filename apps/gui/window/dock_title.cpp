#include "gui/window/dock_title.h"

#include <QDockWidget>
#include <QHBoxLayout>
#include <QLabel>
#include <QToolButton>

#include "gui/window/theme.h"

namespace searchlight::gui {

DockTitle::DockTitle(Theme& theme, QDockWidget* dock) : QWidget(dock) {
    setObjectName("dock_title");
    setAttribute(Qt::WA_StyledBackground);
    setFixedHeight(30);
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(Space::m, 0, Space::xs, 0);
    row->setSpacing(0);
    auto* title = new QLabel(dock->windowTitle(), this);
    connect(dock, &QWidget::windowTitleChanged, title, &QLabel::setText);
    row->addWidget(title, 1);
    const auto button = [&](const char* icon, const QString& tip) {
        auto* made = new QToolButton(this);
        made->setIconSize({14, 14});
        made->setToolTip(tip);
        made->setAccessibleName(tr("%1 %2").arg(tip, dock->windowTitle()));
        made->setFocusPolicy(Qt::TabFocus);
        const auto draw = [made, icon, &theme] { made->setIcon(theme.icon(icon)); };
        draw();
        connect(&theme, &Theme::changed, made, draw);
        row->addWidget(made);
        return made;
    };
    connect(button("float", tr("Pop out or in")), &QToolButton::clicked, dock,
            [dock] { dock->setFloating(!dock->isFloating()); });
    connect(button("close", tr("Close")), &QToolButton::clicked, dock, &QWidget::close);
}

}  // namespace searchlight::gui
