// The .bssrdf format: a model as text, [Bitterli2013] appendix A.2 with the extensions of docs/bssrdf-format.md.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/param.h"

namespace searchlight {

/// The body of one section, as it stands in the file.
struct BssrdfSection {
    std::string text;    ///< empty: the file has no such section
    int first_line = 0;  ///< 1-based line of the file on which `text` starts

    bool present() const { return first_line > 0; }
};

struct BssrdfFile {
    std::string path;  ///< for messages

    // Attributes of the first line ("analytic" is mandatory and implied).
    bool radial = false;             ///< depends on |xo - xi| alone
    bool no_wi = false;              ///< does not depend on the incident direction
    bool no_wo = false;              ///< does not depend on the exitant direction
    bool normals = false;            ///< reads Ni and No
    bool single_scattering = false;  ///< single scattering is included
    bool reciprocal = false;         ///< claims S(xi,wi;xo,wo) = S(xo,wo;xi,wi)
    bool energy_violation = false;   ///< published as exceeding energy conservation somewhere: reported, not rejected
    bool grosjean = false;  ///< its diffusion coefficient, so its 1/sigma_tr, is Grosjean's, not the classical one
    std::vector<std::string> attributes;  ///< as written, in order

    // Section info.
    std::string title;  ///< falls back to the file's stem
    std::string citation;
    std::string validity;
    std::string notes;

    std::vector<Param> parameters;

    BssrdfSection initializer;          ///< globals (the State) and void init()
    BssrdfSection diffuse_reflectance;  ///< vec3 DiffuseReflectance(vec3 AlphaPrime)
    BssrdfSection shader;               ///< vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo)
};

/// Parses the text of a .bssrdf file. Throws an input Error with file, line and column.
BssrdfFile parseBssrdf(std::string_view text, std::string_view path);

}  // namespace searchlight
