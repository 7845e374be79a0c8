// Walks through layers whose phase functions are tables.
#include "transport/slab/slab_job.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/slab/slab_walk_tables.cpp"
#include <hwy/foreach_target.h>

#include "transport/slab/slab_walker-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

std::uint64_t tables(const SlabJob& job, SplitMix64 seeds) {
    return (job.depths == nullptr ? walkAs<Phase::any, Knows::place> : walkAs<Phase::any, Knows::depth>)(job, seeds);
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(tables);

std::uint64_t walkSlabTables(const SlabJob& job, SplitMix64 seeds) { return HWY_DYNAMIC_DISPATCH(tables)(job, seeds); }

}  // namespace searchlight
#endif
