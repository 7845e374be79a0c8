// Kernels as text that engines take, and back.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/ground_truth.h"
#include "kernel/kernel.h"

namespace searchlight {

/// What a kernel's text says about it in its comment.
struct KernelLabel {
    std::string material;             ///< "Skin1"
    std::string truth;                ///< what it was made from
    std::string method;               ///< "preintegrated"
    std::vector<std::string> errors;  ///< lines: "picture RMS 0.0203 ..."
};

struct TapsFormat {
    std::string_view name;   ///< "hlsl"
    std::string_view shows;  ///< one line
    std::string (*write)(const Taps& taps, const KernelLabel& label);
};

/// hlsl, glsl, c, json, godot: tables of (R, G, B, offset in mm), the middle first, then ascending; godot has one side
/// only. Every term is a table with its own angle and factor.
std::span<const TapsFormat> tapsFormats();

/// Names of the engines' own profiles, which are not taps: unreal, unity.
std::span<const std::string_view> engineProfiles();

/// The values of an engine's profile that come nearest to the truth, with a comment. `eta` inside over outside.
std::string engineProfile(std::string_view name, const GroundTruth& truth, const KernelLabel& label, double eta);

/// A table of a file: one term.
struct KernelTable {
    std::string name;                 ///< of the array; may be empty
    int line = 0;                     ///< of its first vector, 1-based
    int index = 1, count = 1;         ///< "term 1 of 2"
    TapTerm term;                     ///< both sides, ascending; what is a delta in the file is part of the middle
    bool one_sided = false;           ///< the file had one side, which was mirrored
    std::vector<std::string> faults;  ///< what a kernel should not have: sums off 1, order, symmetry, signs
};

inline constexpr std::size_t most_kernel_tables = 64, most_kernel_taps = 999;

/// All arrays of at least 3 four-vectors (float4, vec4, half4, or { r, g, b, offset }) in HLSL, GLSL or C; other code
/// is passed over. Offsets are taken as mm. The comments of this program's own tables are understood. Throws an input
/// Error with file, line and column for a table that is broken, and for text without one.
std::vector<KernelTable> parseKernelTables(std::string_view text, std::string_view path);

/// Tables that are terms of one kernel together, others alone, in the file's order.
std::vector<Taps> kernelsOfTables(const std::vector<KernelTable>& tables);

}  // namespace searchlight
