#include "light/transmitted_cosine.h"

#include <algorithm>
#include <cmath>

#include "model/physics.h"

namespace searchlight {

namespace {

// T12 mu is linear between so many entries to the error that the header states; 8 KiB stay in the nearest cache.
constexpr int intervals = 2048;

}  // namespace

double transmittedCosine(double mu, double eta) {
    if (mu <= 0) return 0;
    mu = std::min(mu, 1.0);
    return eta == 1 ? mu : (1 - Physics<double>::fresnelReflectance(mu, 1 / eta)) * mu;
}

TransmittedCosine::TransmittedCosine(double eta)
    : eta_(eta), thinner_(eta < 1), inverse_eta2_(1 / (eta * eta)), table_(intervals + 2) {
    for (int i = 0; i <= intervals; ++i) {
        const double x = static_cast<double>(i) / intervals;
        const double mu = thinner_ ? std::sqrt(1 - eta * eta * (1 - x * x)) : x;
        table_[i] = static_cast<float>(thinner_ && i == 0 ? 0 : transmittedCosine(mu, eta));
    }
    table_[intervals + 1] = table_[intervals];
}

float TransmittedCosine::operator()(float mu) const {
    float x = std::clamp(mu, 0.0f, 1.0f);
    // In double: the root takes half of the digits at the critical angle.
    if (thinner_)
        x = static_cast<float>(std::sqrt(std::max(0.0, 1 - (1.0 - x * static_cast<double>(x)) * inverse_eta2_)));
    x *= intervals;
    const int cell = static_cast<int>(x);
    const float t = x - static_cast<float>(cell);
    return table_[cell] + t * (table_[cell + 1] - table_[cell]);
}

}  // namespace searchlight
