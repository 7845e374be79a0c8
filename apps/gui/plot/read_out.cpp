#include "gui/plot/read_out.h"

#include <QObject>
#include <QPainter>
#include <algorithm>
#include <cmath>
#include <optional>

#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

QString numberText(double value) { return QString::number(value, 'g', 4); }

QString placeText(const Axis& axis, double value) {
    return QStringLiteral("%1 %2 %3")
        .arg(QString::fromStdString(axis.label), numberText(value), QString::fromStdString(axis.unit))
        .trimmed();
}

// The value of a series at x: that of its bin, or of the line through its points.
std::optional<double> valueAt(const Series& series, double x, std::size_t* index) {
    const auto above = std::ranges::upper_bound(series.x, x);
    if (above == series.x.begin() || above == series.x.end()) return {};
    const std::size_t i = static_cast<std::size_t>(above - series.x.begin()) - 1;
    *index = i;
    if (series.style == SeriesStyle::steps) return series.y[i];
    if (i + 1 >= series.y.size()) return {};
    const double t = (x - series.x[i]) / (series.x[i + 1] - series.x[i]);
    return series.y[i] + t * (series.y[i + 1] - series.y[i]);
}

std::optional<std::size_t> cellOf(const std::vector<double>& edges, double value) {
    const auto above = std::ranges::upper_bound(edges, value);
    if (above == edges.begin() || above == edges.end()) return {};
    return static_cast<std::size_t>(above - edges.begin()) - 1;
}

}  // namespace

QStringList readSeries(const Figure& figure, double x) {
    QStringList lines{placeText(figure.x, x)};
    for (const Series& series : figure.series) {
        if (!series.in_legend) continue;
        std::size_t i = 0;
        const auto value = valueAt(series, x, &i);
        if (!value || !std::isfinite(*value)) continue;
        QString text = QString::fromStdString(series.label) + QStringLiteral("\t") + numberText(*value);
        if (!series.lower.empty() && series.style == SeriesStyle::steps)
            text += QStringLiteral(" ± ") + numberText(0.5 * (series.upper[i] - series.lower[i]));
        lines << text;
    }
    return lines;
}

QStringList readMaps(const Figure& figure, double x, double y) {
    std::vector<const Figure*> panels;
    for (const Figure& panel : figure.panels) panels.push_back(&panel);
    if (panels.empty()) panels.push_back(&figure);
    QStringList lines;
    for (const Figure* panel : panels) {
        if (!panel->map) continue;
        const FalseColor& map = *panel->map;
        const auto column = cellOf(map.x_edges, x), row = cellOf(map.y_edges, y);
        if (!column || !row) continue;
        const std::size_t i = *row * (map.x_edges.size() - 1) + *column;
        if (i >= map.values.size() || !std::isfinite(map.values[i])) continue;
        if (lines.isEmpty()) lines << placeText(panel->x, x) + QStringLiteral(", ") + placeText(panel->y, y);
        QString value = numberText(map.values[i]);
        if (i < map.standard_error.size() && map.standard_error[i] > 0)
            value += QStringLiteral(" ± ") + numberText(map.standard_error[i]);
        lines << QString::fromStdString(panel->title) + QStringLiteral("\t") + value;
    }
    return lines;
}

void paintReadOut(QPainter& painter, const Theme& theme, const QStringList& lines, QPointF at, const QRectF& frame) {
    const Colors& colors = theme.colors();
    const QFont font = theme.smallFont();
    const QFontMetrics metrics(font);
    int whole = 0, names = 0, values = 0;
    for (const QString& line : lines) {
        const QStringList parts = line.split(QLatin1Char('\t'));
        const int wide = metrics.horizontalAdvance(parts.front());
        if (parts.size() == 1)
            whole = std::max(whole, wide);
        else
            names = std::max(names, wide), values = std::max(values, metrics.horizontalAdvance(parts.back()));
    }
    const int row = metrics.height() + 2, box_width = std::max(whole, names + (values > 0 ? values + 20 : 0)) + 16;
    const int box_height = row * static_cast<int>(lines.size()) + 10;
    double left = at.x() + 14;
    if (left + box_width > frame.right()) left = at.x() - 14 - box_width;
    left = std::max(left, frame.left() + 2);
    const double top = std::clamp(at.y() - 0.5 * box_height, frame.top() + 2,
                                  std::max(frame.top() + 2, frame.bottom() - 2 - box_height));
    QColor back = colors.raised;
    back.setAlphaF(0.94F);
    painter.setPen(QPen(colors.line, 1));
    painter.setBrush(back);
    painter.drawRoundedRect(QRectF(left, top, box_width, box_height), 4, 4);
    painter.setFont(font);
    for (int i = 0; i < lines.size(); ++i) {
        const QStringList parts = lines[i].split(QLatin1Char('\t'));
        const double base = top + 5 + row * (i + 1) - metrics.descent() - 1;
        painter.setPen(i == 0 ? colors.muted : colors.text);
        painter.drawText(QPointF(left + 8, base), parts.front());
        if (parts.size() > 1)
            painter.drawText(QPointF(left + box_width - 8 - metrics.horizontalAdvance(parts.back()), base),
                             parts.back());
    }
}

}  // namespace searchlight::gui
