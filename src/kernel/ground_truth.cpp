#include "kernel/ground_truth.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"

namespace searchlight {

GroundTruth::GroundTruth(Profile profile, double tail) : profile_(std::move(profile)), tail_(tail) {
    if (profile_.empty()) throw inputError("a kernel needs a profile");
    total_ = profile_.total();
    for (int c = 0; c < Rgb::channels; ++c) {
        if (!std::isfinite(total_[c]) || total_[c] < 0)
            throw inputError(fmt::format("the profile's total is {:.3g}: no kernel can be made of it", total_[c]),
                             "expected a positive number, or 0 for a channel that does not scatter");
        factor_[c] = total_[c] > 0 ? 1 / total_[c] : 0;
    }
}

Rgb GroundTruth::encircled(double r_mm) const { return factor_ * profile_.encircled(r_mm); }

Rgb GroundTruth::operator()(double r_mm) const { return factor_ * profile_(r_mm); }

}  // namespace searchlight
