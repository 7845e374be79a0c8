// Ground truths whose lines and transforms are known.
#pragma once

#include <cmath>
#include <vector>

#include "kernel/ground_truth.h"

namespace searchlight {

/// f(r) in red, f(2 r) in green, nothing in blue; 200 samples a decade leave the profile's cubic within 1e-8.
template <class Function>
GroundTruth radialTruth(Function f, double first, double last) {
    std::vector<double> radii;
    std::vector<Rgb> values;
    const int count = static_cast<int>(200 * std::log10(last / first));
    for (int i = 0; i <= count; ++i) {
        radii.push_back(first * std::pow(last / first, static_cast<double>(i) / count));
        values.push_back({f(radii.back()), f(2 * radii.back()), 0});
    }
    return GroundTruth(Profile(radii, values));
}

/// Normalized diffusion with d = 1 mm: 1/r at the middle, two exponentials.
inline GroundTruth burleyTruth() {
    return radialTruth([](double r) { return (std::exp(-r) + std::exp(-r / 3)) / r; }, 1e-6, 80);
}

}  // namespace searchlight
