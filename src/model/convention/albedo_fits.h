// From single scattering to the reflectance of a half-space and back: the fits that renderers carry.
//
// With s = sqrt((1 - alpha) / (1 - g alpha)) = sqrt(sigma_a / sigma_t') a half-space of any g looks like an isotropic
// one: s = 0 absorbs nothing, s = 1 scatters nothing [vandeHulst1980]. Inverses return NaN where there is none.
#pragma once

namespace searchlight {

/// s of a single-scattering albedo, and the albedo of s.
double similarity(double alpha, double g);
double albedoOfSimilarity(double s, double g);

/// Reflectance for diffuse light of a half-space without a boundary, [vandeHulst1980]: within 0.0021 of exact. Its
/// inverse solves the quadratic; [Kulla2017] and OpenPBR print the same root with six digits.
double vanDeHulst(double s);
double vanDeHulstInverse(double reflectance);

/// Albedo of isotropic scatterers for a reflectance, [Chiang2016]; 0.99885 at reflectance 1, and no more.
double chiangAlbedo(double reflectance);
double chiangInverse(double alpha);

/// The same at any g in [0, 0.9], [Wrenninge2017], as Cycles has it: clamped to 0.999999.
double wrenningeAlbedo(double reflectance, double g);
double wrenningeInverse(double alpha, double g);

/// Total of the classical dipole, [JensenBuhler2002], with the published fit of the inner reflectance.
double dipoleReflectance(double s, double eta);
double dipoleInverse(double reflectance, double eta);

/// Which fit of [ChristensenBurley2015] gives the width d of a normalized diffusion profile: a normal beam in mean free
/// paths (Eq. 5), diffuse light in mean free paths (Eq. 6), a normal beam in diffuse mean free paths (Eq. 8).
enum class BurleyWidth { searchlight, diffuse, diffuse_mean_free_path };

/// s of Eq. 5, 6 or 8: d is the free path over it.
double burleyScale(BurleyWidth width, double A);

/// Reflectance per flux that has entered a half-space behind a surface of index eta, as models/normalized_diffusion has
/// it: [vandeHulst1980] for diffuse light, a fit of the same form for a normal beam, then [Saunderson1942].
double surfaceAlbedo(BurleyWidth width, double s, double eta);
double surfaceAlbedoInverse(BurleyWidth width, double A, double eta);

}  // namespace searchlight
