#include "gui/window/seen.h"

#include <QDockWidget>
#include <QEvent>

namespace searchlight::gui {

Seen::Seen(QWidget* body) : body_(body) { body->installEventFilter(this); }

bool Seen::eventFilter(QObject* watched, QEvent* event) {
    if (event->type() == QEvent::Show) {
        if (auto* dock = qobject_cast<QDockWidget*>(body_->parentWidget()))
            connect(dock, &QDockWidget::visibilityChanged, this, &Seen::set, Qt::UniqueConnection);
        else
            set(true);
    } else if (event->type() == QEvent::Hide) {
        set(false);
    }
    return QObject::eventFilter(watched, event);
}

void Seen::set(bool seen) {
    if (seen == now_) return;
    now_ = seen;
    emit changed(seen);
}

}  // namespace searchlight::gui
