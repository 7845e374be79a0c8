// Instruction sets that vector code can be tried on.
#pragma once

#include <hwy/targets.h>

#include <cstdint>

namespace searchlight {

/// Whether this processor has the instruction set, as HWY_AVX2, and the code was compiled for it.
inline bool hasInstructionSet(std::int64_t target) { return (hwy::SupportedTargets() & HWY_TARGETS & target) != 0; }

}  // namespace searchlight
