// A surface spread out on a square of texels: charts, how well they fit, where they lie. docs/texture-space.md.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/image.h"
#include "base/observer.h"
#include "geometry/atlas/stretch.h"
#include "scene/mesh.h"

namespace searchlight {

enum class AtlasUvs {
    automatic,  ///< the mesh's own where they are sound, else a new atlas
    own,        ///< always a new atlas
    file,       ///< the mesh's own, or an Error
};

struct AtlasOptions {
    int resolution = 256;    ///< texels along a side
    int gutter = 1;          ///< texels between charts of a new atlas
    double stretch = 1.1;    ///< a chart with more L^2 stretch is cut in two
    bool conformal = false;  ///< few charts that keep angles alone, and are not cut for their stretch
    AtlasUvs uvs = AtlasUvs::automatic;
    int threads = 0;  ///< 0: all
};

struct AtlasReport {
    bool from_file = false;  ///< uvs of the mesh
    std::size_t charts = 0;
    Stretch stretch;
    double fill = 0;    ///< area of the charts over that of the square
    std::string fault;  ///< why uvs of the mesh were not taken; empty where they were, or where there are none
};

struct Atlas {
    int resolution = 0;
    std::vector<FlatTriangle>
        triangles;  ///< of the mesh, in texels, counter-clockwise; of no area where the surface has none
    std::vector<std::uint32_t> charts;  ///< of each triangle; no_triangle where it has no area
    AtlasReport report;
};

/// Charts grow over the surface, are laid flat, and are cut in two until each is one to one and stretched no more than
/// asked for; then they are packed. Open surfaces and such as are no manifold are cut at their faults. Throws an input
/// Error for a mesh without area or with a position that is not finite, and for options.uvs == file where the mesh's
/// uvs are not sound; a usage Error where the texels do not suffice for the charts; interruptedError().
Atlas makeAtlas(const Mesh& mesh, const AtlasOptions& options, Observer& observer);

/// The mesh with the atlas as its uvs; vertices on the borders of charts are doubled.
Mesh withAtlasUvs(const Mesh& mesh, const Atlas& atlas);

/// The charts, each in a colour of its own, darker where a texel stands for more surface; transparent between them.
/// `scale` pixels a texel.
Image atlasPicture(const Mesh& mesh, const Atlas& atlas, int scale);

}  // namespace searchlight
