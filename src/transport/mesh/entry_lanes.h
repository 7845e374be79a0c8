// Light that arrives at points of a surface, many at once: where it goes on below, if it is not mirrored.
#pragma once

#include <cstddef>
#include <cstdint>

namespace searchlight {

struct EntryLanes {
    static constexpr std::size_t kMost = 64;

    alignas(64) float nx[kMost] = {}, ny[kMost] = {}, nz[kMost] = {};  ///< normals, outward, unit
    alignas(64) float wx[kMost] = {}, wy[kMost] = {}, wz[kMost] = {};  ///< towards the light, unit
    alignas(64) std::int32_t bits[kMost] = {};                         ///< random: of what is mirrored
    std::size_t count = 0;

    std::uint64_t enters = 0;                                          ///< a bit for each: crosses the surface
    alignas(64) float dx[kMost] = {}, dy[kMost] = {}, dz[kMost] = {};  ///< refracted, unit; of those that enter
};

/// Draws directions towards uniform radiance: by their cosine, from two random words each.
void drawDiffuse(EntryLanes& lanes, const std::int32_t* heights, const std::int32_t* turns);

/// Refracts into a medium of that index, or mirrors with Fresnel's probability. Targets with FMA agree bit for bit.
void refractInwards(EntryLanes& lanes, double eta);

}  // namespace searchlight
