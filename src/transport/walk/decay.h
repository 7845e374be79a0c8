// Exponential decay over a path.
#pragma once

#include <cmath>

namespace searchlight {

/// Integral of exp(-rate z) over z from 0 to h, for a real or complex rate; `wave` is exp(-rate h), 0 where h is
/// infinite. Relative error 1e-11.
template <class Number>
Number decayed(Number rate, Number wave, double h) {
    // Below 1e-4 the difference would cancel; the series leaves 1e-13 there.
    if (std::abs(rate) * h < 1e-4) return h * (1.0 - rate * h * (0.5 - rate * h / 6.0));
    return (1.0 - wave) / rate;
}

}  // namespace searchlight
