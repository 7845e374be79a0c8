// The names that GLSL and Searchlight keep for themselves.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace searchlight {

/// A type that a variable may have and a buffer block may hold: float, int, vec3, mat3x4 ... (no double, no sampler).
bool isGlslValueType(std::string_view name);

/// A word of GLSL 4.50 that cannot name anything: keywords, types, and words kept for the future.
bool isGlslKeyword(std::string_view name);

/// Values that Searchlight gives to every model: SigmaA, SigmaS, G, IOR, PI, and Ni, No with the attribute normals.
bool isModelGlobal(std::string_view name);

/// The built-in functions of the portable subset, in alphabetical order.
const std::vector<std::string>& portableBuiltins();

/// Why a model may not use `name` for a parameter or a State global; empty when it may.
std::string whyReserved(std::string_view name);

}  // namespace searchlight
