#include "gui/lights/thumbnail.h"

#include <QFileInfo>
#include <QKeyEvent>
#include <QPainter>
#include <QPainterPath>
#include <cmath>

#include "gui/view/shown_image.h"
#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

constexpr int height_px = 96, longest_px = 480;

// Every n-th pixel: a thumbnail is no place for a filter. The middle brightness becomes a middle grey.
QImage smallImage(const Image& image) {
    const int step = std::max(1, std::max(image.width, image.height) / longest_px);
    Image less(image.width / step, image.height / step);
    double sum = 0;
    for (int y = 0; y < less.height; ++y)
        for (int x = 0; x < less.width; ++x) {
            const Rgba& pixel = image.at(x * step, y * step);
            less.at(x, y) = {pixel.r, pixel.g, pixel.b, 1};
            sum += std::log2(std::max(luminance({pixel.r, pixel.g, pixel.b}), 1e-4));
        }
    ToneMap tone_map;
    tone_map.exposure = std::log2(0.25) - sum / std::max<std::size_t>(less.pixels.size(), 1);
    return shownImage(less, tone_map, "color");
}

}  // namespace

Thumbnail::Thumbnail(Desk& desk, const QString& path, QWidget* parent) : QWidget(parent), desk_(desk), path_(path) {
    setFixedHeight(height_px);
    setFocusPolicy(Qt::StrongFocus);
    setCursor(Qt::PointingHandCursor);
    setAccessibleName(tr("Picture %1").arg(QFileInfo(path).fileName()));
    setToolTip(tr("%1\nClick to choose another, or drop a picture on the window").arg(path));
    const TaskSpec spec{.lane = "thumbnails", .key = path.toStdString(), .receiver = this};
    desk_.tasks.start(
        spec,
        [this, file = path.toStdString()](TaskContext& context) {
            const QImage small = smallImage(readImage(file).image);
            context.publish([this, small] {
                image_ = small;
                update();
            });
        },
        [this](const Error& error) {
            error_ = QString::fromUtf8(error.what());
            update();
        });
}

void Thumbnail::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHints(QPainter::Antialiasing | QPainter::SmoothPixmapTransform);
    const Colors& colors = desk_.theme.colors();
    QPainterPath frame;
    frame.addRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), Space::radius, Space::radius);
    painter.setClipPath(frame);
    painter.fillPath(frame, colors.canvas);
    if (!image_.isNull()) {
        const QSizeF whole = QSizeF(image_.size()).scaled(size(), Qt::KeepAspectRatioByExpanding);
        painter.drawImage(QRectF(QPointF((width() - whole.width()) / 2, (height() - whole.height()) / 2), whole),
                          image_);
    } else {
        painter.setPen(error_.isEmpty() ? colors.muted : colors.error);
        painter.setFont(desk_.theme.smallFont());
        painter.drawText(rect().adjusted(Space::s, Space::s, -Space::s, -Space::s), Qt::AlignCenter | Qt::TextWordWrap,
                         error_.isEmpty() ? tr("Reading %1...").arg(QFileInfo(path_).fileName()) : error_);
    }
    painter.setClipping(false);
    painter.strokePath(frame, QPen(hasFocus() ? colors.accent : colors.line, 1));
}

void Thumbnail::mouseReleaseEvent(QMouseEvent*) { emit clicked(); }

void Thumbnail::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Space) return emit clicked();
    QWidget::keyPressEvent(event);
}

}  // namespace searchlight::gui
