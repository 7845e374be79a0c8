#include "gui/plot/figure_view.h"

#include <fmt/format.h>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "draw/figure_texts.h"
#include "draw/legend.h"
#include "draw/plot_area.h"
#include "draw/text_width.h"
#include "gui/plot/figure_ink.h"
#include "gui/plot/read_out.h"
#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

constexpr double margin = 10;

// Where an axis' own scale is even: logarithms, square roots.
double toEven(AxisScale scale, double value) {
    if (scale == AxisScale::logarithmic) return std::log10(value);
    return scale == AxisScale::square_root ? std::copysign(std::sqrt(std::abs(value)), value) : value;
}

double fromEven(AxisScale scale, double value) {
    if (scale == AxisScale::logarithmic) return std::pow(10.0, value);
    return scale == AxisScale::square_root ? std::copysign(value * value, value) : value;
}

// The part of [min, max] around the fraction `t` of its length, `factor` times as long, moved by `shift` lengths.
bool zoomInterval(AxisScale scale, double t, double factor, double shift, double& min, double& max) {
    const double low = toEven(scale, min), high = toEven(scale, max), span = high - low, at = low + t * span;
    const double new_low = fromEven(scale, at - factor * t * span + shift * span);
    const double new_high = fromEven(scale, at + factor * (1 - t) * span + shift * span);
    if (!canShow(scale, new_low) || !canShow(scale, new_high)) return false;
    if (!(new_high - new_low > 1e-9 * std::max(std::abs(new_low), std::abs(new_high)))) return false;
    min = new_low;
    max = new_high;
    return true;
}

}  // namespace

FigureView::FigureView(Desk& desk, QWidget* parent) : QWidget(parent), desk_(desk), theme_(desk.theme) {
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setAccessibleName(tr("Searchlight plot"));
    connect(&theme_, &Theme::changed, this, [this] {
        requestPage();
        update();
    });
}

bool FigureView::isEmpty() const { return figure_.series.empty() && figure_.panels.empty() && !figure_.map; }

bool FigureView::isSingle() const { return !figure_.series.empty() && figure_.panels.empty() && !figure_.map; }

void FigureView::setFigure(Figure figure, const QString& empty_text) {
    const auto same = [](const Axis& a, const Axis& b) { return a.label == b.label && a.scale == b.scale; };
    if (!same(figure.x, figure_.x) || !same(figure.y, figure_.y)) zoomed_.reset();
    figure_ = std::move(figure);
    empty_text_ = empty_text;
    requestPage();
    setToolTip(isSingle() ? tr("Wheel: zoom. Drag: move. Double click: all of it.") : QString());
    setCursor(cursor_);
    QString heard = QString::fromStdString(figure_.title);
    for (const Series& series : figure_.series) heard += QStringLiteral("; ") + QString::fromStdString(series.label);
    setAccessibleDescription(isEmpty() ? empty_text_ : heard);
    update();
}

std::optional<FigureRange> FigureView::shownRange() const {
    if (!isSingle()) return {};
    if (zoomed_) return zoomed_;
    try {
        return figureRange(figure_);
    } catch (const Error&) {
        return {};
    }
}

void FigureView::resetZoom() {
    zoomed_.reset();
    update();
}

Rect FigureView::frameOf(const FigureRange& range) const {
    double labels = 0;
    const AxisTicks ticks = ticksOf(figure_.y, range.y_min, range.y_max, std::max(3, height() / 64));
    for (const Tick& tick : ticks.ticks) labels = std::max(labels, labelWidth(tick));
    const double left = margin + (labelStandsAbove() ? 0 : label_size + 8) + labels + 7;
    const double top = margin + (labelStandsAbove() ? 18 : ticks.factor != 0 ? 16 : 4);
    return {std::round(left) + 0.5, std::round(top) + 0.5,
            std::max(left + 40, width() - margin - 6.0 - legend_room_) + 0.5,
            std::max(top + 40, height() - margin - 36.0) + 0.5};
}

bool FigureView::labelStandsAbove() const {
    return textWidth(axisText(figure_.y), label_size) > height() - 2 * margin - 40;
}

void FigureView::zoom(double factor, QPointF about) {
    auto range = shownRange();
    if (!range) return;
    const Rect frame = frameOf(*range);
    const double tx = std::clamp((about.x() - frame.left) / frame.width(), 0.0, 1.0);
    const double ty = std::clamp((frame.bottom - about.y()) / frame.height(), 0.0, 1.0);
    if (zoomInterval(figure_.x.scale, tx, factor, 0, range->x_min, range->x_max) &&
        zoomInterval(figure_.y.scale, ty, factor, 0, range->y_min, range->y_max))
        zoomed_ = range;
    update();
}

void FigureView::moveBy(QPointF pixels) {
    auto range = shownRange();
    if (!range) return;
    const Rect frame = frameOf(*range);
    if (zoomInterval(figure_.x.scale, 0, 1, -pixels.x() / frame.width(), range->x_min, range->x_max) &&
        zoomInterval(figure_.y.scale, 0, 1, pixels.y() / frame.height(), range->y_min, range->y_max))
        zoomed_ = range;
    update();
}

void FigureView::setCursor(std::optional<QPointF> at) {
    cursor_ = at;
    read_out_.clear();
    if (!at) return;
    if (!isSingle()) return readPanels(*at);
    const auto range = shownRange();
    if (!range) return;
    const Rect frame = frameOf(*range);
    if (!frame.contains({at->x(), at->y()})) return;
    double x = range->x_min, x_end = range->x_max;
    if (!zoomInterval(figure_.x.scale, (at->x() - frame.left) / frame.width(), 1e-7, 0, x, x_end)) return;
    read_out_ = readSeries(figure_, x);
}

// All maps at the place under the cursor in one of them.
void FigureView::readPanels(QPointF at) {
    if (isEmpty() || !page_ || page_->size != size()) return;
    const Point on_paper{(at.x() - page_->offset.x()) / page_->scale, (at.y() - page_->offset.y()) / page_->scale};
    for (const PanelFrame& frame : page_->frames) {
        if (!frame.rect.contains(on_paper)) continue;
        const double tx = (on_paper.x - frame.rect.left) / frame.rect.width();
        const double ty = (frame.rect.bottom - on_paper.y) / frame.rect.height();
        read_out_ = readMaps(figure_, frame.x_min + tx * (frame.x_max - frame.x_min),
                             frame.y_min + ty * (frame.y_max - frame.y_min));
    }
}

void FigureView::paintSingle(QPainter& painter) {
    const auto range = shownRange();
    if (!range) return;
    const AxisTicks y_ticks = ticksOf(figure_.y, range->y_min, range->y_max, std::max(3, height() / 64));
    const std::vector<LegendEntry> entries = legendEntries(figure_);
    const LegendSize legend = legendSize(entries);
    // A legend that would cover most of a small plot is left to the list of models.
    const bool has_legend = !entries.empty() && legend.width < 0.75 * width() && legend.height < 0.7 * height();
    constexpr int bearable = 6;  // points of lines under the legend
    std::vector<Shape> shapes;
    legend_room_ = 0;
    while (true) {
        const Rect frame = frameOf(*range);
        const AxisTicks x_ticks =
            ticksOf(figure_.x, range->x_min, range->x_max, std::max(3, static_cast<int>(frame.width() / 80)));
        const PlotArea plot(figure_, frame, *range, x_ticks, y_ticks);
        DrawnData drawn;
        shapes.clear();
        plot.drawGrid(shapes);
        plot.drawSeries(shapes, drawn);
        plot.drawAxes(shapes);
        if (x_ticks.factor != 0) drawFactor(shapes, {frame.right - 40, frame.bottom + 36}, x_ticks.factor);
        if (!has_legend) break;
        const double left = frame.right + Space::s;
        if (legend_room_ > 0) {
            drawLegend(shapes, entries, {left, frame.top, left + legend.width, frame.top + legend.height});
            break;
        }
        const LegendPlace place = placeLegend(legend, frame, drawn);
        if ((!legend_beside_ && place.covered <= bearable) || frame.width() - legend.width < 200) {
            drawLegend(shapes, entries, place.box);
            break;
        }
        legend_room_ = legend.width + Space::s;
    }
    const Rect frame = frameOf(*range);
    shapes.push_back(Text{
        {0.5 * (frame.left + frame.right), frame.bottom + 36}, axisText(figure_.x), label_size, Anchor::middle, ink});
    const bool above = labelStandsAbove();
    const Point label =
        above ? Point{frame.left, frame.top - 6} : Point{margin + label_size - 3, 0.5 * (frame.top + frame.bottom)};
    shapes.push_back(
        Text{label, axisText(figure_.y), label_size, above ? Anchor::start : Anchor::middle, ink, false, !above});
    const double after_label = above ? textWidth(axisText(figure_.y), label_size) + 12 : 0;
    if (y_ticks.factor != 0) drawFactor(shapes, {frame.left + after_label, frame.top - 5}, y_ticks.factor);
    paintShapes(painter, shapes, figureInk(theme_));
    if (!cursor_ || read_out_.isEmpty()) return;
    painter.setPen(QPen(theme_.colors().muted, 1, Qt::DotLine));
    painter.drawLine(QPointF(cursor_->x(), frame.top), QPointF(cursor_->x(), frame.bottom));
    paintReadOut(painter, theme_, read_out_, *cursor_, QRectF(frame.left, frame.top, frame.width(), frame.height()));
}

// The page of before is shown until the next one is made, so that maps do not flicker while a slider moves.
void FigureView::requestPage() {
    const bool wanted = !isEmpty() && !isSingle() && !size().isEmpty();
    const std::string key = fmt::format("page {}", static_cast<const void*>(this));
    if (!wanted) {
        if (page_) desk_.tasks.cancel("pages", key);
        page_.reset();
        return;
    }
    const auto work = [this, figure = figure_, size = size(), ratio = devicePixelRatioF(),
                       ink = figureInk(theme_)](TaskContext& context) {
        auto page = std::make_shared<const PanelPage>(makePanelPage(figure, size, ratio, ink, context));
        context.publish([this, page] {
            page_ = page;
            if (cursor_) setCursor(cursor_);
            update();
        });
    };
    desk_.tasks.start({.lane = "pages", .key = key, .receiver = this}, work);
}

void FigureView::resizeEvent(QResizeEvent*) { requestPage(); }

void FigureView::changeEvent(QEvent* event) {
    if (event->type() == QEvent::ScreenChangeInternal) requestPage();
    QWidget::changeEvent(event);
}

void FigureView::paintPanels(QPainter& painter) {
    if (!page_) return;
    if (!page_->problem.empty()) throw inputError(page_->problem);
    painter.drawImage(QRectF(rect()), page_->image);
    if (cursor_ && !read_out_.isEmpty()) paintReadOut(painter, theme_, read_out_, *cursor_, QRectF(rect()));
}

void FigureView::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.fillRect(rect(), theme_.colors().panel);
    QString text = empty_text_;
    try {
        if (isSingle() && shownRange())
            paintSingle(painter);
        else if (!isEmpty())
            paintPanels(painter);
        else
            painter.setPen(theme_.colors().muted);
        if (!isEmpty()) return;
    } catch (const Error& error) {
        text = QString::fromStdString(error.message);
    }
    painter.resetTransform();
    painter.setPen(theme_.colors().muted);
    painter.setFont(theme_.textFont());
    painter.drawText(rect().adjusted(24, 24, -24, -24), Qt::AlignCenter | Qt::TextWordWrap, text);
}

void FigureView::mouseMoveEvent(QMouseEvent* event) {
    if (dragged_from_) {
        moveBy(event->position() - *dragged_from_);
        dragged_from_ = event->position();
    }
    setCursor(event->position());
    update();
}

void FigureView::mousePressEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton) dragged_from_ = event->position();
}

void FigureView::mouseReleaseEvent(QMouseEvent*) { dragged_from_.reset(); }

void FigureView::wheelEvent(QWheelEvent* event) {
    zoom(std::pow(0.998, event->angleDelta().y()), event->position());
    setCursor(event->position());
    event->accept();
}

void FigureView::keyPressEvent(QKeyEvent* event) {
    const QPointF middle(0.5 * width(), 0.5 * height());
    constexpr double step = 40;
    switch (event->key()) {
        case Qt::Key_Plus: return zoom(0.8, middle);
        case Qt::Key_Minus: return zoom(1.25, middle);
        case Qt::Key_0: return resetZoom();
        case Qt::Key_Left: return moveBy({step, 0});
        case Qt::Key_Right: return moveBy({-step, 0});
        case Qt::Key_Up: return moveBy({0, step});
        case Qt::Key_Down: return moveBy({0, -step});
        default: QWidget::keyPressEvent(event);
    }
}

void FigureView::leaveEvent(QEvent*) {
    setCursor({});
    update();
}

}  // namespace searchlight::gui
