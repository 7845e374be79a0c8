#include "transport/walk/diffusion.h"

#include <algorithm>
#include <cmath>

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

}  // namespace searchlight
