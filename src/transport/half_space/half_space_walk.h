// One chunk of walks in a half-space, in the widest instruction set of this machine.
#pragma once

#include <cstdint>

#include "transport/half_space/radiance_tally.h"
#include "transport/walk/beam.h"
#include "transport/walk/tally.h"

namespace searchlight {

/// What a walk knows of its medium. Lengths are in mean free paths: then every coordinate that matters to a tally is of
/// order 1, and float carries it (see half_space_walk.cpp).
struct HalfSpaceWalk {
    double absorbed = 0;  ///< 1 - albedo, which keeps its digits near albedo 1
    double g = 0;
    double eta = 1;       ///< inside over outside
    double sin_beam = 0;  ///< of the refracted beam, which leans towards +x
    double cos_beam = 1;
    BeamShape shape = {};      ///< its radius in mean free paths
    double cos_incidence = 1;  ///< outside
};

/// Starts `walks` walks of the stream (seed, chunk), finishes them all and adds every exit to the tally. Returns the
/// number of collisions.
std::uint64_t walkHalfSpaceChunk(const HalfSpaceWalk& walk, std::uint64_t seed, std::uint64_t chunk,
                                 std::uint64_t walks, ExitTally& tally);
/// The same walks, counted by where and whither they leave.
std::uint64_t walkHalfSpaceChunk(const HalfSpaceWalk& walk, std::uint64_t seed, std::uint64_t chunk,
                                 std::uint64_t walks, RadianceTally& tally);

/// The instruction set that walkHalfSpaceChunk uses: "AVX3", "AVX2", "SSE4"...
const char* halfSpaceInstructionSet();

}  // namespace searchlight
