// What walks through layers gain of SlabControl, on float lanes. Included once per instruction set.
#if defined(SEARCHLIGHT_TRANSPORT_SLAB_CONTROL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_SLAB_CONTROL_INL_H_
#undef SEARCHLIGHT_TRANSPORT_SLAB_CONTROL_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_SLAB_CONTROL_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <vector>

#include "transport/slab/slab_control.h"
#include "transport/walk/lane_walk-inl.h"
#include "transport/walk/long_walk.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

/// A layer of SlabControl for float lanes, and what it has gained so far.
struct alignas(64) LaneControl {
    explicit LaneControl(const SlabControl::Layer& layer)
        : index(layer.index),
          kappa2(static_cast<float>(layer.kappa * layer.kappa)),
          even(layer.even.begin(), layer.even.end()),
          odd(layer.odd.begin(), layer.odd.end()) {}

    float sums[SlabControl::kSums][kLanes] = {};
    std::int32_t index;
    float kappa2;
    std::vector<float> even, odd;
};

/// What a control gains where walks reach an interface from its layer (kFrom: they pass, or are reflected), or have
/// passed into it.
template <bool kFrom>
HWY_INLINE void gain(LaneControl& control, FloatM where, FloatM up, FloatM passes, FloatV w, FloatV weight,
                     std::size_t at) {
    const Float d;
    if (hn::AllFalse(d, where)) return;
    const FloatV one = hn::Set(d, 1.0f), w2 = hn::Mul(w, w), kw2 = hn::Mul(w2, hn::Set(d, control.kappa2));
    FloatV even = hn::Zero(d), odd = even;
    for (std::size_t i = control.even.size(); i-- > 0;) {
        even = hn::MulAdd(even, w2, hn::Set(d, control.even[i]));
        odd = hn::MulAdd(odd, w2, hn::Set(d, control.odd[i]));
    }
    const FloatV per = hn::IfThenElseZero(where, hn::Div(weight, hn::Sub(one, kw2)));
    FloatV even_gain = hn::Mul(per, hn::MulAdd(kw2, odd, even)),
           odd_gain = hn::Mul(hn::Mul(per, w), hn::Add(even, odd));
    if constexpr (kFrom) {
        even_gain = hn::IfThenElseZero(passes, hn::Neg(even_gain));
        odd_gain = hn::IfThenElse(passes, odd_gain, hn::Add(odd_gain, odd_gain));
    }
    const FloatM top = kFrom ? up : hn::Not(up);
    const auto add = [&](std::size_t sum, FloatV value) HWY_ATTR {
        float* const lanes = control.sums[sum] + at;
        hn::Store(hn::Add(hn::Load(d, lanes), value), d, lanes);
    };
    add(0, hn::IfThenElseZero(top, even_gain));
    add(1, hn::IfThenElseZero(top, odd_gain));
    add(2, hn::IfThenZeroElse(top, even_gain));
    add(3, hn::IfThenZeroElse(top, odd_gain));
}

/// As longWalkWeight().
HWY_INLINE FloatV weightOf(IntV collisions) {
    const Float d;
    const Int di;
    const FloatV one = hn::Set(d, 1.0f);
    if (HWY_LIKELY(hn::AllFalse(di, hn::Gt(collisions, hn::Set(di, kLongWalk))))) return one;
    HWY_ALIGN std::int32_t count[16];
    HWY_ALIGN float weight[16];
    hn::Store(collisions, di, count);
    for (std::size_t i = 0; i < hn::Lanes(d); ++i)
        weight[i] = count[i] == kNever ? 1.0f : static_cast<float>(longWalkWeight(count[i]));
    return hn::Load(d, weight);
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
