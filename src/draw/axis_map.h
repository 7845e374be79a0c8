// From values to positions on paper, and the range that an axis shows.
#pragma once

#include "base/figure.h"

namespace searchlight {

/// Maps [min, max] to [from, to]. A square-root axis keeps the sign: v -> sign(v) sqrt|v|.
struct AxisMap {
    AxisScale scale = AxisScale::linear;
    double min = 0, max = 1;  ///< values
    double from = 0, to = 1;  ///< positions

    /// NaN for what the axis cannot show: not finite, or not positive on a logarithmic axis.
    double operator()(double value) const;
    /// As above, but what lies at or below zero on a logarithmic axis is moved to the axis' lower end.
    double clamped(double value) const;
};

/// What an axis can show of a value: finite, of sane size, positive when logarithmic.
bool canShow(AxisScale scale, double value);

struct FigureRange {
    double x_min, x_max, y_min, y_max;
};

/// The ranges asked for, or those of the data: padded, with zero where it is near; never empty. Throws an input Error
/// when series are malformed, an axis' range is not one, or no point is left to show.
FigureRange figureRange(const Figure& figure);

}  // namespace searchlight
