#include "transport/walk/diffusion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "transport/walk/fresnel.h"

namespace searchlight {

double asymptoticDecay(double absorbed) {
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double kappa = 0.5 * (low + high);
        // 1 - kappa / atanh(kappa) grows from 0 to 1; its series keeps digits near 0.
        const double lost = kappa < 1e-3 ? kappa * kappa / 3 : 1 - kappa / std::atanh(std::min(kappa, 1 - 1e-16));
        (lost < absorbed ? low : high) = kappa;
    }
    return low;
}

double extrapolation(double eta) {
    double first = 0, second = 0;
    constexpr int points = 256;
    for (int i = 0; i < points; ++i) {
        const double c = (i + 0.5) / points, reflected = internalReflectance(eta, c);
        first += 2 * reflected * c / points;
        second += 3 * reflected * c * c / points;
    }
    return 2.0 / 3 * (1 + second) / (1 - first);
}

std::vector<double> powersOfLegendre(std::span<const double> coefficients) {
    const std::size_t terms = coefficients.size();
    std::vector<double> before(terms), legendre(terms), powers(terms);
    if (terms > 0) legendre[0] = 1;
    for (std::size_t l = 0; l < terms; ++l) {
        const double n = static_cast<double>(l);
        std::vector<double> next(terms);
        for (std::size_t i = 0; i < terms; ++i) {
            powers[i] += coefficients[l] * legendre[i];
            next[i] = ((i > 0 ? (2 * n + 1) * legendre[i - 1] : 0) - n * before[i]) / (n + 1);
        }
        before = std::exchange(legendre, next);
    }
    return powers;
}

}  // namespace searchlight
