// Two Gaussians set by hand: near and far ([Freude2014] Eq. 5.21).
#pragma once

#include <span>
#include <string_view>

#include "kernel/kernel.h"

namespace searchlight {

struct TwoGaussians {
    Rgb near_mm{0.1, 0.1, 0.1};  ///< square root of tau_n, mm
    Rgb far_mm{1, 1, 1};         ///< square root of tau_f, mm
    double near_weight = 0.5;    ///< w: the part of the near one
};

/// One term, a = w G(tau_n) + (1 - w) G(tau_f), of mass 1.
SeparableKernel twoGaussians(const TwoGaussians& options);

struct TwoGaussiansPreset {
    std::string_view material;
    TwoGaussians values;
};

/// [Freude2014] Table A.1.
std::span<const TwoGaussiansPreset> twoGaussiansPresets();

/// Throws a usage Error with the valid names.
const TwoGaussians& twoGaussiansPreset(std::string_view material);

}  // namespace searchlight
