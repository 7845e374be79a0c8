// Random walks in chunks, each with a random stream of its own, summed in order: threads, processes and interruptions
// leave no trace in the result.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/error.h"
#include "base/observer.h"
#include "base/parallel.h"
#include "base/ranks.h"
#include "transport/walk/walk_state.h"

namespace searchlight {

/// Walks cut into chunks of one size, of which the last may have fewer. Before them may stand chunks of another size
/// that were walked by an earlier run.
struct ChunkPlan {
    std::uint64_t walks = 0;
    std::uint64_t size = 1;
    std::uint64_t chunks_before = 0, walks_before = 0;

    std::uint64_t chunks() const {
        return chunks_before + (walks > walks_before ? (walks - walks_before + size - 1) / size : 0);
    }
    /// Number of the first walk of a chunk.
    std::uint64_t firstOf(std::uint64_t chunk) const { return walks_before + (chunk - chunks_before) * size; }
    std::uint64_t walksOf(std::uint64_t chunk) const { return std::min(size, walks - firstOf(chunk)); }

    /// The plan of a walk that goes on from a state, if there is one. It keeps the size of the chunks, so that an
    /// interruption leaves no trace, unless its own are at least twice as large: then a small first run does not slow
    /// down what follows, and at least 32 of these chunks are to come.
    ChunkPlan goingOn(const WalkState* state) const;
};

/// At least 64 chunks where there are as many walks, of at most 65,536 walks each, or 4,096 where they may stop early.
ChunkPlan planChunks(std::uint64_t walks, bool may_stop = false);

/// When a job that may stop early has enough: asked after 64 chunks, then four times in every doubling, so that the
/// answer depends on the numbers alone.
using EnoughFunction = std::function<bool(const std::vector<BatchRatios>& sums, std::uint64_t walks)>;

struct ChunkedWalk {
    ChunkPlan plan;
    int threads = 0;        ///< 0: all
    EnoughFunction enough;  ///< empty: all walks are walked
    WalkControl control;
};

struct ChunkedResult {
    std::vector<BatchRatios> sums;
    std::uint64_t walks = 0;
    std::uint64_t collisions = 0;
    double seconds = 0;  ///< wall time of walking, that of the state included
    bool interrupted = false;
};

/// Whether `enough` is asked after so many chunks.
bool isMilestone(std::uint64_t chunks);

/// Threads of the process that has the most: blocks are the same for all, whose machines may differ.
std::uint64_t mostThreads(const ChunkedWalk& job);

/// Walks the chunks. `walk(chunk, walks, tally)` fills a fresh copy of `empty` and returns the number of collisions;
/// `add(tally, walks, sums)` takes its sums. A Tally has pack(), a list of doubles, and unpack(), its inverse, to be
/// sent between processes. Throws interruptedError() when cancelled without a state to leave the sums in.
template <class Tally, class Walk, class Add>
ChunkedResult walkChunks(const ChunkedWalk& job, std::vector<BatchRatios> sums, const Tally& empty, Walk&& walk,
                         Add&& add, Observer& observer) {
    const ChunkPlan& plan = job.plan;
    WalkState* const state = job.control.state;
    ChunkedResult result;
    std::uint64_t next = 0;
    if (state && !state->empty()) {
        const auto fits = [](const BatchRatios& a, const BatchRatios& b) { return a.packedSize() == b.packedSize(); };
        if (!std::ranges::equal(sums, state->sums, fits))
            throw inputError("the saved walks have other tallies").at(job.control.file);
        sums = state->sums;
        next = state->chunks;
        result.collisions = state->collisions;
        result.seconds = state->seconds;
        result.walks = state->walks;
    }
    // Blocks bound the memory; within a block threads take chunks as they come, and sums run in chunk order.
    const auto ranks = static_cast<std::uint64_t>(job.control.share ? rankCount() : 1);
    const auto own = static_cast<std::uint64_t>(job.control.share ? rank() : 0);
    const std::uint64_t block = 4 * mostThreads(job);
    const auto begin = std::chrono::steady_clock::now();
    auto saved = begin;
    const double seconds_before = result.seconds;
    const std::uint64_t size_before = state ? state->chunk_size : 0;
    const auto stateOf = [&] {
        const std::uint64_t size = next > plan.chunks_before || next == 0 ? plan.size : size_before;
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        return WalkState{size, next, result.walks, result.collisions, seconds_before + seconds, sums};
    };
    std::optional<WalkState> whole;  // before a last chunk that is not whole
    bool done = job.enough && isMilestone(next) && job.enough(sums, result.walks);
    std::atomic<std::uint64_t> walked = result.walks;
    while (!done && !result.interrupted && next < plan.chunks()) {
        const std::uint64_t count = std::min(block * ranks, plan.chunks() - next);
        struct Slot {
            std::optional<Tally> tally;
            std::uint64_t collisions = 0;
        };
        std::vector<Slot> slots(count);
        parallelFor(count > own ? (count - own + ranks - 1) / ranks : 0, job.threads, [&](std::size_t i) {
            if (observer.cancelled()) return;
            const std::uint64_t at = own + i * ranks, chunk = next + at;
            Slot& slot = slots[at];
            slot.tally.emplace(empty);
            slot.collisions = walk(chunk, plan.walksOf(chunk), *slot.tally);
            observer.progress("walk", std::min(plan.walks, walked += plan.walksOf(chunk) * ranks), plan.walks, "walks");
        });
        if (ranks > 1) {
            std::vector<double> mine;
            for (std::uint64_t at = own; at < count; at += ranks) {
                const std::vector<double> packed = slots[at].tally ? slots[at].tally->pack() : std::vector<double>();
                mine.push_back(static_cast<double>(packed.size()));
                mine.push_back(static_cast<double>(slots[at].collisions));
                mine.insert(mine.end(), packed.begin(), packed.end());
            }
            const std::vector<std::vector<double>> all = gatherAll(mine);
            for (std::uint64_t from = 0; from < ranks; ++from) {
                std::span<const double> rest(all[from]);
                for (std::uint64_t at = from; at < count; at += ranks) {
                    const auto size = static_cast<std::size_t>(rest[0]);
                    slots[at].collisions = static_cast<std::uint64_t>(rest[1]);
                    if (size == 0)
                        slots[at].tally.reset();
                    else
                        slots[at].tally.emplace(empty).unpack(rest.subspan(2, size));
                    rest = rest.subspan(2 + size);
                }
            }
        }
        for (Slot& slot : slots) {
            if (!slot.tally) {
                result.interrupted = true;
                break;
            }
            const std::uint64_t walks = plan.walksOf(next);
            if (walks < plan.size) whole = stateOf();
            add(*slot.tally, walks, sums);
            result.collisions += slot.collisions;
            result.walks += walks;
            ++next;
            slot.tally.reset();
            if (job.enough && isMilestone(next) && job.enough(sums, result.walks)) {
                done = true;
                break;
            }
        }
        const auto now = std::chrono::steady_clock::now();
        if (job.control.save && !whole && now - saved > std::chrono::minutes(1)) {
            job.control.save(stateOf());
            saved = now;
        }
    }
    result.seconds = seconds_before + std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (result.interrupted && !state) throw interruptedError();
    if (state) {
        *state = whole ? std::move(*whole) : stateOf();
        state->seconds = result.seconds;
    }
    result.sums = std::move(sums);
    return result;
}

}  // namespace searchlight
