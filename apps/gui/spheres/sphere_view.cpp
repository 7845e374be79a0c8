#include "gui/spheres/sphere_view.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>

#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

constexpr int kTitle = 22, kNote = 18;
// Of a picture that frames a sphere: without most of the empty space around it.
constexpr double kShownPart = 0.78;

// Columns that leave the largest squares.
int columnsFor(int panels, int width, int height) {
    int best = 1;
    double best_side = 0;
    for (int columns = 1; columns <= panels; ++columns) {
        const int rows = (panels + columns - 1) / columns;
        const double side =
            std::min(static_cast<double>(width) / columns, static_cast<double>(height) / rows - kTitle - kNote);
        if (side > best_side) {
            best_side = side;
            best = columns;
        }
    }
    return best;
}

}  // namespace

SphereView::SphereView(Desk& desk, QWidget* parent) : QWidget(parent), desk_(desk) {
    setFocusPolicy(Qt::StrongFocus);
    setAccessibleName(tr("Lit spheres"));
    setToolTip(tr("Drag: turn both, with the object"));
    connect(&desk_.theme, &Theme::changed, this, qOverload<>(&QWidget::update));
}

void SphereView::setPanels(QList<Panel> panels, const QString& empty_text) {
    panels_ = std::move(panels);
    empty_text_ = empty_text;
    QStringList heard;
    for (const Panel& panel : panels_) heard << panel.title + QStringLiteral(": ") + panel.note;
    setAccessibleDescription(heard.join(QStringLiteral("; ")));
    update();
}

int SphereView::pictureSide(int panels) const {
    const int columns = columnsFor(panels, width(), height()), rows = (panels + columns - 1) / columns;
    const int side = std::min(width() / columns - Space::s, height() / rows - kTitle - kNote);
    return static_cast<int>(std::clamp(side, 48, 480) * devicePixelRatioF() / kShownPart);
}

void SphereView::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    const Colors& colors = desk_.theme.colors();
    painter.fillRect(rect(), colors.canvas);
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    const int count = static_cast<int>(panels_.size());
    if (count == 0) {
        painter.setPen(colors.muted);
        painter.drawText(rect().adjusted(24, 24, -24, -24), Qt::AlignCenter | Qt::TextWordWrap, empty_text_);
        return;
    }
    const int columns = columnsFor(count, width(), height()), rows = (count + columns - 1) / columns;
    const double wide = static_cast<double>(width()) / columns, high = static_cast<double>(height()) / rows;
    for (int i = 0; i < count; ++i) {
        const Panel& panel = panels_[i];
        const QRectF cell((i % columns) * wide, (i / columns) * high, wide, high);
        const QRectF title(cell.left() + 4, cell.top() + 2, wide - 8, kTitle);
        const QRectF note(cell.left() + 4, cell.bottom() - kNote - 2, wide - 8, kNote);
        painter.setFont(desk_.theme.textFont());
        painter.setPen(colors.text);
        painter.drawText(title, Qt::AlignCenter,
                         painter.fontMetrics().elidedText(panel.title, Qt::ElideRight, static_cast<int>(wide) - 8));
        painter.setFont(desk_.theme.smallFont());
        painter.setPen(colors.muted);
        painter.drawText(note, Qt::AlignCenter,
                         painter.fontMetrics().elidedText(panel.note, Qt::ElideRight, static_cast<int>(wide) - 8));
        const double side = std::min(wide - Space::s, high - kTitle - kNote);
        const QRectF place(cell.center().x() - 0.5 * side, cell.top() + kTitle + 0.5 * (high - kTitle - kNote - side),
                           side, side);
        if (!panel.picture.isNull()) {
            const QSizeF whole(panel.picture.size());
            const QPointF corner(0.5 * (1 - kShownPart) * whole.width(), 0.5 * (1 - kShownPart) * whole.height());
            painter.drawImage(place, panel.picture, QRectF(corner, kShownPart * whole));
        } else {
            painter.drawText(place, Qt::AlignCenter | Qt::TextWordWrap, empty_text_);
        }
    }
}

void SphereView::turn(double right_deg, double up_deg) {
    desk_.workspace.edit(tr("Camera"), QStringLiteral("spheres.camera"), [&](State& state) {
        Camera& camera = state.scene.camera;
        camera.azimuth_deg = std::remainder(camera.azimuth_deg - right_deg, 360.0);
        camera.elevation_deg = std::clamp(camera.elevation_deg + up_deg, -89.0, 89.0);
    });
}

void SphereView::mousePressEvent(QMouseEvent* event) {
    turning_ = event->button() == Qt::LeftButton;
    last_ = event->position();
}

void SphereView::mouseMoveEvent(QMouseEvent* event) {
    if (!turning_) return;
    const QPointF moved = event->position() - last_;
    last_ = event->position();
    turn(0.5 * moved.x(), 0.5 * moved.y());
}

void SphereView::mouseReleaseEvent(QMouseEvent*) {
    if (turning_) desk_.workspace.endGesture();
    turning_ = false;
}

void SphereView::keyPressEvent(QKeyEvent* event) {
    constexpr double step = 5;
    switch (event->key()) {
        case Qt::Key_Left: return turn(-step, 0);
        case Qt::Key_Right: return turn(step, 0);
        case Qt::Key_Up: return turn(0, -step);
        case Qt::Key_Down: return turn(0, step);
        default: QWidget::keyPressEvent(event);
    }
}

}  // namespace searchlight::gui
