// Means of a model over parts of the plane and of the hemisphere: what stands beside the tallies of oblique light.
// Conventions are those of plane.h.
#pragma once

#include <span>
#include <vector>

#include "model/plane.h"

namespace searchlight {

/// A rectangle of the plane, mm.
struct PlaneCell {
    double x0 = 0, x1 = 1, y0 = 0, y1 = 1;
};

/// Mean of R_d over each cell, 1/mm^2 per unit transmitted flux. Cells near the entry point are divided until what is
/// left about it holds 1e-4 of the cell's area; where R_d goes as 1/r that much is lost.
std::vector<Rgb> cellMeans(Evaluator& evaluator, const Model& model, const Medium& medium, double angle_deg,
                           std::span<const PlaneCell> cells);

/// Moments of R_d over the plane.
struct PlaneMoments {
    Rgb total;    ///< integral of R_d, per unit transmitted flux
    Rgb mean_x;   ///< mm, of what leaves; the refracted beam leans towards +x. Exactly 0 for a model that is radial
    Rgb mean_r2;  ///< mm^2, about the entry point; without absorption it does not exist: NaN
};

/// By sums over the logarithm of r (20 a factor e) and 64 azimuths; relative error below 1e-6 for a model that is
/// smooth in both, 1e-3 for one that is clamped.
PlaneMoments planeMoments(Evaluator& evaluator, const Model& model, const Medium& medium, double angle_deg);

/// A sector of an annulus about the entry point, and the cells of the hemisphere of a RadianceResult.
struct PlaneSector {
    double r0_mm = 0, r1_mm = 1;
    double azimuth_deg = 0, half_width_deg = 10;  ///< from +x
};

/// Outgoing radiance, 1/(mm^2 sr) per unit transmitted flux: Q T21 / (pi 4 C_phi(1/eta)), averaged over the sector and,
/// weighted by the cosine, over each cell of the hemisphere: polar * turns values, [i * turns + j].
std::vector<Rgb> sectorRadiance(Evaluator& evaluator, const Medium& medium, double angle_deg, const PlaneSector& sector,
                                int polar, int turns);

}  // namespace searchlight
