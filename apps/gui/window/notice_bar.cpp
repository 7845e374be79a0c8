#include "gui/window/notice_bar.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QStyle>
#include <QToolButton>

#include "gui/window/theme.h"

namespace searchlight::gui {

NoticeBar::NoticeBar(Desk& desk, QWidget* host) : QFrame(host), host_(host) {
    setObjectName("notice");
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(Space::l, Space::s, Space::s, Space::s);
    text_ = new QLabel(this);
    text_->setWordWrap(true);
    text_->setTextFormat(Qt::PlainText);
    text_->setTextInteractionFlags(Qt::TextSelectableByMouse);
    text_->setAccessibleName(tr("Notice"));
    row->addWidget(text_, 1);
    auto* close = new QToolButton(this);
    close->setIcon(desk.theme.icon("close"));
    close->setAccessibleName(tr("Close the notice"));
    close->setToolTip(tr("Close"));
    connect(close, &QToolButton::clicked, this, &QWidget::hide);
    row->addWidget(close);
    hide_.setSingleShot(true);
    connect(&hide_, &QTimer::timeout, this, &QWidget::hide);
    connect(&desk.notices, &Notices::posted, this, &NoticeBar::show);
    connect(&desk.theme, &Theme::changed, this, [close, &desk] { close->setIcon(desk.theme.icon("close")); });
    host_->installEventFilter(this);
    hide();
}

void NoticeBar::show(Notices::Level level, const QString& text) {
    text_->setText(text);
    setProperty("level", level == Notices::Level::error     ? "error"
                         : level == Notices::Level::warning ? "warning"
                                                            : "info");
    style()->unpolish(this);
    style()->polish(this);
    // Its text has its font, and so its height, once it is shown.
    QWidget::show();
    place();
    raise();
    hide_.stop();
    if (level != Notices::Level::error) hide_.start(6000);
}

void NoticeBar::place() {
    const int width = std::min(640, host_->width() - 2 * Space::xl);
    setFixedWidth(std::max(width, 120));
    const int height = heightForWidth(this->width());
    resize(this->width(), height > 0 ? height : sizeHint().height());
    // Above the line that the view writes at its bottom.
    move((host_->width() - this->width()) / 2, host_->height() - this->height() - 2 * Space::xl);
}

bool NoticeBar::eventFilter(QObject* watched, QEvent* event) {
    if (event->type() == QEvent::Resize) place();
    return QFrame::eventFilter(watched, event);
}

}  // namespace searchlight::gui
