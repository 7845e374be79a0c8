// What walks share that tally expected escapes and carry weights. Included once per instruction set.
#if defined(SEARCHLIGHT_TRANSPORT_LANE_FORESEE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_LANE_FORESEE_INL_H_
#undef SEARCHLIGHT_TRANSPORT_LANE_FORESEE_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_LANE_FORESEE_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/random.h"
#include "transport/walk/lane_bins.h"
#include "transport/walk/lane_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

// The histogram is kept once for each lane of the widest vectors and each deposit of a collision: no addition meets
// another one on its way. Those of four packs are shared.
constexpr std::size_t kCopies = 16;
// Floats hold no more than so many additions a pack; of more bins each is met less often.
constexpr std::size_t kFlushSteps = 256;
// Without absorption a walk has no mean length: beyond so many collisions its importance falls as their inverse.
constexpr std::int32_t kFadingWalk = 1 << 13;
constexpr float kSplit = 2.0f;
constexpr float kMostParts = 16;
static_assert(kSplit >= 2, "a split makes at least two parts");

/// exp(-x) for x in [-87, 87], relative error 2e-7; constant beyond.
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

/// [HenyeyGreenstein1941], relative to isotropic scattering.
HWY_INLINE FloatV henyeyGreensteinGain(FloatV g, FloatV cosine) {
    const FloatV one = hn::Set(Float(), 1.0f), g2 = hn::Mul(g, g);
    const FloatV q = hn::NegMulAdd(hn::Add(g, g), cosine, hn::Add(one, g2));
    return hn::Div(hn::Sub(one, g2), hn::Mul(q, hn::Sqrt(q)));
}

/// Adds weights to slots of kCopies histograms that lie `stride` apart, each lane of the pack from `at` to its own.
HWY_INLINE void addToCopies(float* histogram, std::size_t stride, std::size_t at, IntV slot, FloatV weight) {
    const Float d;
    const Int di;
    const IntV copy = hn::Iota(di, static_cast<int>(at % kCopies));
    const IntV index = hn::Add(slot, hn::Mul(copy, hn::Set(di, static_cast<int>(stride))));
    hn::ScatterIndex(hn::Add(hn::GatherIndex(d, histogram, index), weight), d, histogram, index);
}

/// Takes what all copies hold, `stride` apart, to `to`: `count` slots.
inline void emptyCopies(std::vector<float>& histogram, std::size_t stride, double* to, std::size_t count) {
    for (std::size_t copy = 0; copy < histogram.size(); copy += stride)
        for (std::size_t i = 0; i < count; ++i) {
            to[i] += static_cast<double>(histogram[copy + i]);
            histogram[copy + i] = 0;
        }
}

/// Adds weights to slots of kCopies sums each that lie together, each lane of the pack from `at` to its own.
HWY_INLINE void addToLanes(float* sums, std::size_t at, IntV slot, FloatV weight) {
    const Float d;
    const Int di;
    const IntV copy = hn::Iota(di, static_cast<int>(at % kCopies));
    const IntV index = hn::Add(hn::Mul(slot, hn::Set(di, static_cast<int>(kCopies))), copy);
    hn::ScatterIndex(hn::Add(hn::GatherIndex(d, sums, index), weight), d, sums, index);
}

/// Takes what addToLanes() has added to `to`, slot by slot.
inline void emptyLanes(std::vector<float>& sums, std::vector<double>& to) {
    for (std::size_t i = 0; i < sums.size(); ++i) {
        to[i / kCopies] += static_cast<double>(sums[i]);
        sums[i] = 0;
    }
}

/// Which cell of a table with 2^mantissa_bits cells for each octave of `square`, from `offset` on; `last` beyond.
template <int mantissa_bits>
HWY_INLINE IntV logarithmicCell(FloatV square, FloatV offset, int last) {
    const Int di;
    const IntV bits = hn::Sub(hn::BitCast(di, square), hn::BitCast(di, offset));
    return hn::Min(hn::ShiftRight<23 - mantissa_bits>(bits), hn::Set(di, last));
}

/// The importance of walks after so many collisions.
HWY_INLINE FloatV faded(FloatV importance, IntV order) {
    const Float d;
    const Int di;
    const hn::Mask<Int> is_long = hn::Gt(order, hn::Set(di, kFadingWalk));
    if (HWY_LIKELY(hn::AllFalse(di, is_long))) return importance;
    const FloatV fade = hn::Div(hn::Set(d, static_cast<float>(kFadingWalk)), hn::ConvertTo(d, order));
    return hn::IfThenElse(hn::RebindMask(d, is_long), hn::Mul(importance, fade), importance);
}

/// The two-dimensional sequence of [Roberts2018] from a random start: each point is random by itself, all together are
/// spread evenly.
class EvenSequence {
public:
    explicit EvenSequence(SplitMix64& random) {
        for (std::uint32_t& next : next_) next = static_cast<std::uint32_t>(random.next() >> 32);
    }

    /// One step of every lane along a dimension: the inverse plastic number and its square.
    HWY_INLINE IntV draw(std::size_t dimension) {
        constexpr std::uint32_t steps[] = {3242174889u, 2447445415u};
        const Int di;
        const auto step = static_cast<std::int32_t>(steps[dimension]);
        const IntV bits = hn::Add(hn::Mul(hn::Iota(di, 0), hn::Set(di, step)),
                                  hn::Set(di, static_cast<std::int32_t>(next_[dimension])));
        next_[dimension] += static_cast<std::uint32_t>(hn::Lanes(di)) * steps[dimension];
        return bits;
    }

private:
    std::uint32_t next_[2];
};

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
