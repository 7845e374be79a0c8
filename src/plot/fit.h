// A fit beside its data, and below it what is left.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/figure.h"

namespace searchlight {

/// One channel: 1/mm^2 over mm.
struct FitPicture {
    std::string label;                          ///< "R", or empty for one channel
    int color = 0;                              ///< index into the palette
    std::vector<double> radii_mm, edges_mm;     ///< of the data; edges n + 1, or empty for points
    std::vector<double> value, standard_error;  ///< errors may be empty
    std::vector<double> curve_mm, curve;        ///< the fit, smooth
    std::vector<double> relative;               ///< (fit - data) / data, where the data are
};

/// Data and fit over a logarithmic ordinate; a panel of their relative difference below. `title` says what was fitted.
Figure fitFigure(std::span<const FitPicture> channels, const std::string& title, const std::string& model);

}  // namespace searchlight
