// What leaves a half-space altogether, and its moments, with little noise: walks that are led back to the surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "transport/half_space/half_space_walk.h"

namespace searchlight {

/// How walks are led, near the game without variance of [Krivanek2014]: flights along the cosine w (positive into the
/// medium) end at the rate 1 + kappa w, and a direction is drawn from the phase function times psi, the angular part of
/// light that dies out as exp(-kappa z). Where psi is exact a walk's weight depends on its last direction alone.
struct GuidedWalk {
    explicit GuidedWalk(const HalfSpaceWalk& walk);

    /// Whether such walks are worth their time: the medium scatters much more than it absorbs.
    bool useful() const;

    HalfSpaceWalk walk;
    double kappa = 0;               ///< per mean free path
    std::array<double, 4> psi{};    ///< its powers of w; Legendre series up to order 3, so that
    std::array<double, 4> after{};  ///< its mean over the phase function is known, too
    double most = 1;                ///< the largest value of psi

    // Controls of the moments.
    double inverse_kappa = 0;              ///< 0: there are none
    double x_control = 0, r2_control = 0;  ///< their means
    std::array<std::vector<float>, 3>
        exact;  ///< g != 0: all of psi and its two derivatives, powers of w, an even number

private:
    void makeControls();
};

/// Sums over all walks of what left, after one collision or more: weight, weight times x, times r^2.
struct GuidedSums {
    double total = 0, x = 0, r2 = 0;
    double x_control = 0, r2_control = 0;  ///< nearly proportional to the errors of these moments, 0 on average
    std::uint64_t collisions = 0;
};

/// Walks `walks` walks of the stream (seed, chunk).
GuidedSums walkGuidedChunk(const GuidedWalk& guided, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks);

/// The same, and every exit in its bin; not for isotropic scattering.
GuidedSums walkGuidedChunk(const GuidedWalk& guided, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                           const RadialBins& bins, ExitTally& tally);

}  // namespace searchlight
