// Lists of some of the lanes of vectors, without gaps. Included once per instruction set.
#include <array>
#include <cstdint>

#ifndef SEARCHLIGHT_TRANSPORT_LANE_LIST_ORDERS_
#define SEARCHLIGHT_TRANSPORT_LANE_LIST_ORDERS_
namespace searchlight {

/// For each set of eight lanes: which lane comes first, which next. Highway 1.0 has such a table too, which GCC 12
/// copies to the stack at every call.
struct alignas(8) LaneOrder {
    std::uint8_t lanes[8] = {};
};
inline constexpr auto kLaneOrders = [] {
    std::array<LaneOrder, 256> orders;
    for (unsigned set = 0; set < 256; ++set) {
        std::size_t count = 0;
        for (unsigned lane = 0; lane < 8; ++lane)
            if ((set >> lane & 1) != 0) orders[set].lanes[count++] = static_cast<std::uint8_t>(lane);
    }
    return orders;
}();

}  // namespace searchlight
#endif

#if defined(SEARCHLIGHT_TRANSPORT_LANE_LIST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_LANE_LIST_INL_H_
#undef SEARCHLIGHT_TRANSPORT_LANE_LIST_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_LANE_LIST_INL_H_
#endif

#include "transport/walk/lane_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

HWY_INLINE std::uint64_t bitsOf(FloatM mask) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(Float(), mask, bits);
    return bits[0] | static_cast<std::uint64_t>(bits[1]) << 8;
}

/// Appends the lanes that are set to lists.
class Listing {
public:
    HWY_INLINE explicit Listing(FloatM mask) : mask_(mask), count_(hn::CountTrue(Float(), mask)) {
#if HWY_TARGET == HWY_AVX2
        const hn::Rebind<std::uint8_t, Float> bytes;
        order_ = hn::PromoteTo(Int(), hn::Load(bytes, kLaneOrders[bitsOf(mask)].lanes));
#endif
    }
    std::size_t count() const { return count_; }

    /// Writes a whole vector, whatever is in it behind the lanes that are set.
    HWY_INLINE void append(FloatV v, float* to) const {
        const Float d;
#if HWY_TARGET == HWY_AVX2
        hn::StoreU(hn::TableLookupLanes(v, hn::IndicesFromVec(d, order_)), d, to);
#else
        hn::StoreU(hn::Compress(v, mask_), d, to);
#endif
    }
    HWY_INLINE void append(IntV v, std::int32_t* to) const {
        append(hn::BitCast(Float(), v), reinterpret_cast<float*>(to));
    }

private:
    FloatM mask_;
    std::size_t count_;
#if HWY_TARGET == HWY_AVX2
    IntV order_;
#endif
};

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
