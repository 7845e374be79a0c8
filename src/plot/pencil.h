// The searchlight cross-section: every model beside the reference, and their relative error.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/figure.h"
#include "base/vec.h"
#include "plot/channel.h"

namespace searchlight {

/// A model's curve, per unit incident flux (T12 of the beam is in it).
struct PencilCurve {
    std::string label;
    std::vector<double>
        x_mm;             ///< ascending; distance from the beam; of oblique light, R_d is the mean over all directions
    std::vector<Rgb> Rd;  ///< at x, 1/mm^2
    std::vector<Rgb> bin_means;  ///< over the reference's annuli; empty without a reference
};

/// A tally, per unit incident flux.
struct PencilReference {
    std::string label;  ///< "Monte Carlo, 1e7 walks"
    std::vector<double> edges_mm;
    std::vector<Rgb> Rd, standard_error;  ///< n values for n + 1 edges
};

struct PencilOptions {
    PlotChannel channel = PlotChannel::red;
    AxisScale x_scale = AxisScale::linear;
    AxisScale y_scale = AxisScale::logarithmic;
    int radius_power = 0;  ///< the ordinate is R_d times r^power: 0, 1 or 2
    double angle_deg = 0;
    std::string material;    ///< for the title
    std::string solo;        ///< label of the one model to show, its three channels apart; empty: all models
    double band_sigmas = 2;  ///< half width of the reference's band
};

/// R_d (times r^power) against r. Throws an input Error when nothing is left to show.
Figure pencilFigure(std::span<const PencilCurve> models, const PencilReference* reference,
                    const PencilOptions& options);

/// (model - reference) / reference per annulus, with the reference's own band about zero.
Figure relativeErrorFigure(std::span<const PencilCurve> models, const PencilReference& reference,
                           const PencilOptions& options);

}  // namespace searchlight
