#include "transport/slab/slab_walk.h"

#include <cstddef>

#include "transport/slab/slab_job.h"

namespace searchlight {

namespace {

std::uint64_t walkJob(const SlabJob& job, SplitMix64 seeds) {
    if (!job.walk.tables.stay.empty()) return walkSlabTables(job, seeds);
    return (job.depths == nullptr ? walkSlabPlaces : walkSlabDepths)(job, seeds);
}

}  // namespace

std::uint64_t walkSlabChunk(const SlabWalk& walk, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                            SlabTally& tally) {
    return walkJob({walk, walks, tally}, streamOf(seed, chunk));
}

std::uint64_t walkSlabChunk(const SlabWalk& walk, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                            SlabTally& tally, const SlabControl& control, std::span<double> sums) {
    return walkJob({walk, walks, tally, &control, sums}, streamOf(seed, chunk));
}

std::uint64_t walkSlabDepthsChunk(const SlabWalk& walk, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                                  SlabTally& tally, const SlabControl& control, std::span<double> sums,
                                  const SlabDepths& depths, std::uint64_t* crossings) {
    return walkJob({walk, walks, tally, &control, sums, &depths, crossings}, streamOf(seed, chunk));
}

}  // namespace searchlight
