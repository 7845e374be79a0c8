// A BSSRDF model, analytic (a .bssrdf file) or measured (a table of R_d over r).
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
    BssrdfFile file;       ///< of a measured model: title, attributes (radial no_wi no_wo) and nothing else
    bool shipped = false;  ///< its text is one of the embedded models, so that a native evaluator exists
    bool measured = false;
    Profile profile;  ///< measured only, per transmitted flux
};

/// Whether the model's value can depend on the medium: false for measured profiles and for fits in mm.
bool readsMedium(const Model& model);

/// The models inside the executable, in menu order.
const std::vector<Model>& shippedModels();

/// A shipped id ("better_dipole"), or a path to a .bssrdf file or to a measured .csv profile (a path has a '/' or
/// an ending). Throws Error: unknown id with the nearest ones, or what is wrong with the file.
Model loadModel(std::string_view id_or_path);

}  // namespace searchlight
