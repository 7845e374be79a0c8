// What walks through layers have in their lanes beside themselves. Included once per instruction set.
#if defined(SEARCHLIGHT_TRANSPORT_SLAB_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_SLAB_LANES_INL_H_
#undef SEARCHLIGHT_TRANSPORT_SLAB_LANES_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_SLAB_LANES_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <utility>

#include "transport/slab/slab_tally.h"
#include "transport/walk/lane_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

constexpr std::size_t kEndCapacity = 1024;

// What changes at events only.
struct alignas(64) Layers {
    std::int32_t index[kLanes];
    float mfp[kLanes], thickness[kLanes];
    float g[kLanes], half_qq[kLanes];
    std::int32_t table[kLanes];       // first bin of its phase function
    std::int32_t table_bins[kLanes];  // 0: Henyey-Greenstein
    std::int32_t absorbed[kLanes];    // probability, in units of 2^-30
    std::int32_t counted[kLanes];     // the same
    std::int32_t survives[kLanes];    // so many collisions; the next one meets the roulette of long walks
    std::int32_t fate[kLanes];        // all ones: absorbed by the collision of the current step
};

struct Ends {
    // Whole vectors are stored at the end.
    float x[kEndCapacity + 16], y[kEndCapacity + 16], depth_or_cosine[kEndCapacity + 16];
    std::int32_t collisions[kEndCapacity + 16], layer[kEndCapacity + 16];
    std::size_t count = 0;

    HWY_INLINE void add(FloatM mask, FloatV px, FloatV py, FloatV value, IntV n, IntV index) {
        const Float d;
        const Int di;
        const hn::Mask<Int> mask_i = hn::RebindMask(di, mask);
        storeSet(px, mask, d, x + count);
        storeSet(py, mask, d, y + count);
        storeSet(value, mask, d, depth_or_cosine + count);
        storeSet(n, mask_i, di, collisions + count);
        storeSet(index, mask_i, di, layer + count);
        count += hn::CountTrue(d, mask);
    }
    bool full() const { return count >= kEndCapacity - 16; }
    SlabTally::Ends take() {
        const std::size_t n = std::exchange(count, 0);
        return {{x, n}, {y, n}, {depth_or_cosine, n}, {collisions, n}, {layer, n}};
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
