// The searchlight in Hankel space for any Henyey-Greenstein medium under a Fresnel surface: transport of one transverse
// frequency, by discrete directions (docs/exact-solver.md).
#pragma once

#include <complex>

namespace searchlight {

/// Lengths are in mean free paths.
struct OrdinateMedium {
    double albedo = 0.5;
    double g = 0;
    double eta = 1;  ///< inside over outside
};

/// How many directions stand for all. Cosines are those of one hemisphere; azimuths those from 0 to pi.
struct OrdinateCount {
    int reflected = 4;  ///< cosines under total reflection, where there is such
    int escaping = 6;   ///< cosines of the rest
    int azimuths = 12;
    int second_panel = 10;  ///< cosines of each of three parts of the hemisphere, for the second order alone
    int second_azimuths = 48;
};

/// Hankel transform, at k = i rate, of the exitance of light that was scattered twice and more, per unit flux that
/// entered at normal incidence. The rate is in the quarter |arg| <= pi/4 of the plane, with a negative imaginary part
/// or below the diffusion rate.
std::complex<double> ordinateTransform(const OrdinateMedium& medium, const OrdinateCount& count,
                                       std::complex<double> rate);

/// Of that, what was scattered exactly twice.
std::complex<double> secondOrderTransform(const OrdinateMedium& medium, const OrdinateCount& count,
                                          std::complex<double> rate);

/// The least rate at which light decays in the depth of the medium, 1 / diffusion length: of the equation in spherical
/// harmonics, whose matrix of three diagonals is singular there. Relative error 1e-12; 0 where nothing is absorbed.
double diffusionRate(const OrdinateMedium& medium);

}  // namespace searchlight
