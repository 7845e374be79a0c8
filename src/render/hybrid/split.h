// R_d as a local and a global part [Chang2007, sec. 3.3.1], without units of its own.
#pragma once

#include "base/vec.h"
#include "model/profile.h"

namespace searchlight {

struct Split {
    Profile local, global;  ///< add up to the whole
    Rgb border_mm;          ///< R_p per channel: where both weigh the same; 0: all is global
    Rgb local_share;        ///< of the total
};

/// Per channel R_p is the largest radius at which 2 pi r |R_d|, the light that arrives per mm of distance, is
/// `share` of the total per `spacing_mm`, the distance between neighbouring samples of the global part:
///     2 pi R_p |R_d(R_p)| spacing = share total.
/// So what is left to the samples brings little within the distance from one to the next, whatever the unit of length,
/// the material and the size of the object. W_l = 1 - e^((r - R_p) K) / 2 up to R_p (the thesis prints the other sign
/// in the exponent) and e^(-(r - R_p) K) / 2 from there, with K R_p = 3.6 as in its Fig. 3.4.
Split splitProfile(const Profile& profile, double spacing_mm, double share);

}  // namespace searchlight
