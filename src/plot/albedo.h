// Total diffuse reflectance against albedo.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/estimate.h"
#include "base/figure.h"

namespace searchlight {

struct AlbedoCurve {
    std::string label;
    std::vector<double> albedo;  ///< reduced albedo alpha', ascending
    std::vector<double> total;   ///< total diffuse reflectance per unit incident flux
};

struct AlbedoReference {
    std::string label;
    std::vector<double> albedo;
    std::vector<Estimate> total;  ///< exact values have a standard error of 0
};

/// One line per model, points with error bars for the reference.
Figure albedoFigure(std::span<const AlbedoCurve> models, const AlbedoReference* reference, double eta);

}  // namespace searchlight
