// Numbers of diffusion that importances of walks are made of.
#pragma once

namespace searchlight {

/// Rate at which light dies out far from its source, per reduced mean free path; absorbed: 1 - reduced albedo. The
/// largest kappa in albedo = kappa / atanh(kappa), exact for isotropic scattering, and near enough for others.
double asymptoticDecay(double absorbed);

/// Distance beyond the surface at which the diffuse flux seems to vanish, in reduced mean free paths: 2 A D with the
/// moments of the Fresnel reflectance ([dEonIrving2011] appendix). eta: inside over outside.
double extrapolation(double eta);

}  // namespace searchlight
