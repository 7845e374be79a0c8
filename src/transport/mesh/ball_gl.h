// The analogue walk in a ball on OpenGL. Light is drawn and enters on the CPU, as for every body.
#pragma once

#include <deque>
#include <functional>

#include "transport/mesh/body_walk.h"
#include "transport/walk/walk_gl.h"

namespace searchlight {

class BallGl {
public:
    /// What enters in a chunk.
    using SourceFunction = std::function<EntrySource<Ball>(std::uint64_t chunk)>;

    /// `seed`: of the walks' own random numbers. Ball and context outlive it. Throws a device Error.
    BallGl(gl::Context& context, const Ball& ball, const BodyMedium& medium, std::uint64_t seed,
           const WalkGl::Chunks& chunks, SourceFunction sourceOf);

    /// Each chunk once, at most 4 from their order.
    BodyChunk walkChunk(std::uint64_t chunk);

private:
    // A chunk that walks, before any has ended.
    struct Entered {
        std::uint64_t chunk = 0;
        BodyChunk so_far;
        std::vector<float> weights;
    };
    WalkGlChunk enter(std::uint64_t chunk);

    const Ball& ball_;
    SourceFunction sourceOf_;
    std::deque<Entered> entered_;
    WalkGl device_;
};

}  // namespace searchlight
