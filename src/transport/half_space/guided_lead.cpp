// How guided walks are led, and what controls their moments: the light that dies out as exp(-kappa z).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "transport/half_space/guided_walk.h"
#include "transport/walk/diffusion.h"

namespace searchlight {

namespace {

// Legendre moments psi_l / psi_0 of the light that dies out as exp(-kappa z), [Chandrasekhar1960] chapter III; `kappa`
// is the rate at which they belong together: (2 l + 1) (1 - albedo g^l) psi_l + kappa [(l + 1) psi_(l + 1) + l psi_(l -
// 1)] = 0.
constexpr int kMoments = 64;

// What is left of l = 0, with all higher moments eliminated; positive below the root.
template <std::size_t kCount>
double residue(const HalfSpaceWalk& walk, double kappa, std::array<double, kCount>& moments) {
    const double albedo = 1 - walk.absorbed;
    double ratio[kMoments + 1] = {};
    for (int l = kMoments - 1; l > 0; --l) {
        const double pivot = (2 * l + 1) * (1 - albedo * std::pow(walk.g, l)) + kappa * (l + 1) * ratio[l + 1];
        if (!(pivot > 0)) return -1;
        ratio[l] = -kappa * l / pivot;
    }
    moments[0] = 1;
    for (std::size_t l = 1; l < kCount; ++l) moments[l] = moments[l - 1] * ratio[l];
    return walk.absorbed + kappa * ratio[1];
}

// Below, floats would have to hold the difference of large numbers.
constexpr double kLeastControl = 1e-3;
// psi, 1 on average, is cut where a term is less than this; where that takes too many there is no control.
constexpr double kCut = 1e-7;
constexpr std::size_t kMostTerms = 24;

std::array<double, 4> powersOf(const std::array<double, 4>& legendre) {
    const auto& [p0, p1, p2, p3] = legendre;
    return {p0 - 0.5 * p2, p1 - 1.5 * p3, 1.5 * p2, 2.5 * p3};
}

}  // namespace

GuidedWalk::GuidedWalk(const HalfSpaceWalk& half_space) : walk(half_space) {
    std::array<double, 4> moments{1, 0, 0, 0};
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        std::array<double, 4> at{};
        if (residue(walk, middle, at) > 0)
            low = middle, moments = at;
        else
            high = middle;
    }
    kappa = low;
    makeControls();
    const auto value = [](const std::array<double, 4>& p, double w) {
        return p[0] + w * (p[1] + w * (p[2] + w * p[3]));
    };
    // The series is cut; where it would come near 0 or below, a smoother one serves.
    for (double smooth = 1;; smooth *= 0.9) {
        std::array<double, 4> legendre{}, scattered{};
        for (std::size_t l = 0; l < 4; ++l) {
            legendre[l] = (2 * static_cast<double>(l) + 1) * moments[l] * std::pow(smooth, l);
            scattered[l] = legendre[l] * std::pow(walk.g, static_cast<double>(l));
        }
        psi = powersOf(legendre);
        after = powersOf(scattered);
        double least = value(psi, -1);
        most = least;
        for (int i = 1; i <= 256; ++i) {
            const double p = value(psi, -1 + i / 128.0);
            least = std::min(least, p);
            most = std::max(most, p);
        }
        if (least > 0.1) break;
    }
    most *= 1.0001;  // between those points, and rounded
}

void GuidedWalk::makeControls() {
    if (kappa < kLeastControl) return;
    const double sine = walk.sin_beam, cosine = walk.cos_beam;
    if (walk.g == 0) {
        inverse_kappa = 1 / kappa;
        const double psi_in = 1 / (1 + kappa * cosine);
        r2_control = 2 * psi_in * psi_in * (sine * sine * psi_in + cosine * inverse_kappa);
        return;
    }
    // Moments fall by about kappa / 2 from one to the next.
    std::array<double, kMoments> moments{};
    residue(walk, kappa, moments);
    std::size_t terms = 4;
    while (terms < kMostTerms && std::abs(moments[terms]) * static_cast<double>(2 * terms + 1) > kCut) terms += 2;
    if (terms == kMostTerms) return;
    inverse_kappa = 1 / kappa;
    std::vector<double> series;
    for (std::size_t l = 0; l < terms; ++l) series.push_back((2 * static_cast<double>(l) + 1) * moments[l]);
    std::vector<double> powers = powersOfLegendre(series);
    double in[3] = {};  // psi and its derivatives along the beam
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = terms; i-- > 0;) in[k] = in[k] * cosine + powers[i];
        exact[k].assign(powers.begin(), powers.end());
        for (std::size_t i = 1; i < terms; ++i) powers[i - 1] = static_cast<double>(i) * powers[i];
        powers.back() = 0;
    }
    x_control = -sine * inverse_kappa * in[1];
    r2_control = inverse_kappa * inverse_kappa * (sine * sine * in[2] - 2 * cosine * in[1]);
}

bool GuidedWalk::useful() const { return walk.absorbed < 0.45 * (1 - walk.g * (1 - walk.absorbed)); }

}  // namespace searchlight
