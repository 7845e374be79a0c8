// How far light moves, against the angle of incidence.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/estimate.h"
#include "base/figure.h"

namespace searchlight {

/// Moments of what leaves, one value for each angle; NaN where there is none.
struct MomentCurve {
    std::string label;
    std::vector<double> mean_x_mm;    ///< the refracted beam leans towards +x
    std::vector<double> mean_r2_mm2;  ///< about the entry point
};

struct MomentReference {
    std::string label;
    std::vector<Estimate> mean_x_mm, mean_r2_mm2;
};

/// Two panels over the angles: models as lines, the reference as points with bars of two standard errors. Throws an
/// input Error when sizes disagree.
Figure momentsFigure(std::span<const double> angles_deg, std::span<const MomentCurve> models,
                     const MomentReference* reference, const std::string& title);

}  // namespace searchlight
