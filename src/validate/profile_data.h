// Profiles as data to fit to: values with their errors, at points or over annuli.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "validate/fit.h"

namespace searchlight {

struct ProfileData {
    std::string title;
    std::vector<FitData> channels;  ///< 1 or 3, at the same radii, per unit flux that has entered
    double eta = 0;                 ///< that the file states; 0: none
};

/// Reads a CSV table: r_mm, or r0_mm and r1_mm for means over annuli; R_d, or R, G, B, in 1/mm^2; and where they are
/// known the standard errors R_d_stderr, or R_stderr, G_stderr, B_stderr. "# per: incident" needs "# eta: N" and is
/// divided by T12 at normal incidence. Throws an input Error with file, line and column.
ProfileData parseProfileData(std::string_view text, std::string_view path);

/// The data between two radii (0: no limit): annuli that lie within them whole.
FitData between(const FitData& data, double min_mm, double max_mm);

}  // namespace searchlight
