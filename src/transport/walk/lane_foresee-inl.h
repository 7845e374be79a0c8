// What walks share that tally expected escapes and carry weights. Included once per instruction set.
#if defined(SEARCHLIGHT_TRANSPORT_LANE_FORESEE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_LANE_FORESEE_INL_H_
#undef SEARCHLIGHT_TRANSPORT_LANE_FORESEE_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_LANE_FORESEE_INL_H_
#endif

#include <cstdint>
#include <cstring>

#include "transport/walk/lane_bins.h"
#include "transport/walk/lane_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

/// exp(-x) for x in [0, 87], relative error 2e-7; constant beyond.
HWY_INLINE FloatV expNegative(FloatV x) {
    const Float d;
    const FloatV y = hn::Neg(hn::Min(x, hn::Set(d, 87.0f)));
    const FloatV k = hn::Round(hn::Mul(y, hn::Set(d, 1.44269504f)));
    FloatV f = hn::NegMulAdd(k, hn::Set(d, 0.693359375f), y);  // log 2 in two parts
    f = hn::NegMulAdd(k, hn::Set(d, -2.12194440e-4f), f);
    // Taylor: |f| < 0.347 leaves 1.2e-7.
    FloatV p = hn::Set(d, 1 / 720.0f);
    p = hn::MulAdd(p, f, hn::Set(d, 1 / 120.0f));
    p = hn::MulAdd(p, f, hn::Set(d, 1 / 24.0f));
    p = hn::MulAdd(p, f, hn::Set(d, 1 / 6.0f));
    p = hn::MulAdd(p, f, hn::Set(d, 0.5f));
    p = hn::MulAdd(p, f, hn::Set(d, 1.0f));
    p = hn::MulAdd(p, f, hn::Set(d, 1.0f));
    const IntV exponent = hn::ShiftLeft<23>(hn::ConvertTo(Int(), k));
    return hn::BitCast(d, hn::Add(hn::BitCast(Int(), p), exponent));
}

/// (0, 1), finer towards 0, so that rare survivals keep their probability.
HWY_INLINE FloatV fineUniform(IntV bits) {
    const Float d;
    const IntV k = hn::And(bits, hn::Set(Int(), 0x7FFFFFFF));
    return hn::MulAdd(hn::ConvertTo(d, k), hn::Set(d, 0x1p-31f), hn::Set(d, 0x1p-32f));
}

/// A mask of the lanes from `at` as bits of the whole, and back.
HWY_INLINE std::uint64_t bitsOf(FloatM mask, std::size_t at) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Float(), mask, bytes);
    std::uint64_t bits = 0;
    std::memcpy(&bits, bytes, sizeof bits);
    return (bits & ((std::uint64_t{1} << hn::Lanes(Float())) - 1)) << at;
}

HWY_INLINE FloatM maskOf(std::uint64_t bits, std::size_t at) {
    bits >>= at;
    std::uint8_t bytes[8];
    std::memcpy(bytes, &bits, sizeof bits);
    return hn::LoadMaskBits(Float(), bytes);
}

/// The slot of a squared radius.
HWY_INLINE IntV slotOf(const LaneBins& bins, FloatV r2) {
    const Float d;
    const Int di;
    if (bins.per_length > 0) {
        const FloatV place = hn::Mul(hn::Sqrt(r2), hn::Set(d, bins.per_length));
        const FloatV most = hn::Set(d, static_cast<float>(bins.next_edge.size() - 2));
        return hn::Add(hn::ConvertTo(di, hn::Min(place, most)), hn::Set(di, 1));
    }
    const IntV last = hn::Set(di, static_cast<int>(bins.first_slot.size()) - 1);
    const IntV cell = hn::Sub(hn::ShiftRightSame(hn::BitCast(di, r2), bins.shift), hn::Set(di, bins.first_cell));
    IntV slot = hn::GatherIndex(di, bins.first_slot.data(), hn::Min(hn::Max(cell, hn::Zero(di)), last));
    for (int i = 0; i < bins.steps; ++i) {
        const FloatM above = hn::Ge(r2, hn::GatherIndex(d, bins.next_edge.data(), slot));
        slot = hn::Sub(slot, hn::VecFromMask(di, hn::RebindMask(di, above)));
    }
    return slot;
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
