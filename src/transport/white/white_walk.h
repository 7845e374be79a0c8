// One chunk of walks without absorption in a half-space, in the widest instruction set of this machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace searchlight {

/// Lengths are in mean free paths.
struct WhiteWalk {
    double g = 0;
    double eta = 1;       ///< inside over outside
    double sin_beam = 0;  ///< of the refracted beam, which leans towards +x
    double cos_beam = 1;
    double roulette = 1;  ///< above 0: a walk lives through n collisions with probability exp(-roulette n)
};

/// Where walks left, in the order in which they did.
struct WhiteExits {
    std::vector<float> x, y;
    std::vector<float> length;  ///< of the whole path, up to the surface
    std::vector<std::int32_t> collisions;
    std::size_t count = 0;  ///< the lists are longer
};

/// Starts `walks` walks of the stream (seed, chunk), finishes them all and stores every exit. Returns the number of
/// collisions. AVX2 and AVX-512 agree bit for bit.
std::uint64_t walkWhiteChunk(const WhiteWalk& walk, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                             WhiteExits& exits);

/// The instruction set that walkWhiteChunk uses: "AVX3", "AVX2", "SSE4"...
const char* whiteInstructionSet();

}  // namespace searchlight
