// R_d(x, y) over the surface in false colour: every model beside the reference.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/figure.h"
#include "plot/channel.h"

namespace searchlight {

/// The square [-extent, extent]^2, cut into equal cells, rows of ascending y. Per unit incident flux.
struct SlicePanel {
    std::string heading;
    std::vector<Rgb> means;           ///< over the cells, 1/mm^2
    std::vector<Rgb> standard_error;  ///< of a reference; empty for a model
    std::vector<Rgb> unclamped;       ///< the model with its negative values, where it clamps them; or empty
};

struct SliceOptions {
    PlotChannel channel = PlotChannel::red;
    std::string title;
    double extent_mm = 1;
    int columns = 2;
    double decades = 4;  ///< of the colour scale below its upper end, at most: it ends where the models do
};

/// The colour scale is logarithmic, its upper end the largest value of the reference where there is one (of the models
/// otherwise). Where a model has been clamped to 0 is outlined. Throws an input Error when sizes disagree.
Figure sliceFigure(std::span<const SlicePanel> panels, const SliceOptions& options);

/// The boundary of {value < 0} on a grid of cell means, through linear interpolation between the cells' middles: pieces
/// of two points each, separated by NaN. Empty where no value is negative.
struct Contour {
    std::vector<double> x, y;
};
Contour zeroContour(std::span<const double> values, std::size_t cells, double extent);

}  // namespace searchlight
