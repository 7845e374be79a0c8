// The walk inside a closed body, per instruction set: the inner loop behind reference_body.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "transport/mesh/closed_body.h"
#include "transport/mesh/entry.h"

namespace searchlight {

/// One channel's medium, in mm.
struct BodyMedium {
    double sigma_t = 1;   ///< 1/mm
    double absorbed = 0;  ///< 1 - albedo
    double g = 0;
    double eta = 1;
    std::int32_t ways = 0;  ///< through each ball of the large steps of a chunk, a power of two; 0: no large steps
};

/// How many ways are worth walking for a chunk of so many walks.
std::int32_t waysFor(std::uint64_t walks);

/// What the walks of one chunk did; flux in multiples of EntryOptions::whole.
struct BodyChunk {
    EntryTotals entry;
    std::uint64_t candidates = 0;
    std::uint64_t collisions = 0;
    std::uint64_t flights = 0;     ///< to a collision or to the surface
    std::uint64_t rays = 0;        ///< flights that were tested against the surface
    std::uint64_t taken_back = 0;  ///< times that a walk that rounding led out was put back inside
    std::uint64_t lost = 0;        ///< walks that were given up as they were led out again and again
    double left = 0, absorbed = 0;
    Vec3 exits;  ///< positions where walks left, times weight
    std::vector<CellExit> cells;

    /// All of it as one list, and back.
    std::vector<double> pack() const;
    void unpack(std::span<const double> values);
};

/// Walks every walk of the source to its end; `entry` and `candidates` are the caller's to fill. Depends on its
/// arguments alone.
BodyChunk walkBodyChunk(const Ball& ball, const BodyMedium& medium, WalkSource& source, SplitMix64 seeds);
BodyChunk walkBodyChunk(const MeshBody& mesh, const BodyMedium& medium, WalkSource& source, SplitMix64 seeds);

}  // namespace searchlight
