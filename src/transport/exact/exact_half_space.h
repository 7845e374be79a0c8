// The searchlight problem without noise: an isotropically scattering half-space of matched index under a normal beam.
#pragma once

#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "base/estimate.h"
#include "transport/half_space/half_space.h"

namespace searchlight {

/// The numbers of one radius per unit incident flux. Here a standard error is a bound of the numerical error, and the
/// count is 0.
struct ExactOrders {
    Estimate all, single, multiple;
};

/// How finely the integrals are summed. The defaults reach double precision; other values exist to prove it.
struct ExactQuadrature {
    double step = 1.0 / 16;              ///< along the contour in Hankel space; at most 2.5 of it elsewhere
    double tilt = std::numbers::pi / 4;  ///< of the contour from the branch cut, above 0, at most pi/4
};

/// A half-space in Hankel space: what the profile is put together from. Lengths are in mean free paths.
struct HankelSolution {
    /// A node of the contour: transverse decay rate, and weight times transform of two and more scatters.
    struct Node {
        std::complex<double> rate, weight;
        std::complex<double> doubt = {};  ///< how far the weight may be off; its phase counts, as neighbours err alike
    };
    /// Of single scattering, whose exitance is the sum of weight exp(-rate r) over 2 pi r.
    struct Single {
        double rate, weight;
    };

    double sigma_t = 1;  ///< 1/mm
    bool absorbs = true;
    double multiple_total = 0, multiple_total_error = 0;
    /// The contour ends before the flux at the beam does, which is then what the total leaves.
    bool ends_early = false;
    double contour_error = 0;    ///< what the step of the contour leaves, as a part of the total
    double single_error = 0;     ///< relative
    double smallest_radius = 0;  ///< that the contour resolves
    std::vector<Node> contour;
    std::vector<Single> single;
};

/// Solves once on construction (about 50 ms, 130 ms without absorption), after which a radius costs 30 microseconds.
/// Errors are stated with each number: below 1e-10 relative out to 20 diffusion lengths, 1e-7 to 40; farther out an
/// exitance below 1e-30 of the total drowns.
class ExactHalfSpace {
public:
    /// Coefficients in 1/mm; the medium may be free of absorption. Throws an input Error unless both are finite,
    /// not negative, and not both 0.
    ExactHalfSpace(double sigma_a, double sigma_s, const ExactQuadrature& quadrature = {});
    /// One that was solved elsewhere, such as by solveOrdinates().
    explicit ExactHalfSpace(HankelSolution solution);

    ExactOrders total() const;
    /// Exitance, 1/mm^2; it grows as 1/r towards the beam. Throws an input Error below the
    /// smallest radius, here 1e-7 mean free paths.
    ExactOrders Rd(double r_mm) const;
    /// Flux that leaves within r >= 0: the encircled power.
    ExactOrders within(double r_mm) const;
    /// Flux that leaves beyond r >= 0, accurate where it is small.
    ExactOrders beyond(double r_mm) const;
    /// Mean exitance between two radii, 0 <= inner < outer, 1/mm^2.
    ExactOrders annulusRd(double inner_mm, double outer_mm) const;
    /// Mean squared exit radius of what leaves, mm^2; infinite without absorption.
    ExactOrders meanR2() const;

private:
    // Lengths in mean free paths; `outer` may be infinite.
    ExactOrders flux(double inner, double outer) const;

    HankelSolution solution_;
};

/// Diffuse reflectance of the same half-space for light that arrives at the cosine mu0, 0 < mu0 <= 1, by orders.
/// [Chandrasekhar1960] chapter V: 1 - H(mu0) sqrt(1 - albedo). Throws an input Error for another cosine.
ExactOrders exactTotal(double sigma_a, double sigma_s, double mu0);

/// Why walkHalfSpace's problem has no exact solution here; empty where it has one.
std::string whyNotExact(const HalfSpaceProblem& problem);

/// The tallies of walkHalfSpace without a walk; a standard error is a bound of the numerical error. Throws an input
/// Error for a problem without an exact solution and for edges that do not ascend from 0 or more.
HalfSpaceResult solveHalfSpace(const HalfSpaceProblem& problem, const std::vector<double>& edges_mm);

/// The tallies of one that is solved; edges: at least 2, ascending from 0 or more, else an input Error.
HalfSpaceResult tallyExact(const ExactHalfSpace& exact, const std::vector<double>& edges_mm);

}  // namespace searchlight
