#include "transport/mesh/beam_source.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace searchlight {

namespace {

// Where walks are long, asking one of so many collisions costs about as much as walking, and noise is hardly more than
// that of the walks themselves. Short walks, in bodies that are thin, ask oftener.
constexpr double kMostOf = 16;

int oneOf(const MeshBody& mesh, const BodyMedium& medium) {
    const double chord = 4 * mesh.volume() / mesh.area();  // in the mean
    return static_cast<int>(std::bit_floor(static_cast<unsigned>(std::clamp(chord * medium.sigma_t, 1.0, kMostOf))));
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
