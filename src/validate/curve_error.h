// How far a model is from a tally, in numbers.
#pragma once

#include <span>

#include "base/vec.h"

namespace searchlight {

struct CurveError {
    /// Integral of |model - reference| 2 pi r dr over integral of reference 2 pi r dr: the error as a renderer feels
    /// it.
    double weighted = 0;
    double near = 0;  ///< the same over annuli whose middle lies below the split radius
    double far = 0;   ///< and above it
    /// Root mean square of the relative error over the annuli that count (reference error below 5 %).
    double relative_rms = 0;
    /// What the reference's own noise adds to `weighted`: the expected value for a perfect model.
    double noise = 0;
};

/// One channel. `model` and `reference` are means over the annuli between `edges_mm` (n + 1 edges, n values),
/// `standard_error` belongs to the reference; `split_mm` divides near from far (one mean free path is usual).
CurveError curveError(std::span<const Rgb> model, std::span<const Rgb> reference, std::span<const Rgb> standard_error,
                      std::span<const double> edges_mm, int channel, double split_mm);

}  // namespace searchlight
