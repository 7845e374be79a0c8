// Fresnel's equations in double precision, for tables.
#pragma once

#include <algorithm>
#include <cmath>

namespace searchlight {

/// Unpolarised reflectance seen from inside under the cosine c in (0, 1], eta: inside over outside; 1 beyond the
/// critical angle.
inline double internalReflectance(double eta, double c) {
    const double t = std::sqrt(std::max(0.0, 1 - eta * eta * (1 - c) * (1 + c)));  // cosine outside
    const double s = (eta * c - t) / (eta * c + t), p = (c - eta * t) / (c + eta * t);
    return 0.5 * (s * s + p * p);
}

/// Cosine inside of the critical angle; 0 where every direction leaves.
inline double criticalCosine(double eta) { return eta > 1 ? std::sqrt((eta - 1) * (eta + 1)) / eta : 0; }

}  // namespace searchlight
