// The first separable kernel, made for skin and bent towards other media by three numbers ([Jimenez2015]; [Freude2014]
// Eq. 4.8).
#pragma once

#include "kernel/cells.h"

namespace searchlight {

/// a(x) = t p(w x / (0.001 + f)) + (1 - t) delta, where p is the red channel of skin6 without its narrowest Gaussian,
/// normalised.
struct SkinModel {
    double width = 1;                ///< w
    Rgb strength{0.48, 0.41, 0.28};  ///< t: how much light moves at all
    Rgb falloff{1.0, 0.37, 0.3};     ///< f
};

SeparableKernel skinModelKernel(const SkinModel& model);

/// t and f per channel that are nearest to the truth in kernel space, [Freude2014] Eq. 4.13; w stays 1, as f does the
/// same.
SkinModel fittedSkinModel(const CellKernel& truth);

/// The taps of the original program, number for number: profile times half the distance to the neighbours, normalised,
/// then mixed with the middle by t. `count` is odd; offsets end at 2, from 21 taps on at 3.
Taps originalTaps(const SkinModel& model, int count);

}  // namespace searchlight
