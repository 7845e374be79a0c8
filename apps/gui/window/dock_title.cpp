#include "gui/window/dock_title.h"

#include <QDockWidget>
#include <QHBoxLayout>
#include <QLabel>
#include <QScreen>
#include <QStyle>
#include <QToolButton>
#include <algorithm>

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
    connect(button("float", tr("Pop out or in")), &QToolButton::clicked, dock, [dock] {
        const QRect before(dock->mapToGlobal(QPoint()), dock->size());
        dock->setFloating(!dock->isFloating());
        if (!dock->isFloating() || !dock->screen()) return;
        // Larger than its place, or nobody would see that it stands in front of it.
        const QSize size = before.size().expandedTo({640, 440});
        const QRect screen = dock->screen()->availableGeometry();
        QRect place(before.topLeft() - QPoint(Space::xl, Space::xl), size);
        place.moveLeft(std::max(screen.left(), std::min(place.left(), screen.right() - size.width())));
        place.moveTop(std::max(screen.top(), std::min(place.top(), screen.bottom() - size.height())));
        dock->setGeometry(place);
    });
    connect(dock, &QDockWidget::topLevelChanged, this, [this](bool floating) {
        setProperty("floating", floating);
        style()->unpolish(this);
        style()->polish(this);
    });
    connect(button("close", tr("Close")), &QToolButton::clicked, dock, &QWidget::close);
}

}  // namespace searchlight::gui
