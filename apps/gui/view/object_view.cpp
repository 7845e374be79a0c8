#include "gui/view/object_view.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gui/view/shown_image.h"
#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

constexpr double degrees_per_pixel = 0.4, key_degrees = 6, key_zoom = 1.12;
constexpr QRgb difference_ground = qRgb(74, 75, 78), difference_text = qRgb(233, 232, 230);
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
        setAccessibleDescription(statusText());
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

void ObjectView::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    const Colors& colors = desk_.theme.colors();
    // A little light behind the object, without colour.
    QRadialGradient stage(rect().center(), std::max(width(), height()) * 0.62);
    stage.setColorAt(0, colors.stage);
    stage.setColorAt(1, colors.canvas);
    painter.fillRect(rect(), stage);
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    const ViewPicture& shown = pictures_.shown();
    const QRectF whole(rect());
    const bool difference = comparing() && !wiping() && !shown.difference.isNull();
    // No difference is nearly white: on a dark ground in every theme.
    if (difference) painter.fillRect(rect(), QColor(difference_ground));
    painter.drawImage(whole, difference ? shown.difference : shown.a);
    if (wiping() && !shown.b.isNull()) {
        const QRectF side(wipeX(), 0, width() - wipeX(), height());
        painter.save();
        painter.setClipRect(side);
        painter.fillRect(side, stage);
        painter.drawImage(whole, shown.b);
        painter.restore();
    }
    paintLabels(painter);
    if (difference) paintScale(painter);
    if (hasFocus() && by_keys_) {
        painter.setPen(QPen(colors.accent, 1));
        painter.setBrush(Qt::NoBrush);
        painter.drawRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5));
    }
}

void ObjectView::paintLabels(QPainter& painter) {
    const Colors& colors = desk_.theme.colors();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setFont(desk_.theme.smallFont());
    const QFontMetrics metrics(painter.font());
    const auto chip = [&](const QString& text, QPointF at, Qt::Alignment side, QColor dot) {
        const double wide = metrics.horizontalAdvance(text) + 2 * Space::m + (dot.isValid() ? 14 : 0);
        const double high = metrics.height() + Space::s;
        const QRectF box(side & Qt::AlignRight ? at.x() - wide : at.x(), at.y(), wide, high);
        QColor back = colors.panel;
        back.setAlphaF(0.86F);
        painter.setPen(Qt::NoPen);
        painter.setBrush(back);
        painter.drawRoundedRect(box, high / 2, high / 2);
        double x = box.left() + Space::m;
        if (dot.isValid()) {
            painter.setBrush(dot);
            painter.drawEllipse(QPointF(x + 4, box.center().y()), 4, 4);
            x += 14;
        }
        painter.setPen(colors.text);
        painter.drawText(QRectF(x, box.top(), wide, high), Qt::AlignVCenter | Qt::AlignLeft, text);
    };
    const ViewPicture& shown = pictures_.shown();
    const State& state = desk_.workspace.state();
    if (!shown.label_a.isEmpty()) {
        chip(shown.label_a, {Space::m, Space::m}, Qt::AlignLeft, desk_.theme.seriesColor(state.activeModel().color));
        if (comparing() && !shown.label_b.isEmpty()) {
            QString label = shown.label_b;
            if (shown.walks > 0)
                label += tr(", %1 M walks, \u00b1%2 % a pixel")
                             .arg(static_cast<double>(shown.walks) * 1e-6, 0, 'g', 2)
                             .arg(100 * shown.reference_error, 0, 'g', 2);
            else if (textOption(state, "against") == "reference")
                label += tr(", walking...");
            else if (shown.partly)
                label += tr(", being summed...");
            QColor dot = colors.muted;
            const QString against = QString::fromStdString(textOption(state, "against"));
            if (against.startsWith("model ") && against.mid(6).toInt() < static_cast<int>(state.models.size()))
                dot = desk_.theme.seriesColor(state.models[static_cast<std::size_t>(against.mid(6).toInt())].color);
            chip(label, {width() - double(Space::m), Space::m}, Qt::AlignRight, dot);
        }
    }
    if (wiping() && !shown.b.isNull()) {
        painter.setPen(QPen(colors.text, 1.5));
        painter.drawLine(QPointF(wipeX(), 0), QPointF(wipeX(), height()));
        painter.setBrush(colors.panel);
        painter.drawEllipse(QPointF(wipeX(), height() / 2.0), 13, 13);
        QPainterPath arrows;
        for (const int side : {-1, 1}) {
            arrows.moveTo(wipeX() + side * 4, height() / 2.0 - 4);
            arrows.lineTo(wipeX() + side * 8, height() / 2.0);
            arrows.lineTo(wipeX() + side * 4, height() / 2.0 + 4);
        }
        painter.setBrush(Qt::NoBrush);
        painter.drawPath(arrows);
    }
    const QString status = error_.isEmpty() ? statusText() : error_;
    const bool difference = comparing() && !wiping() && !pictures_.shown().difference.isNull();
    painter.setPen(!error_.isEmpty() ? colors.error : difference ? QColor(difference_text) : colors.muted);
    painter.drawText(QRectF(Space::m, 0, width() - 2.0 * Space::m, height() - Space::s),
                     Qt::AlignBottom | Qt::AlignLeft | Qt::TextWordWrap, status);
}

void ObjectView::paintScale(QPainter& painter) {
    const double scale = std::get<double>(optionOf(desk_.workspace.state(), "view", "difference_scale"));
    constexpr int wide = 160;
    const QRectF bar(width() - wide - 2.0 * Space::xl, 56, wide, 8);
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(difference_ground).darker(140));
    painter.drawRoundedRect(bar.adjusted(-Space::l, -Space::s, Space::l, 26), Space::radius, Space::radius);
    for (int x = 0; x < wide; ++x)
        painter.fillRect(QRectF(bar.left() + x, bar.top(), 1, bar.height()),
                         QColor(differenceColor(2.0 * x / (wide - 1) - 1)));
    painter.setPen(QColor(difference_text));
    painter.setFont(desk_.theme.smallFont());
    const QRectF below = bar.adjusted(-Space::s, 12, Space::s, 20);
    painter.drawText(below, Qt::AlignLeft, tr("-%1 %").arg(scale, 0, 'g', 3));
    painter.drawText(below, Qt::AlignHCenter, "0");
    painter.drawText(below, Qt::AlignRight, tr("+%1 %").arg(scale, 0, 'g', 3));
}

QString ObjectView::statusText() const {
    const ViewPicture& shown = pictures_.shown();
    if (shown.a.isNull()) return tr("Preparing the object...");
    const State& state = desk_.workspace.state();
    const QString object = QString::fromStdString(state.scene.object).section('/', -1);
    QString text =
        tr("%1 of %2, %3 mm").arg(object, QString::fromStdString(shown.subject.name)).arg(state.scene.scale, 0, 'g', 4);
    text += tr("  \u00b7  %1 points  \u00b7  %2 ms")
                .arg(QLocale().toString(static_cast<qulonglong>(shown.report.points)))
                .arg(shown.ms, 0, 'f', 0);
    if (shown.report.technique.error_bound > 0)
        text += tr("  \u00b7  error at most %1 %").arg(100 * shown.report.technique.error_bound, 0, 'g', 2);
    if (shown.difference_rms >= 0 && comparing())
        text += tr("  \u00b7  differs by %1 % (RMS over the mean)").arg(100 * shown.difference_rms, 0, 'g', 3);
    return text;
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
