// R_d along the line of the plane of incidence, on both sides of the entry point.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/figure.h"
#include "plot/channel.h"

namespace searchlight {

/// A model per unit incident flux (T12 of the beam is in it).
struct StripCurve {
    std::string label;
    std::vector<Rgb> means;  ///< over the cells of the strip, 1/mm^2
    bool dashed = false;     ///< a variant of the model before it, in its colour
};

/// A tally per unit incident flux.
struct StripReference {
    std::string label;
    std::vector<Rgb> Rd, standard_error;  ///< over the cells of the strip, 1/mm^2
};

/// One beam on one medium. The strip is |y| < half_width_mm about the plane of incidence, cut into cells along x.
struct StripPanel {
    std::string heading;  ///< "60°"
    std::vector<double> edges_mm;
    double half_width_mm = 0;
    std::vector<StripCurve> models;
    std::vector<StripReference> reference;  ///< one, or none
};

struct ObliqueOptions {
    PlotChannel channel = PlotChannel::red;
    AxisScale y_scale = AxisScale::logarithmic;
    std::string title;
    bool shared_ordinate = true;  ///< all panels show one range; false: each its own
    double band_sigmas = 2;       ///< half width of the reference's band
};

/// Models as lines through the means over the cells, the reference as steps with a band. One panel fills the figure,
/// several stand side by side. Throws an input Error when sizes disagree or there is nothing to show.
Figure obliqueFigure(std::span<const StripPanel> panels, const ObliqueOptions& options);

/// Largest value, where it is, and the flux-weighted mean of x within the strip, of one curve over its cells.
struct StripShape {
    double peak = 0;
    double peak_x_mm = 0;
    double mean_x_mm = 0;
};
StripShape stripShape(std::span<const Rgb> means, std::span<const double> edges_mm, PlotChannel channel);

}  // namespace searchlight
