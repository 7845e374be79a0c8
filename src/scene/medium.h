// What light travels through. Lengths in mm, coefficients in 1/mm.
#pragma once

#include <string>
#include <vector>

#include "base/vec.h"

namespace searchlight {

/// A homogeneous medium, per channel. With `channels` == 1 the three components are equal.
struct Medium {
    Rgb sigma_a;       ///< absorption coefficient, 1/mm
    Rgb sigma_s;       ///< scattering coefficient, not reduced, 1/mm
    Rgb g;             ///< mean cosine of the phase function
    double eta = 1;    ///< refractive index inside over outside
    int channels = 3;  ///< 1 when a single number was given, else 3

    Rgb sigmaSp() const { return sigma_s * (Rgb{1, 1, 1} - g); }  ///< reduced scattering coefficient
    Rgb sigmaTp() const { return sigmaSp() + sigma_a; }           ///< reduced extinction coefficient
    Rgb sigmaT() const { return sigma_s + sigma_a; }
    Rgb alphaPrime() const { return sigmaSp() / sigmaTp(); }  ///< reduced albedo
    /// A channel without scattering has no subsurface reflectance to speak of: "not applicable".
    bool scatters(int channel) const { return sigma_s[channel] > 0; }
};

/// A medium with a name and where its numbers come from.
struct Material {
    std::string id;                    ///< lower_snake_case; "source:id" where two tables share the id
    std::string name;                  ///< for people
    std::vector<std::string> aliases;  ///< further ids that find it
    std::string source;                ///< id of the table: "jensen2001"
    std::string citation;              ///< of the table
    std::string note;                  ///< what to know: "published reduced: ...", doubts about a number
    Medium medium;
    bool reduced = false;    ///< published as sigma_s', taken as sigma_s with g = 0
    bool unit_known = true;  ///< false: the table does not say 1/mm; such a material never enters comparisons
    /// Published total diffuse reflectance, where the table has one (negative: none).
    Rgb published_Rd{-1, -1, -1};
};

/// Throws an input Error unless the numbers describe a medium: sigma_a, sigma_s >= 0, not both 0, |g| < 1,
/// eta in [1/4, 4].
void checkMedium(const Medium& medium);

/// A checked medium from one or three numbers each; `channels` is 1 when all three lists hold one number.
Medium makeMedium(const std::vector<double>& sigma_a, const std::vector<double>& sigma_s, const std::vector<double>& g,
                  double eta);

/// The medium with all its lengths (mean free paths) times `scale`, so all coefficients divided by it:
/// R_d(scale r) becomes R_d(r) / scale^2. Throws a usage Error unless scale is finite and above 0.
Medium scaled(const Medium& medium, double scale);

}  // namespace searchlight
