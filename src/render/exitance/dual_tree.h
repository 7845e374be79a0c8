// The traversal of both trees: who is summed with whom, and how.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/exitance/point_tree.h"
#include "render/exitance/radial_table.h"
#include "render/exitance/receiver_tree.h"

namespace searchlight {

/// What the traversal does below a receiver node.
enum class Visit : std::uint8_t {
    skip,
    descend,
    guess,  ///< stops here: what is left counts as if all flux of a node stood at its centre
};

struct DualTreeProblem {
    const PointTree::Impl& points;
    const RadialTable::Impl& table;
    const ReceiverTree::Impl& receivers;
    const Opening& opening;
    std::span<const Visit> visits;       ///< per receiver node; empty: descend everywhere
    const Observer* observer = nullptr;  ///< asked before each task
};

struct DualTreeResult {
    /// Per receiver, in the order of the tree, times 1 / PointTree::Impl::unit; untouched where not visited.
    std::array<std::vector<float>, 3> exitance;
    std::vector<std::array<float, 3>> guesses;  ///< per node where any visit is a guess, otherwise empty
    std::uint64_t interactions = 0, expansions = 0;
};

/// Fills `result`, whose lists are used again. Does not depend on `threads`. Throws interruptedError() when cancelled.
void traverse(const DualTreeProblem& problem, int threads, DualTreeResult& result);

/// "AVX3", "AVX2", ...: what the traversal uses here.
const char* dualTreeInstructionSet();

}  // namespace searchlight
