#include "transport/half_space/half_space_gl.h"

#include <limits>
#include <vector>

namespace searchlight {

namespace {

WalkGlPlace placeOf(const HalfSpaceWalk& walk) {
    return {.layers = {{.absorbed = walk.absorbed,
                        .g = walk.g,
                        .thickness = std::numeric_limits<double>::infinity(),
                        .eta_up = walk.eta}},
            .sin_beam = walk.sin_beam,
            .cos_beam = walk.cos_beam};
}

}  // namespace

HalfSpaceGl::HalfSpaceGl(gl::Context& context, const HalfSpaceWalk& walk, std::uint64_t seed, const ChunkPlan& plan,
                         const WalkControl& control)
    : walk_(walk),
      seed_(seed),
      device_(context, placeOf(walk), seed, chunksOnGl(control, plan.chunks(), plan.size), [plan](std::uint64_t chunk) {
          return WalkGlChunk{static_cast<std::uint32_t>(plan.walksOf(chunk)), {}};
      }) {}

std::uint64_t HalfSpaceGl::walkChunk(std::uint64_t chunk, ExitTally& tally) {
    const WalkGlEnds ends = device_.ends(chunk);
    // Where in a wide beam a walk starts does not change it: it is moved where it ends.
    SplitMix64 random = streamOf(seed_, chunk);
    std::vector<float> x, y;
    std::vector<std::int32_t> collisions;
    std::uint64_t all_collisions = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        all_collisions += static_cast<std::uint64_t>(ends.collisions[i]);
        const BeamPoint start = walk_.shape.draw(random, walk_.cos_incidence);
        if (ends.fate(i) != WalkGlEnds::above) continue;
        x.push_back(ends.x[i] + static_cast<float>(start.x));
        y.push_back(ends.y[i] + static_cast<float>(start.y));
        collisions.push_back(ends.collisions[i]);
    }
    tally.add(x, y, collisions);
    return all_collisions;
}

}  // namespace searchlight
