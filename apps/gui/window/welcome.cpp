#include "gui/window/welcome.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>
#include <QVBoxLayout>
#include <utility>
#include <vector>

#include "gui/window/theme.h"

namespace searchlight::gui {

Welcome::Welcome(Desk& desk, QWidget* host) : QFrame(host), host_(host) {
    setObjectName("card");
    setAccessibleName(tr("Welcome"));
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(Space::l, Space::m, Space::l, Space::l);
    column->setSpacing(Space::s);
    auto* head = new QHBoxLayout;
    auto* title = new QLabel(tr("Drag to turn it, drag with the right button to turn the light. And then?"), this);
    title->setProperty("role", "heading");
    title->setWordWrap(true);
    head->addWidget(title, 1);
    auto* close = new QToolButton(this);
    close->setIconSize({12, 12});
    close->setAccessibleName(tr("Close the welcome"));
    close->setToolTip(tr("Close (Esc)"));
    connect(close, &QToolButton::clicked, this, &Welcome::closed);
    head->addWidget(close, 0, Qt::AlignTop);
    column->addLayout(head);
    ways_ = new QBoxLayout(QBoxLayout::TopToBottom);
    ways_->setSpacing(Space::s);
    std::vector<std::pair<QToolButton*, QString>> icons{{close, "close"}};
    const struct {
        const char *way, *icon, *title, *doc;
    } ways[] = {{"material", "material", "Explore a material", "Measured ones, and sliders"},
                {"editor", "editor", "Write a model", "Forty lines of GLSL"},
                {"compare", "wipe", "Compare with the reference", "Monte Carlo beside the model"}};
    for (const auto& way : ways) {
        auto* button = new QToolButton(this);
        button->setObjectName("segment");
        button->setProperty("first", true);
        button->setProperty("last", true);
        button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
        icons.emplace_back(button, way.icon);
        button->setIconSize({20, 20});
        button->setMinimumHeight(40);
        button->setText(tr(way.title));
        button->setToolTip(tr(way.doc));
        button->setAccessibleDescription(tr(way.doc));
        button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
        connect(button, &QToolButton::clicked, this, [this, name = way.way] { emit chosen(name); });
        ways_->addWidget(button);
    }
    column->addLayout(ways_);
    const auto draw = [&theme = desk.theme, icons] {
        for (const auto& [button, name] : icons) button->setIcon(theme.icon(name));
    };
    draw();
    connect(&desk.theme, &Theme::changed, this, draw);
    host_->installEventFilter(this);
    place();
}

void Welcome::place() {
    // Beside the statue, which is two fifths as wide as the view is high; where there is no room, below it, if there is
    // room for three buttons in a row.
    constexpr int beside_width = 256;
    constexpr int strip_width = 600;
    const bool beside =
        host_->width() / 2 - host_->height() / 5 >= beside_width + Space::l || host_->width() < strip_width;
    ways_->setDirection(beside ? QBoxLayout::TopToBottom : QBoxLayout::LeftToRight);
    const int widest = beside ? beside_width : strip_width + 40;
    resize(std::min(widest, std::max(host_->width() - 2 * Space::l, 160)), 10);
    resize(width(), layout()->heightForWidth(width()) > 0 ? layout()->heightForWidth(width()) : sizeHint().height());
    if (beside)
        move(host_->width() - width() - Space::l, std::max(Space::xl, (host_->height() - height()) / 2));
    else
        move((host_->width() - width()) / 2, host_->height() - height() - 2 * Space::l);
}

bool Welcome::eventFilter(QObject* watched, QEvent* event) {
    if (event->type() == QEvent::Resize) place();
    return QFrame::eventFilter(watched, event);
}

void Welcome::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Escape) return emit closed();
    QFrame::keyPressEvent(event);
}

}  // namespace searchlight::gui
