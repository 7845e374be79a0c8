// The surface as lights see it: what a translucent shadow map holds [Dachsbacher2003; Chang2007, sec. 3.3.2].
#pragma once

#include <cstdint>
#include <vector>

#include "base/observer.h"
#include "base/vec.h"
#include "render/technique.h"

namespace searchlight {

/// The surface seen from a light, as a patch of a plane per texel. Seen from afar (parallel light) u = x, v = y and
/// depth = z; seen from a point u = x/z, v = y/z and depth = 1/z: both are linear on a plane. x, y and z are mm along
/// right, up and forward from `origin`.
struct LightMap {
    /// Of a texel: depth at its middle, its slopes per texel along u and v, 1 where something is seen and 0 elsewhere,
    /// and the light: flux that crossed into the medium per unit of u and v, from a point over z^3.
    static constexpr std::size_t floats = 8;

    bool central = false;  ///< seen from the point `origin`; else from afar
    Vec3 origin, right, up, forward;
    int width = 0, height = 0;
    float u0 = 0, v0 = 0, texel = 0;  ///< the corner of texel (0, 0), and the side of a texel
    std::vector<float> cells;         ///< rows of width + 2, floats each: a border around, in which nothing is seen

    std::size_t cellAt(int x, int y) const {
        return (static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(width + 2) +
                static_cast<std::size_t>(x + 1)) *
               floats;
    }
};

struct LightMaps {
    std::vector<LightMap> maps;  ///< none of them dark
    int views = 0;               ///< from which maps were drawn, dark ones included
    int spread_lights = 0;       ///< lights without a view of their own
    std::size_t texels = 0;      ///< that see the surface, and count
    /// Places that shading normals light though their triangle is turned away, or seen edge on, in the view of a light:
    /// on coarse meshes one per cent of the light. In no map.
    PointCloud grazed;
    std::vector<Rgbf> grazed_light;  ///< flux per mm^2 that crossed into the medium there
};

/// Parallel lights and points outside the object have a map each: what is not seen from there is in their shadow.
/// Discs, environments and points in the object's midst or close to it light all that these together are seen by: maps
/// from the 14 directions of a cube's faces and corners, where each place counts in the one that sees it least at a
/// slant; what none of them sees is lost. `resolution`: texels along the longer side. Reads object, rays, scene and
/// light of `input`. Throws interruptedError() when cancelled.
LightMaps lightMaps(const RenderInput& input, int resolution, Observer& observer);

}  // namespace searchlight
