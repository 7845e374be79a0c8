// A radial sum of random points over receivers, block by block, with Russian roulette on what is far from a block.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/observer.h"
#include "base/vec.h"
#include "render/exitance_sum.h"

namespace searchlight {

/// Receivers in blocks of neighbours, as a VisibleSurface lists them; the last block is filled with its last receiver.
class ReceiverBlocks {
public:
    static constexpr std::size_t size = 64;

    explicit ReceiverBlocks(std::span<const Vec3f> receivers);

    std::size_t count() const { return x.size() / size; }

    std::vector<float> x, y, z;
};

/// Light that entered at points: flux, not per area.
struct BlockSources {
    std::vector<float> x, y, z;
    std::array<std::vector<float>, 3> flux;

    void resize(std::size_t count);
};

struct BlockRoulette {
    /// A point at distance d from the box of a block is taken with probability exp(-rate d), and then counts as many
    /// times more: one decision for the block, independent of other blocks' [Frisvad2014, sec. 4].
    double rate = 0;
    double reach_mm = 0;  ///< points that are further away give nothing
    std::uint64_t seed = 1;
};

/// Sets `sums` to the sum of R_d(|xo - xi|) flux_i per receiver, of which the expectation over seeds is exact but for
/// rounding to float. Does not depend on `threads`. Returns the pairs that were summed. Throws interruptedError().
std::uint64_t sumBlocks(const ReceiverBlocks& receivers, const BlockSources& sources, const RadialTable& table,
                        const BlockRoulette& roulette, int threads, const Observer& observer,
                        std::array<std::vector<float>, 3>& sums);

}  // namespace searchlight
