// A judged kernel as text for an engine.
#pragma once

#include <string>
#include <vector>

#include "job/kernel/kernel_judged.h"
#include "job/kernel/kernel_truth.h"

namespace searchlight {

/// Names that exportedKernel takes: hlsl, glsl, c, json, godot, unreal, unity.
std::vector<std::string> kernelExports();

/// Taps, or the profile of an engine, with units, material, method, rank and errors in a comment. Throws a usage Error
/// with the valid names.
std::string exportedKernel(const std::string& format, const JudgedKernel& judged, const Subject& subject,
                           const KernelTruth& truth);

}  // namespace searchlight
