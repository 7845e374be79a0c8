#include "transport/slab/slab_gl.h"

#include "base/error.h"

namespace searchlight {

namespace {

WalkGlPlace placeOf(const SlabWalk& walk) {
    if (!walk.tables.stay.empty())
        throw inputError("OpenGL does not walk tabulated phase functions",
                         "layers with g, or the CPU (--backend cpu), which walks any phase function");
    WalkGlPlace place{
        .first_layer = static_cast<std::size_t>(walk.first), .sin_beam = walk.sin_beam, .cos_beam = walk.cos_beam};
    for (const SlabWalk::Layer& layer : walk.layers)
        place.layers.push_back({.mfp = layer.mfp_mm,
                                .absorbed = layer.absorbed,
                                .g = layer.g,
                                .thickness = layer.thickness_mm,
                                .eta_up = layer.eta_up,
                                .eta_down = layer.eta_down});
    return place;
}

// What SlabTally takes, with the memory behind it.
struct Kept {
    std::vector<float> x, y, z;
    std::vector<std::int32_t> collisions, layer;

    void add(float at_x, float at_y, float at_z, std::int32_t n, std::int32_t in) {
        x.push_back(at_x), y.push_back(at_y), z.push_back(at_z);
        collisions.push_back(n), layer.push_back(in);
    }
    SlabTally::Ends ends() const { return {x, y, z, collisions, layer}; }
};

}  // namespace

SlabGl::SlabGl(gl::Context& context, const SlabWalk& walk, std::uint64_t seed, const ChunkPlan& plan,
               const WalkControl& control)
    : walk_(walk),
      seed_(seed),
      device_(context, placeOf(walk), seed, chunksOnGl(control, plan.chunks(), plan.size), [plan](std::uint64_t chunk) {
          return WalkGlChunk{static_cast<std::uint32_t>(plan.walksOf(chunk)), {}};
      }) {}

std::uint64_t SlabGl::walkChunk(std::uint64_t chunk, SlabTally& tally) {
    const WalkGlEnds ends = device_.ends(chunk);
    // Where on the surface a walk starts does not change it: it is moved where it ends.
    SplitMix64 random = streamOf(seed_, chunk);
    const auto below = static_cast<std::int32_t>(walk_.layers.size());
    Kept exits, absorbed;
    std::uint64_t collisions = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const BeamPoint start = walk_.shape.draw(random, walk_.cos_incidence);
        const double shift = walk_.entry.draw(random);
        const std::int32_t n = ends.collisions[i];
        collisions += static_cast<std::uint64_t>(n);
        const WalkGlEnds::Fate fate = ends.fate(i);
        if (fate == WalkGlEnds::killed) continue;
        const float x = ends.x[i] + static_cast<float>(start.x + shift), y = ends.y[i] + static_cast<float>(start.y);
        if (fate == WalkGlEnds::absorbed)
            absorbed.add(x, y, ends.z[i], n, static_cast<std::int32_t>(ends.detail(i)));
        else
            exits.add(x, y, ends.z[i], n, fate == WalkGlEnds::above ? SlabTally::above : below);
    }
    tally.addExits(exits.ends());
    tally.addAbsorbed(absorbed.ends());
    tally.addCollisions(absorbed.ends());
    return collisions;
}

}  // namespace searchlight
