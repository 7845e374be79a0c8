#include "draw/axis_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace searchlight {

namespace {

// Beyond this, spans and steps overflow.
constexpr double largest_value = 1e300;

double transform(AxisScale scale, double value) {
    switch (scale) {
        case AxisScale::logarithmic: return std::log10(value);
        case AxisScale::square_root: return std::copysign(std::sqrt(std::abs(value)), value);
        case AxisScale::linear: break;
    }
    return value;
}

double inverse(AxisScale scale, double position) {
    switch (scale) {
        case AxisScale::logarithmic: return std::pow(10.0, position);
        case AxisScale::square_root: return std::copysign(position * position, position);
        case AxisScale::linear: break;
    }
    return position;
}

struct Interval {
    double min = std::numeric_limits<double>::infinity();
    double max = -std::numeric_limits<double>::infinity();
    bool empty() const { return min > max; }
    void add(double value) {
        min = std::min(min, value);
        max = std::max(max, value);
    }
};

bool isGiven(const Axis& axis) { return axis.min != axis.max; }

// Wide enough to be divided into labelled steps.
bool isRange(double min, double max) {
    return max - min > std::max(1e-12 * std::max(std::abs(min), std::abs(max)), 1 / largest_value);
}

void checkAxis(const Axis& axis, char name) {
    if (!isGiven(axis)) return;
    if (!isRange(axis.min, axis.max) || !canShow(axis.scale, axis.min) || !canShow(axis.scale, axis.max))
        throw inputError(fmt::format("the {} axis cannot run from {} to {}", name, axis.min, axis.max),
                         axis.scale == AxisScale::logarithmic ? "a logarithmic axis needs 0 < min < max"
                                                              : "an axis needs min < max, both finite");
}

void checkSeries(const Series& series) {
    const bool steps = series.style == SeriesStyle::steps;
    const size_t expected = series.y.size() + (steps ? 1 : 0);
    if (series.x.size() != expected && !(series.x.empty() && series.y.empty()))
        throw inputError(fmt::format("series '{}' has {} x for {} y, expected {}", series.label, series.x.size(),
                                     series.y.size(), expected),
                         steps ? "steps have one more edge than values" : "");
    if (series.lower.size() != series.upper.size() || (!series.lower.empty() && series.lower.size() != series.y.size()))
        throw inputError(fmt::format("series '{}' has a band of {} lower and {} upper bounds for {} y", series.label,
                                     series.lower.size(), series.upper.size(), series.y.size()));
}

// A constant still gets a range around it.
Interval widened(Interval data, AxisScale scale) {
    if (isRange(data.min, data.max)) return data;
    const double middle = data.min, size = std::abs(middle);
    if (scale == AxisScale::logarithmic) return {middle / 3, middle * 3};
    const double half = size > 1 / largest_value ? 0.5 * size : 1.0;
    return {middle - half, middle + half};
}

// By a twentieth of the axis' length; a linear axis from near zero starts there.
Interval padded(Interval data, AxisScale scale) {
    const bool from_zero = data.min >= 0 && data.min < 0.4 * data.max && scale != AxisScale::logarithmic;
    const double low = transform(scale, from_zero ? 0 : data.min), high = transform(scale, data.max);
    const double pad = 0.05 * (high - low);
    const Interval wider{inverse(scale, from_zero ? low : low - pad), inverse(scale, high + pad)};
    return {canShow(scale, wider.min) ? wider.min : data.min, canShow(scale, wider.max) ? wider.max : data.max};
}

}  // namespace

bool canShow(AxisScale scale, double value) {
    return std::abs(value) <= largest_value && (scale != AxisScale::logarithmic || value >= 1 / largest_value);
}

double AxisMap::operator()(double value) const {
    if (!canShow(scale, value)) return std::numeric_limits<double>::quiet_NaN();
    const double low = transform(scale, min), high = transform(scale, max);
    const double t = (transform(scale, value) - low) / (high - low);
    // Far outside is outside: keeps clipping free of overflow.
    return from + std::clamp(t, -1e3, 1e3) * (to - from);
}

double AxisMap::clamped(double value) const {
    return scale == AxisScale::logarithmic && value <= 0 ? from : (*this)(value);
}

FigureRange figureRange(const Figure& figure) {
    checkAxis(figure.x, 'x');
    checkAxis(figure.y, 'y');
    Interval x, y;
    for (const Series& series : figure.series) {
        checkSeries(series);
        const bool steps = series.style == SeriesStyle::steps;
        for (size_t i = 0; i < series.y.size(); ++i) {
            const double left = series.x[i], right = steps ? series.x[i + 1] : left;
            const bool left_shown = canShow(figure.x.scale, left), right_shown = canShow(figure.x.scale, right);
            if ((!left_shown && !right_shown) || !canShow(figure.y.scale, series.y[i])) continue;
            if (isGiven(figure.x) && (right < figure.x.min || left > figure.x.max)) continue;
            if (left_shown) x.add(left);
            if (right_shown) x.add(right);
            y.add(series.y[i]);
            if (series.lower.empty()) continue;
            // A band may reach zero on a logarithmic axis: it then leaves through the bottom.
            for (const double bound : {series.lower[i], series.upper[i]})
                if (figure.y.scale != AxisScale::logarithmic && canShow(figure.y.scale, bound)) y.add(bound);
        }
    }
    if (x.empty())
        throw inputError("the figure has nothing to show: no series has a finite point within its axes",
                         "a logarithmic axis shows positive values only");
    if (isGiven(figure.x))
        x = {figure.x.min, figure.x.max};
    else
        x = widened(x, figure.x.scale);
    if (isGiven(figure.y))
        y = {figure.y.min, figure.y.max};
    else
        y = padded(widened(y, figure.y.scale), figure.y.scale);
    return {x.min, x.max, y.min, y.max};
}

}  // namespace searchlight
