#include "transport/walk/chunks.h"

#include <algorithm>
#include <bit>

namespace searchlight {

namespace {

constexpr std::uint64_t kFewestChunks = 64;
constexpr std::uint64_t kLargestChunk = 65'536, kLargestThatMayStop = 4'096;

}  // namespace

ChunkPlan planChunks(std::uint64_t walks, bool may_stop) {
    return {walks, std::clamp<std::uint64_t>(walks / kFewestChunks, 1, may_stop ? kLargestThatMayStop : kLargestChunk)};
}

ChunkPlan ChunkPlan::goingOn(const WalkState* state) const {
    ChunkPlan plan = *this;
    if (!state || state->empty() || state->chunks == 0) return plan;
    if (plan.size < 2 * state->chunk_size) plan.size = state->chunk_size;
    plan.chunks_before = state->chunks;
    plan.walks_before = state->walks;
    return plan;
}

std::uint64_t mostThreads(const ChunkedWalk& job) {
    double most = job.threads > 0 ? job.threads : hardwareThreads();
    if (job.control.share)
        for (const std::vector<double>& one : gatherAll({most})) most = std::max(most, one.front());
    return static_cast<std::uint64_t>(most);
}

bool isMilestone(std::uint64_t chunks) {
    // 64, 80, 96, 112, 128, 160, ...: four to each doubling.
    if (chunks < kFewestChunks) return false;
    return chunks % (std::bit_floor(chunks) / 4) == 0;
}

}  // namespace searchlight
