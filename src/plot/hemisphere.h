// Outgoing radiance at a point, over the hemisphere of directions.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/figure.h"
#include "plot/channel.h"

namespace searchlight {

/// Cell (i, j) of polar angle and azimuth is [i * turns + j]; the azimuth counts from +x, the side that the beam leans
/// to.
struct HemispherePanel {
    std::string heading;
    std::vector<Rgb> radiance;        ///< mean over the cell, 1/(mm^2 sr) per unit incident flux
    std::vector<Rgb> standard_error;  ///< of a reference; empty for a model
};

struct HemisphereOptions {
    PlotChannel channel = PlotChannel::red;
    std::string title;
    std::string place;  ///< "r from 0.5 to 1 mm, ...": where light leaves, for the caption
    int polar = 9;
    int turns = 24;  ///< even, so that the plane of incidence lies between cells
};

/// A disc per panel, seen from above, in one linear colour scale from 0; then the radiance in the plane of incidence
/// against the angle. Throws an input Error when sizes disagree.
Figure hemisphereFigure(std::span<const HemispherePanel> panels, const HemisphereOptions& options);

}  // namespace searchlight
