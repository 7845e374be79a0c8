// Unoccluded light from an environment, for every normal at once.
#pragma once

#include <vector>

#include "base/vec.h"
#include "light/environment.h"

namespace searchlight {

/// Flux per area that crosses into the medium by direction of the normal: the integral of T12(wi) L(wi) cos over the
/// hemisphere around it, T12 exact. By spherical harmonics up to order 64. The largest error, relative to the largest
/// value, is that of light from a single pixel: 8e-4 for eta of 1.3 and more, 1.1e-3 at 1.1, 6e-3 at 1, where the
/// cosine has its edge; 0.2, on a thin ring, below 1, where total reflection has a sharper one. Under a real sky with a
/// sun and eta 1.3 every normal is right within 0.5 %.
class EnvironmentIrradiance {
public:
    /// Result does not depend on `threads` (0: all).
    EnvironmentIrradiance(const Environment& environment, double eta, int threads = 0);

    /// `normal` unit; bilinear in a table of one degree.
    Rgbf operator()(Vec3f normal) const;

private:
    std::vector<Rgbf> table_;  ///< rows from +y to -y, columns by longitude, the first one repeated
};

}  // namespace searchlight
