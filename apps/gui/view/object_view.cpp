#include "gui/view/object_view.h"

#include <QPainter>

#include "gui/window/theme.h"

namespace searchlight::gui {

ObjectView::ObjectView(Desk& desk, QWidget* parent) : QWidget(parent), desk_(desk) {
    setObjectName("object_view");
    setMinimumSize(320, 240);
}

void ObjectView::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.fillRect(rect(), desk_.theme.colors().canvas);
    painter.drawImage(rect(), picture_);
}

}  // namespace searchlight::gui
