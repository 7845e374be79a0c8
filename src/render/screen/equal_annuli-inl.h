// Lanes draw radii from equalAnnuli. Included once per instruction set.
#if defined(SEARCHLIGHT_RENDER_EQUAL_ANNULI_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_RENDER_EQUAL_ANNULI_INL_H_
#undef SEARCHLIGHT_RENDER_EQUAL_ANNULI_INL_H_
#else
#define SEARCHLIGHT_RENDER_EQUAL_ANNULI_INL_H_
#endif

#include <cstdint>
#include <vector>

#include "transport/walk/lane_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

/// The radius, mm, below which a part `u` in [0, 1) of the density lies; uniform by area within an annulus.
HWY_INLINE FloatV radiusIn(const std::vector<float>& annuli, FloatV u) {
    const Float d;
    const Int di;
    const auto parts = static_cast<std::int32_t>(annuli.size() / 2);
    const FloatV scaled = hn::Mul(u, hn::Set(d, static_cast<float>(parts)));
    const IntV part = hn::Min(hn::ConvertTo(di, scaled), hn::Set(di, parts - 1));
    const IntV at = hn::ShiftLeft<1>(part);
    const FloatV inner = hn::GatherIndex(d, annuli.data(), at);
    const FloatV width = hn::GatherIndex(d, annuli.data() + 1, at);
    return hn::Sqrt(hn::MulAdd(hn::Sub(scaled, hn::ConvertTo(d, part)), width, inner));
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
