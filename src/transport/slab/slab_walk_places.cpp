// Walks through layers that know their place on the surfaces.
#include "transport/slab/slab_job.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/slab/slab_walk_places.cpp"
#include <hwy/foreach_target.h>

#include "transport/slab/slab_walker-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

std::uint64_t places(const SlabJob& job, SplitMix64 seeds) {
    const bool isotropic =
        std::ranges::all_of(job.walk.layers, [](const SlabWalk::Layer& layer) { return layer.g == 0; });
    return (isotropic ? walkAs<Phase::isotropic, Knows::place> : walkAs<Phase::henyey_greenstein, Knows::place>)(job,
                                                                                                                 seeds);
}

const char* slabTarget() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(places);
HWY_EXPORT(slabTarget);

std::uint64_t walkSlabPlaces(const SlabJob& job, SplitMix64 seeds) { return HWY_DYNAMIC_DISPATCH(places)(job, seeds); }

const char* slabInstructionSet() { return HWY_DYNAMIC_DISPATCH(slabTarget)(); }

}  // namespace searchlight
#endif
