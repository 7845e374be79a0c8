// What float lanes know of SlabDepths. Included once per instruction set.
#if defined(SEARCHLIGHT_TRANSPORT_SLAB_DEPTHS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_SLAB_DEPTHS_INL_H_
#undef SEARCHLIGHT_TRANSPORT_SLAB_DEPTHS_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_SLAB_DEPTHS_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <vector>

#include "transport/slab/slab_depths.h"
#include "transport/walk/lane_foresee-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

/// Counts collisions by layer and depth.
class LaneDepths {
public:
    explicit LaneDepths(const SlabDepths& depths)
        : weights(depths.slots.size()), per_mm_(depths.per_mm), sums_(depths.slots.size() * kCopies) {
        for (const SlabDepths::Layer& layer : depths.layers) {
            top_.push_back(layer.top);
            first_.push_back(layer.first);
            last_.push_back(layer.last);
            slot_.push_back(layer.slot);
        }
    }

    /// z: from the top of the layer, mm.
    HWY_INLINE IntV slotAt(FloatV z, IntV layer) const {
        const Float d;
        const Int di;
        const FloatV place = hn::MulAdd(z, hn::Set(d, per_mm_), of(d, top_, layer));
        // Of floats, so that the conversion stays defined.
        const FloatV bin = hn::Min(hn::Max(place, of(d, first_, layer)), of(d, last_, layer));
        return hn::Add(hn::ConvertTo(di, bin), of(di, slot_, layer));
    }

    /// Adds weights of the pack from lane `at`, where they count.
    HWY_INLINE void add(std::size_t at, IntV slot, FloatM counts, FloatV weight) {
        addToLanes(sums_.data(), at, hn::IfThenElseZero(hn::RebindMask(Int(), counts), slot),
                   hn::IfThenElseZero(counts, weight));
    }

    /// Takes what was added to `weights`: floats count to 2^24.
    void flush() { emptyLanes(sums_, weights); }

    std::vector<double> weights;  ///< per slot

private:
    template <class D, class T>
    static HWY_INLINE hn::Vec<D> of(D d, const std::vector<T>& list, IntV layer) {
        if (list.size() == 1) return hn::Set(d, list[0]);
        return hn::GatherIndex(d, list.data(), layer);
    }

    float per_mm_;
    std::vector<float> top_, first_, last_;  // per layer
    std::vector<std::int32_t> slot_;
    std::vector<float> sums_;  // per slot: kCopies
};

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
