// Numbers of diffusion that importances of walks are made of.
#pragma once

#include <span>
#include <vector>

namespace searchlight {

/// Rate at which light dies out far from its source, per reduced mean free path; absorbed: 1 - reduced albedo. The
/// largest kappa in albedo = kappa / atanh(kappa), exact for isotropic scattering, and near enough for others.
double asymptoticDecay(double absorbed);

/// Distance beyond the surface at which the diffuse flux seems to vanish, in reduced mean free paths: 2 A D with the
/// moments of the Fresnel reflectance ([dEonIrving2011] appendix). eta: inside over outside.
double extrapolation(double eta);

/// The powers of w that Legendre's polynomials up to order n - 1, with n coefficients, sum up to.
std::vector<double> powersOfLegendre(std::span<const double> coefficients);

}  // namespace searchlight
