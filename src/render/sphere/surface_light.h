// How light falls on a sphere, coarsely: where entries of light are looked for first.
#pragma once

#include <vector>

#include "light/light_sampler.h"
#include "transport/mesh/surface_cells.h"

namespace searchlight {

/// A density of points on a sphere in proportion to the light that crosses into it, with a tenth of it everywhere, so
/// that what the table has missed is still found. Constant within cells of equal area. Immutable.
class SurfaceLight {
public:
    /// `lights` in the place of a sphere about the origin, of that relative index inside.
    SurfaceLight(const LightSampler& lights, double radius_mm, double eta);

    /// For three uniform numbers in [0, 1): a point, as direction from the centre.
    Vec3 sample(double u, double v, double w) const;

    /// The density of sample(), per mm^2.
    double density(Vec3 direction) const;

private:
    SphereCells cells_;
    std::vector<double> cumulative_;  ///< probability of the cells up to and with each; the last is 1
};

}  // namespace searchlight
