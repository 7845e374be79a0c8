#include "transport/walk/radial_edges.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace searchlight {

namespace {

// The fraction of the classical dipole's flux outside r, lengths in reduced mean free paths: its two terms integrate to
// z exp(-s d) / d. [Jensen2001] with the boundary of a matched medium; a range for a tally needs no more.
double dipoleBeyond(double r, double s) {
    constexpr double real = 1, image = 1 + 4.0 / 3;
    const auto term = [&](double z) { return z * std::exp(-s * std::hypot(r, z)) / std::hypot(r, z); };
    return (term(real) + term(image)) / (std::exp(-s * real) + std::exp(-s * image));
}

}  // namespace

std::vector<double> linearEdges(int bins, double max_mm) {
    if (bins < 1 || !(max_mm > 0)) throw inputError("radial bins need a positive number and a positive range");
    std::vector<double> edges;
    for (int i = 0; i <= bins; ++i) edges.push_back(max_mm * i / bins);
    return edges;
}

std::vector<double> defaultEdges(const HalfSpaceProblem& problem, int bins) {
    if (bins < 1) throw inputError("radial bins need a positive number");
    const double sigma_tp = problem.sigma_a + (1 - problem.g) * problem.sigma_s;
    if (!(sigma_tp > 0)) throw inputError("the medium neither absorbs nor scatters");
    const double s = std::sqrt(3 * problem.sigma_a / sigma_tp);
    // Without absorption the tail has no scale (it falls as 1/r^3): 100 reduced mean free paths are enough to look at.
    double low = 0, high = 100;
    for (int i = 0; i < 40; ++i) {
        const double r = 0.5 * (low + high);
        (dipoleBeyond(r, s) > 1e-3 ? low : high) = r;
    }
    std::vector<double> edges = linearEdges(bins, 1);
    for (double& edge : edges) edge *= edge * high / sigma_tp;
    return edges;
}

}  // namespace searchlight
