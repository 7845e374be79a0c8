// Walks through layers that know their depth alone.
#include "transport/slab/slab_job.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/slab/slab_walk_depths.cpp"
#include <hwy/foreach_target.h>

#include "transport/slab/slab_walker-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

std::uint64_t depths(const SlabJob& job, SplitMix64 seeds) {
    const bool isotropic =
        std::ranges::all_of(job.walk.layers, [](const SlabWalk::Layer& layer) { return layer.g == 0; });
    return (isotropic ? walkAs<Phase::isotropic, Knows::depth> : walkAs<Phase::henyey_greenstein, Knows::depth>)(job,
                                                                                                                 seeds);
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(depths);

std::uint64_t walkSlabDepths(const SlabJob& job, SplitMix64 seeds) { return HWY_DYNAMIC_DISPATCH(depths)(job, seeds); }

}  // namespace searchlight
#endif
