// Henyey-Greenstein scattering between finitely many directions, its forward peak set apart where they are too few for
// it.
#pragma once

#include <span>
#include <vector>

namespace searchlight {

/// Gauss-Legendre points on [0, 1] and their weights.
struct GaussRule {
    std::vector<double> x, weight;
};

/// n >= 1 points, to rounding.
GaussRule gaussRule(int n);

/// What remains of a Henyey-Greenstein phase function beside its forward peak, by delta-M [Wiscombe1977]: light that
/// is scattered into the peak goes on as if it had not been.
struct SmoothPhase {
    double peak = 0;              ///< part of the scattered light that is in the peak, f
    std::vector<double> moments;  ///< (g^l - f) / (1 - f), from l = 0: 1
    double g = 0;                 ///< of the whole

    /// 1/sr. Sums the moments, or is Henyey-Greenstein where there is no peak.
    double operator()(double cosine) const;
};

/// Moments up to `last`, less where they vanish earlier. Backward peaks are not set apart.
SmoothPhase smoothPhase(double g, int last);

/// 1/sr.
double henyeyGreenstein(double g, double cosine);

/// The directions of one hemisphere, each of which stands for its mirror image at a vertical plane, too; n values each.
struct OrdinateSet {
    std::size_t azimuths = 1;        ///< at each cosine; these follow each other
    std::vector<double> mu, weight;  ///< cosines above 0; weights add up to 2 pi
    std::vector<double> phi;         ///< from the plane, 0 to pi
};

/// The phase function between directions, and from a beam into them, 1/sr.
struct OrdinateScattering {
    std::vector<double> same, other;  ///< n x n: within a hemisphere, into the other one
    std::vector<double> down, up;     ///< n: from a beam that goes down, means over its azimuths
};

/// The harmonics are made orthonormal on the directions, lowest first: scattering then has exactly the eigenvalues
/// `moments`, so that no energy is lost and the diffusion length is right however few the directions.
OrdinateScattering ordinateScattering(std::span<const double> moments, const OrdinateSet& directions,
                                      double beam_cosine = 1);

}  // namespace searchlight
