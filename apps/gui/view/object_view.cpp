#include "gui/view/object_view.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

constexpr double degrees_per_pixel = 0.4, key_degrees = 6, key_zoom = 1.12;
constexpr double radians = std::numbers::pi / 180;

Vec3 turned(Vec3 v, Vec3 axis, double angle) {
    // Rodrigues' formula, for a unit axis.
    return std::cos(angle) * v + std::sin(angle) * cross(axis, v) + ((1 - std::cos(angle)) * dot(axis, v)) * axis;
}

struct Frame {
    Vec3 right, up;
};

Frame frameOf(const Camera& camera) {
    const double a = camera.azimuth_deg * radians, e = camera.elevation_deg * radians;
    const Vec3 out{std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
    const Vec3 right{std::cos(a), 0, -std::sin(a)};
    return {right, cross(out, right)};
}

double wrapped(double degrees) { return std::remainder(degrees, 360); }

const std::string& textOption(const State& state, const char* name) {
    return std::get<std::string>(optionOf(state, "view", name));
}

}  // namespace

ObjectView::ObjectView(Desk& desk, QWidget* parent) : QWidget(parent), desk_(desk), pictures_(desk) {
    setObjectName("object_view");
    setAccessibleName(tr("Object view"));
    setAccessibleDescription(
        tr("The object as it is rendered. Arrow keys turn it, with Ctrl the light, plus and minus zoom, F frames it."));
    setFocusPolicy(Qt::StrongFocus);
    setMinimumSize(320, 240);
    setAttribute(Qt::WA_OpaquePaintEvent);
    setCursor(Qt::OpenHandCursor);
    connect(&pictures_, &PictureService::pictureShown, this, [this] {
        error_.clear();
        setAccessibleDescription(statusText(true));
        update();
    });
    connect(&pictures_, &PictureService::failed, this, [this](const QString& text) {
        error_ = text;
        update();
    });
    connect(&desk_.theme, &Theme::changed, this, qOverload<>(&QWidget::update));
    connect(&desk_.workspace, &Workspace::changed, this, qOverload<>(&QWidget::update));
}

void ObjectView::resizeEvent(QResizeEvent*) { pictures_.setSize(size() * devicePixelRatioF()); }

void ObjectView::changeEvent(QEvent* event) {
    if (event->type() == QEvent::ScreenChangeInternal) pictures_.setSize(size() * devicePixelRatioF());
    QWidget::changeEvent(event);
}

void ObjectView::focusInEvent(QFocusEvent* event) {
    by_keys_ = event->reason() == Qt::TabFocusReason || event->reason() == Qt::BacktabFocusReason;
    QWidget::focusInEvent(event);
}

bool ObjectView::comparing() const { return textOption(desk_.workspace.state(), "compare") != "none"; }
bool ObjectView::wiping() const { return textOption(desk_.workspace.state(), "compare") == "wipe"; }
double ObjectView::wipeX() const {
    return std::get<double>(optionOf(desk_.workspace.state(), "view", "wipe")) * width();
}

void ObjectView::orbit(QPointF degrees) {
    desk_.workspace.edit(tr("Orbit"), "view.camera", [&](State& state) {
        Camera& camera = state.scene.camera;
        camera.azimuth_deg = wrapped(camera.azimuth_deg - degrees.x());
        camera.elevation_deg = std::clamp(camera.elevation_deg + degrees.y(), -89.0, 89.0);
    });
}

void ObjectView::turnLight(QPointF degrees) {
    desk_.workspace.edit(tr("Turn the light"), "view.light", [&](State& state) {
        if (state.scene.lights.empty()) return;
        const Frame frame = frameOf(state.scene.camera);
        const auto turn = [&](Vec3 v) {
            return turned(turned(v, frame.up, degrees.x() * radians), frame.right, degrees.y() * radians);
        };
        // The first light is the key light; an environment turns about the vertical alone.
        Light& light = state.scene.lights.front();
        if (auto* directional = std::get_if<DirectionalLight>(&light))
            directional->direction = turn(directional->direction);
        else if (auto* point = std::get_if<PointLight>(&light))
            point->position = turn(point->position);
        else if (auto* environment = std::get_if<EnvironmentLight>(&light))
            environment->rotation_deg = wrapped(environment->rotation_deg + degrees.x());
    });
}

void ObjectView::pan(QPointF pixels) {
    const double distance = std::max(pictures_.shown().report.camera.distance, 0.1);
    desk_.workspace.edit(tr("Move the view"), "view.pan", [&](State& state) {
        Camera& camera = state.scene.camera;
        const Frame frame = frameOf(camera);
        const double unit = 2 * distance * std::tan(camera.field_of_view_deg * radians / 2) / std::max(height(), 1);
        camera.distance = distance;
        camera.target = camera.target - (pixels.x() * unit) * frame.right + (pixels.y() * unit) * frame.up;
    });
}

void ObjectView::zoom(double factor) {
    const double shown = pictures_.shown().report.camera.distance;
    desk_.workspace.edit(tr("Zoom"), "view.zoom", [&](State& state) {
        Camera& camera = state.scene.camera;
        const double distance = camera.distance > 0 ? camera.distance : shown;
        if (distance > 0) camera.distance = std::clamp(distance / factor, 0.05, 100.0);
    });
}

void ObjectView::frame() {
    desk_.workspace.edit(tr("Frame the object"), {}, [](State& state) {
        state.scene.camera.distance = 0;
        state.scene.camera.target = {};
    });
}

void ObjectView::setWipe(double at) {
    desk_.workspace.setOption(tr("Wipe"), "view", "wipe", std::clamp(at / std::max(width(), 1), 0.0, 1.0));
}

void ObjectView::mousePressEvent(QMouseEvent* event) {
    last_ = event->position();
    const bool control = event->modifiers().testFlag(Qt::ControlModifier);
    const bool shift = event->modifiers().testFlag(Qt::ShiftModifier);
    if (wiping() && event->button() == Qt::LeftButton && std::abs(last_.x() - wipeX()) < 14)
        drag_ = Drag::wipe;
    else if (event->button() == Qt::RightButton || (event->button() == Qt::LeftButton && control))
        drag_ = Drag::light;
    else if (event->button() == Qt::MiddleButton || (event->button() == Qt::LeftButton && shift))
        drag_ = Drag::pan;
    else if (event->button() == Qt::LeftButton)
        drag_ = Drag::orbit;
    setCursor(drag_ == Drag::wipe ? Qt::SplitHCursor : Qt::ClosedHandCursor);
}

void ObjectView::mouseMoveEvent(QMouseEvent* event) {
    const QPointF moved = event->position() - last_;
    last_ = event->position();
    switch (drag_) {
        case Drag::orbit: orbit(degrees_per_pixel * moved); break;
        case Drag::light: turnLight(degrees_per_pixel * moved); break;
        case Drag::pan: pan(moved); break;
        case Drag::wipe: setWipe(last_.x()); break;
        case Drag::none: break;
    }
}

void ObjectView::mouseReleaseEvent(QMouseEvent*) {
    drag_ = Drag::none;
    setCursor(Qt::OpenHandCursor);
    desk_.workspace.endGesture();
}

void ObjectView::wheelEvent(QWheelEvent* event) {
    zoom(std::pow(key_zoom, event->angleDelta().y() / 120.0));
    event->accept();
}

void ObjectView::keyPressEvent(QKeyEvent* event) {
    QPointF step;
    switch (event->key()) {
        case Qt::Key_Left: step = {-key_degrees, 0}; break;
        case Qt::Key_Right: step = {key_degrees, 0}; break;
        case Qt::Key_Up: step = {0, -key_degrees}; break;
        case Qt::Key_Down: step = {0, key_degrees}; break;
        case Qt::Key_Plus:
        case Qt::Key_Equal: zoom(key_zoom); return;
        case Qt::Key_Minus: zoom(1 / key_zoom); return;
        case Qt::Key_F: frame(); return;
        default: QWidget::keyPressEvent(event); return;
    }
    if (event->modifiers().testFlag(Qt::ControlModifier))
        turnLight(step);
    else if (event->modifiers().testFlag(Qt::ShiftModifier))
        pan(4 * step);
    else if (event->modifiers().testFlag(Qt::AltModifier))
        setWipe(wipeX() + step.x() * 4);
    else
        orbit(step);
}

}  // namespace searchlight::gui
