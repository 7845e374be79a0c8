// A model on a flat half-space lit by a pencil beam at the origin: the searchlight problem, as plots and the reference
// see it. The normal is +z, the refracted beam leans towards +x.
#pragma once

#include <span>
#include <vector>

#include "model/evaluator.h"

namespace searchlight {

/// Fresnel transmittance T12 of the beam, and the direction it came from (pointing away from the surface).
struct PencilBeam {
    double transmittance = 1;
    Vec3 wi{0, 0, 1};
};
PencilBeam pencilBeam(double eta, double angle_deg);

/// R_d at points of the plane (z ignored), 1/mm^2 per unit transmitted flux. For a model without no_wo this is
/// the integral of Q T21 cos over outgoing directions, divided by pi 4 C_phi(1/eta) (docs/conventions.md).
std::vector<Rgb> planeRd(Evaluator& evaluator, const Model& model, const Medium& medium, double angle_deg,
                         std::span<const Vec3> points_mm);

/// R_d at distances r, averaged over the azimuth where the model is not radial about the beam.
std::vector<Rgb> radialRd(Evaluator& evaluator, const Model& model, const Medium& medium, double angle_deg,
                          std::span<const double> radii_mm);

/// Mean of R_d over each annulus between consecutive edges: what stands beside a tally. n values for n + 1 edges.
std::vector<Rgb> annulusMeans(Evaluator& evaluator, const Model& model, const Medium& medium, double angle_deg,
                              std::span<const double> edges_mm);

/// Integral of R_d over the plane, per unit transmitted flux, to 1e-10 relative where the model is smooth in r.
Rgb totalRd(Evaluator& evaluator, const Model& model, const Medium& medium, double angle_deg = 0);

struct Tabulation {
    Profile profile;
    double max_relative_error = 0;  ///< found at points between the samples
    double tail = 0;                ///< largest fraction of the total beyond the last radius, over channels
};

/// The azimuthal mean of R_d at normal incidence as a Profile, with samples added until the interpolation error is
/// below `relative_error` wherever 2 pi r^2 R_d matters (docs/architecture.md says where).
Tabulation tabulate(Evaluator& evaluator, const Model& model, const Medium& medium, double relative_error = 1e-4);

}  // namespace searchlight
