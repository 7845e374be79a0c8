// The analogue walk of the half-space on OpenGL, chunk by chunk into the tally of the CPU's.
#pragma once

#include "transport/half_space/half_space_walk.h"
#include "transport/walk/chunks.h"
#include "transport/walk/walk_gl.h"

namespace searchlight {

class HalfSpaceGl {
public:
    /// The context outlives it. Throws a device Error.
    HalfSpaceGl(gl::Context& context, const HalfSpaceWalk& walk, std::uint64_t seed, const ChunkPlan& plan,
                const WalkControl& control);

    /// Adds the exits of a chunk to the tally. Returns the number of collisions.
    std::uint64_t walkChunk(std::uint64_t chunk, ExitTally& tally);

    std::string device() const { return device_.device(); }

private:
    HalfSpaceWalk walk_;
    std::uint64_t seed_;
    WalkGl device_;
};

}  // namespace searchlight
