#include "gui/window/welcome.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>
#include <QVBoxLayout>

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
    close->setIcon(desk.theme.icon("close"));
    close->setIconSize({12, 12});
    close->setAccessibleName(tr("Close the welcome"));
    close->setToolTip(tr("Close (Esc)"));
    connect(close, &QToolButton::clicked, this, &Welcome::closed);
    head->addWidget(close, 0, Qt::AlignTop);
    column->addLayout(head);
    auto* row = new QVBoxLayout;
    row->setSpacing(Space::s);
    const struct {
        const char *way, *icon, *title, *doc;
    } ways[] = {{"material", "material", "Explore a material", "Sliders, 51 measured ones"},
                {"editor", "editor", "Write a model", "Forty lines of GLSL"},
                {"compare", "wipe", "Compare with the reference", "Monte Carlo beside the model"}};
    for (const auto& way : ways) {
        auto* button = new QToolButton(this);
        button->setObjectName("segment");
        button->setProperty("first", true);
        button->setProperty("last", true);
        button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
        button->setIcon(desk.theme.icon(way.icon));
        button->setIconSize({20, 20});
        button->setMinimumHeight(40);
        button->setText(tr(way.title));
        button->setToolTip(tr(way.doc));
        button->setAccessibleDescription(tr(way.doc));
        button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
        connect(button, &QToolButton::clicked, this, [this, name = way.way] { emit chosen(name); });
        row->addWidget(button);
    }
    column->addLayout(row);
    host_->installEventFilter(this);
    place();
}

void Welcome::place() {
    // Beside the object, not over it.
    resize(std::min(256, std::max(host_->width() - 2 * Space::l, 160)), 10);
    resize(width(), layout()->heightForWidth(width()) > 0 ? layout()->heightForWidth(width()) : sizeHint().height());
    move(host_->width() - width() - Space::l, std::max(Space::xl, (host_->height() - height()) / 2));
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
