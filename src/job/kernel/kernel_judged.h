// Kernels with their errors.
#pragma once

#include <string>
#include <vector>

#include "job/json.h"
#include "kernel/judge.h"
#include "kernel/methods.h"

namespace searchlight {

struct JudgedKernel {
    MadeKernel made;
    double seconds = 0;              ///< to make it
    Rgb kernel_rms, kernel_rms_raw;  ///< after and before normalisation; equal where nothing was normalised
    bool has_lines = true;           ///< false: kernel_rms is of what the taps stand for
    std::vector<Rgb> image_rms;      ///< [signal]
    double overall = 0;              ///< over signals and channels
    double flip = 0, ssim = 1;       ///< means over the signals
};

/// `perceptual` false: flip and ssim are left out.
JudgedKernel judgeKernel(MadeKernel made, const Judge& judge, bool perceptual, int threads);
JudgedKernel makeAndJudge(const GroundTruth& truth, const Judge& judge, const MethodOptions& options, bool perceptual,
                          int threads);

/// Every method at that count of taps, as --all shows them: `passes` pairs at most 3 where rank is free.
std::vector<MethodOptions> allMethods(int taps);

/// "error", "taps", "norm1" and what else the JSON of one kernel has.
Json judgedJson(const JudgedKernel& judged);

/// A table for people: one line per kernel.
std::string judgedText(const std::vector<JudgedKernel>& kernels);

/// Lines for the comment of an exported table.
std::vector<std::string> errorLines(const JudgedKernel& judged);

}  // namespace searchlight
