// A BSSRDF model: analytic (a .bssrdf file), measured (a table of R_d over r), or a sum of such models.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "language/bssrdf_file.h"
#include "model/profile.h"

namespace searchlight {

/// One evaluation: light enters at xi from wi and leaves at xo towards wo. Positions in mm; directions and normals
/// are unit vectors that point away from the surface.
struct Query {
    Vec3 xi, wi, ni;
    Vec3 xo, wo, no;
};

struct Model {
    std::string id;        ///< "dipole"; for a file, its stem
    BssrdfFile file;       ///< of a measured model and of a sum: what a file says about itself, and no GLSL
    bool shipped = false;  ///< its text, or that of every part, is an embedded model's: a native evaluator exists
    bool measured = false;
    Profile profile;           ///< measured only, per transmitted flux
    std::vector<Model> parts;  ///< of a sum (model/sum_model.h), none of them a sum; else empty
};

/// Whether the model's value can depend on the medium: false for measured profiles and for fits in mm.
bool readsMedium(const Model& model);

/// A parameter with a unit, such as the thickness of a slab: the model is about more than a half-space of the medium.
/// Null without one.
const Param* ownLength(const Model& model);

/// Whether an evaluator of it answers diffuseReflectance(): a sum does where all of its parts do.
bool hasDiffuseReflectance(const Model& model);

/// The models inside the executable, in menu order.
const std::vector<Model>& shippedModels();

/// A shipped id ("better_dipole"), or a path to a .bssrdf file or to a measured .csv profile (a path has a '/' or
/// an ending), or several of these with '+' between them: their sum. Throws Error: unknown id with the nearest ones, or
/// what is wrong with the file or the sum.
Model loadModel(std::string_view name);

}  // namespace searchlight
