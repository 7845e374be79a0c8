// A rough dielectric boundary: facets with the distribution of GGX. Directions are in the frame of the surface, whose
// normal is +z, and point away from it.
#pragma once

#include "base/vec.h"

namespace searchlight {

/// [Walter2007] with the height-correlated masking of [Heitz2014].
struct Ggx {
    double alpha = 0.1;         ///< width of the distribution of slopes: the square of a perceptual roughness
    double eta = 1.3;           ///< inside over outside
    bool reflects_all = false;  ///< Fresnel reflectance 1: a mirror's
};

/// BRDF, 1/sr; 0 unless both directions are above the surface.
double ggxValue(const Ggx& ggx, Vec3 wi, Vec3 wo);

/// wi for wo by the distribution of visible normals [Heitz2018], for two uniform numbers in [0, 1). It may lie below
/// the surface: then the sample counts as 0.
Vec3 ggxSample(const Ggx& ggx, Vec3 wo, double u, double v);

/// Of ggxSample(), per solid angle of wi.
double ggxPdf(const Ggx& ggx, Vec3 wi, Vec3 wo);

/// Reflectance of the flat boundary at that cosine outside.
double ggxFresnel(const Ggx& ggx, double cosine);

}  // namespace searchlight
