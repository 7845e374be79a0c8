// The sums of random walks that may stop, go on, and be shared between processes.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "transport/walk/tally.h"

namespace searchlight {

/// Raised whenever sums of before no longer go on: other estimators, other random numbers, other sums. 2: sums know
/// their walks.
constexpr int kWalkVersion = 2;

/// What a job has summed so far. Going on to the same number of walks gives the numbers of one that never stopped.
struct WalkState {
    std::uint64_t chunk_size = 0;  ///< of the last chunks; 0: nothing was walked yet
    std::uint64_t chunks = 0;      ///< whole chunks behind the sums
    std::uint64_t walks = 0;       ///< in them: what the first of the sums divides by
    std::uint64_t collisions = 0;
    double seconds = 0;
    std::vector<BatchRatios> sums;

    bool empty() const { return chunk_size == 0; }
};

/// How long walks are walked, beyond their number.
struct WalkControl {
    double until_error = 0;      ///< above 0: stop when what is known best has this relative standard error
    bool share = false;          ///< with the other processes of the job (base/ranks.h), which all walk this
    WalkState* state = nullptr;  ///< begin there, and leave the sums there; null: an interruption throws
    std::string file;            ///< where the state comes from, for messages; may be empty
    std::function<void(const WalkState&)> save;  ///< called every minute or so with what there is; may be empty
};

}  // namespace searchlight
