// The analogue walk through plane layers on OpenGL, chunk by chunk into the tally of the CPU's.
#pragma once

#include "transport/slab/slab_walk.h"
#include "transport/walk/chunks.h"
#include "transport/walk/walk_gl.h"

namespace searchlight {

class SlabGl {
public:
    /// Collisions that absorb are counted, and no others: counted of a layer is its absorbed. The context outlives
    /// it. Throws an input Error for tabulated phase functions, a device Error when the device cannot hold it.
    SlabGl(gl::Context& context, const SlabWalk& walk, std::uint64_t seed, const ChunkPlan& plan,
           const WalkControl& control);

    /// Adds the ends of a chunk to the tally. Returns the number of collisions.
    std::uint64_t walkChunk(std::uint64_t chunk, SlabTally& tally);

    std::string device() const { return device_.device(); }

private:
    SlabWalk walk_;
    std::uint64_t seed_;
    WalkGl device_;
};

}  // namespace searchlight
