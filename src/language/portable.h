// The portable subset of GLSL, translated to C++: the native twin of a model has the same text as its shader.
// docs/bssrdf-format.md lists what the subset holds.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "language/bssrdf_file.h"

namespace searchlight {

/// A GLSL text that is no model: physics/fresnel.glsl.
struct GlslSource {
    std::string path;  ///< for messages and #line
    std::string text;
};

/// GLSL functions and constants that every model may use, as a C++ class.
struct PortableLibrary {
    std::string cpp;                     ///< template <class Real> struct NAME : glsl::Glsl<Real> { static ... };
    std::string name = "Physics";        ///< of the struct
    std::vector<std::string> functions;  ///< as GLSL calls them, sorted, each once
    std::vector<std::string> constants;  ///< sorted
};

/// Translates functions and const globals of all `sources` into one struct of static members. Throws an input Error
/// with file, line and column for what is outside the subset.
PortableLibrary translateLibrary(std::span<const GlslSource> sources, std::string_view name = "Physics");

/// The model as `template <class Real> struct NAME : LIBRARY<Real>` with the members
///     vec3 SigmaA, SigmaS, G; Real IOR; vec3 Ni, No (with the attribute normals); its parameters; its State;
///     void readParameters(read): calls read("Name", member) for each parameter (Real, bool, int, vec3);
///     void init(); vec3 Bssrdf(Xi, Wi, Xo, Wo) const; vec3 DiffuseReflectance(AlphaPrime) const, if it has one;
///     static constexpr bool uses_normals, has_diffuse_reflectance.
/// Throws an input Error with file, line and column for what is outside the subset.
std::string translateModel(const BssrdfFile& file, const PortableLibrary& library, std::string_view name);

/// Why the model is outside the portable subset (it still runs on GL); nothing when it is inside.
std::optional<Error> portabilityError(const BssrdfFile& file, const PortableLibrary& library);

}  // namespace searchlight
