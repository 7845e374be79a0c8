#include "transport/mesh/beam_source.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace searchlight {

namespace {

// A walk asks so often in the mean: that costs about what the walk does, and noise is hardly more than where each
// collision asks.
constexpr double kAsks = 4, kMostOf = 16;

// Walks end as they come through, after a mean chord, or are absorbed.
int oneOf(const MeshBody& mesh, const BodyMedium& medium) {
    const double chord = 4 * mesh.volume() / mesh.area();
    const double collisions = 1 / (1 / (chord * medium.sigma_t) + medium.absorbed);
    return static_cast<int>(std::bit_floor(static_cast<unsigned>(std::clamp(collisions / kAsks, 1.0, kMostOf))));
}

}  // namespace

BeamSource::BeamSource(CameraSource<MeshBody> walks, const FacetBeams& beams, int one_of, SplitMix64 random)
    : CameraSource<MeshBody>(std::move(walks)), beams_(beams), one_of_(one_of), random_(random) {}

bool BeamSource::next(Entry& entry) {
    if (!CameraSource<MeshBody>::next(entry)) return false;
    walks_.push_back({entry.tag, 0});
    entry.tag = static_cast<std::uint32_t>(walks_.size() - 1);
    return true;
}

void BeamSource::leave(std::uint32_t tag, float weight, Vec3 direction, const Crossing& crossing,
                       std::vector<CellExit>&) {
    walks_[tag].weight += weight * static_cast<float>(radianceBeyond(direction, crossing, false));
}

void BeamSource::leaveScattered(std::uint32_t tag, float weight, Vec3f start, Vec3 direction, const Crossing& crossing,
                                std::vector<CellExit>&) {
    const bool asked = length(toDouble(crossing.position) - toDouble(start)) < beams_.discReach_mm();
    walks_[tag].weight += weight * static_cast<float>(radianceBeyond(direction, crossing, asked));
}

void BeamSource::collide(std::uint32_t tag, float weight, Vec3f position, Vec3f direction) {
    const double found = beams_.scattered(position, toDouble(direction), random_, rays_);
    walks_[tag].weight += static_cast<float>(one_of_ * found) * weight;
}

void BeamSource::finish(BodyChunk& chunk) const {
    chunk.rays += rays_;
    for (const CellExit& walk : walks_)
        if (walk.weight > 0) chunk.cells.push_back(walk);
}

BodyChunk walkBeamsChunk(const MeshBody& mesh, const BodyMedium& medium, const FacetBeams& beams,
                         CameraSource<MeshBody>& source, SplitMix64 random) {
    BeamSource asking(source, beams, oneOf(mesh, medium), SplitMix64(random.next()));
    BodyMedium each = medium;
    each.ways = 0;  // a large step does not say where it collides
    BodyChunk chunk = walkBodyChunk(mesh, each, asking, random);
    asking.finish(chunk);
    return chunk;
}

}  // namespace searchlight
