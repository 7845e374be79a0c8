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

double entryShift(const std::vector<SlabWalk::Surface>& surfaces, SplitMix64& random) {
    const auto below = static_cast<std::ptrdiff_t>(surfaces.size());
    for (;;) {  // until one enters: those that do not are the specular part, which is known
        double shift = 0;
        std::ptrdiff_t next = 0;  // surface ahead
        bool down = true;
        while (next >= 0 && next < below) {
            const bool reflected = random.uniform() < surfaces[static_cast<std::size_t>(next)].reflectance;
            if (reflected) down = !down;
            // Behind the surface when reflected, beyond it otherwise, lies the layer to cross.
            const std::ptrdiff_t layer = down ? next : next - 1;
            if (layer >= 0 && layer + 1 < below) shift += surfaces[static_cast<std::size_t>(layer)].shift_mm;
            next += down ? 1 : -1;
        }
        if (down) return shift;
    }
}

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
