#include "transport/mesh/ball_gl.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace searchlight {

BallGl::BallGl(gl::Context& context, const Ball& ball, const BodyMedium& medium, std::uint64_t seed,
               const WalkGl::Chunks& chunks, SourceFunction sourceOf)
    : ball_(ball),
      sourceOf_(std::move(sourceOf)),
      device_(
          context,
          {.layers = {{.mfp = 1 / medium.sigma_t, .absorbed = medium.absorbed, .g = medium.g, .eta_up = medium.eta}},
           .ball_radius = ball.radius()},
          seed, chunks, [this](std::uint64_t chunk) { return enter(chunk); }) {}

WalkGlChunk BallGl::enter(std::uint64_t chunk) {
    EntrySource<Ball> source = sourceOf_(chunk);
    Entered& entered = entered_.emplace_back(Entered{chunk, {}, {}});
    WalkGlChunk walks;
    for (Entry entry; source.next(entry);) {
        walks.starts.push_back({entry.position, entry.direction});
        entered.weights.push_back(entry.weight);
    }
    walks.walks = static_cast<std::uint32_t>(walks.starts.size());
    entered.so_far.entry = source.totals();
    entered.so_far.candidates = source.tried();
    return walks;
}

BodyChunk BallGl::walkChunk(std::uint64_t chunk) {
    const WalkGlEnds ends = device_.ends(chunk);
    const auto entered = std::ranges::find(entered_, chunk, &Entered::chunk);
    assert(entered != entered_.end() && entered->weights.size() == ends.size());
    BodyChunk result = std::move(entered->so_far);
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const auto collisions = static_cast<std::uint64_t>(ends.collisions[i]);
        result.collisions += collisions;
        result.flights += ends.detail(i);
        result.rays += ends.detail(i) - collisions;
        const float weight = entered->weights[i];
        if (ends.fate(i) == WalkGlEnds::absorbed) {
            result.absorbed += weight;
            continue;
        }
        const Vec3 at{ends.x[i], ends.y[i], ends.z[i]};
        result.left += weight;
        result.exits = result.exits + static_cast<double>(weight) * at;
        result.cells.push_back({ball_.cells().at(at), weight});
    }
    entered_.erase(entered);
    return result;
}

}  // namespace searchlight
