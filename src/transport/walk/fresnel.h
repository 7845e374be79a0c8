// Fresnel's equations in double precision.
#pragma once

#include <algorithm>
#include <cmath>

namespace searchlight {

/// Unpolarised reflectance for a ray under the cosine c in a medium of index n that is refracted to the cosine t in one
/// of index n_beyond; at least one cosine above 0.
inline double fresnelReflectance(double n, double c, double n_beyond, double t) {
    const double s = (n * c - n_beyond * t) / (n * c + n_beyond * t);
    const double p = (n_beyond * c - n * t) / (n_beyond * c + n * t);
    return 0.5 * (s * s + p * p);
}

/// Unpolarised reflectance seen from inside under the cosine c in (0, 1], eta: inside over outside; 1 beyond the
/// critical angle.
inline double internalReflectance(double eta, double c) {
    return fresnelReflectance(eta, c, 1, std::sqrt(std::max(0.0, 1 - eta * eta * (1 - c) * (1 + c))));
}

/// Cosine inside of the critical angle; 0 where every direction leaves.
inline double criticalCosine(double eta) { return eta > 1 ? std::sqrt((eta - 1) * (eta + 1)) / eta : 0; }

}  // namespace searchlight
