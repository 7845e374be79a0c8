// How a collision turns a walk where Henyey-Greenstein will not do: a phase function given as a table.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace searchlight {

/// Of the scattering angle alone. Between the samples linear in the cosine, and sampled as exactly that.
struct PhaseFunction {
    std::vector<double> angles_deg;  ///< ascending, from 0 to 180
    std::vector<double> values;      ///< per steradian, up to a common factor; not negative, not all 0

    bool operator==(const PhaseFunction&) const = default;
};

/// Mean cosine of the scattering angle.
double meanCosine(const PhaseFunction& phase);

/// 3 (1 + cos^2) / (16 pi): particles far smaller than the wavelength, unpolarised. The table is exact to 4e-6.
PhaseFunction rayleighPhase();

/// Reads a table with the columns angle_deg and p. Throws an input Error with file, line and column.
PhaseFunction parsePhase(std::string_view text, std::string_view path);

/// Alias tables ([Walker1977]) of any number of phase functions in one list: a bin is kept with the probability `stay`
/// or changed for `alias`; within it the density is linear.
struct PhaseTables {
    struct Range {
        std::int32_t first = 0, count = 0;  ///< count 0: no table
    };

    /// Appends a phase function.
    Range add(const PhaseFunction& phase);

    static constexpr std::int32_t kStays = 0x7FFFFFFF;  ///< a probability of 1
    std::vector<std::int32_t> stay;                     ///< in 1 / kStays
    std::vector<std::int32_t> alias;
    std::vector<float> begin, width;  ///< of the bin, in 1 - cos
    std::vector<float> density;       ///< at its begin, over the mean of the bin
};

}  // namespace searchlight
