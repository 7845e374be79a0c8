// Walks inside a closed body in groups of lanes. Included once per instruction set.
#if defined(SEARCHLIGHT_TRANSPORT_LANE_GROUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_LANE_GROUP_INL_H_
#undef SEARCHLIGHT_TRANSPORT_LANE_GROUP_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_LANE_GROUP_INL_H_
#endif

#include <bit>

#include "base/vec.h"
#include "transport/mesh/flights.h"
#include "transport/mesh/lane_list-inl.h"
#include "transport/mesh/lane_regions-inl.h"
#include "transport/walk/lane_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

// Groups of lanes take turns: while the memory fetches regions for one, the processor walks the others, and rays of
// all are asked together.
constexpr std::size_t kGroups = 4;

struct Group {
    struct Sure {
        Vec3f position, direction;
        std::int32_t collisions = 0;
    };

    std::uint64_t walking = 0;    // a bit per lane
    std::uint64_t uncleared = 0;  // flights that may have met the surface, and
    std::uint64_t met = 0;        // that have
    std::uint64_t ends = 0;       // absorbed
    std::uint64_t deep = 0;       // where a large step fits
    std::uint64_t collided = 0;   // at a collision after the step, and
    std::uint64_t scattered = 0;  // before it
    std::uint64_t doubtful = 0;   // flights since `sure` were tested and met nothing
    Sure sure[kLanes];            // of those lanes: the start of the last flight known to begin inside
    int taken_back[kLanes] = {};
    Lanes lanes[2] = {};
    LaneRegions regions = {};
    alignas(64) float reach[kLanes];  // mean free path; 0 in lanes without a walk
    alignas(64) std::int32_t survives[kLanes];
    float weight[kLanes];
    std::uint32_t tag[kLanes];
    std::int32_t way[kLanes];  // of the next large step
};

constexpr std::size_t kStride = sizeof(Group) / sizeof(float);
static_assert(sizeof(Group) % sizeof(float) == 0 && kGroups * kLanes <= Flights::kMost);

// Lanes of all groups, group after group, by their place after those of the first, in floats.
HWY_INLINE IntV placesOf(IntV lanes) {
    const Int di;
    const IntV group = hn::ShiftRight<6>(lanes);
    return hn::Add(hn::Mul(group, hn::Set(di, static_cast<std::int32_t>(kStride - kLanes))), lanes);
}
static_assert(kLanes == 64);

// Lanes of all groups by their place after those of the first, in floats: together they fill vectors. The last one
// fills its vector.
struct LaneList {
    HWY_ALIGN std::int32_t places[kGroups * kLanes];
    std::uint16_t lanes[kGroups * kLanes];  // group and lane
    std::size_t count = 0, filled = 0;

    LaneList(const Group* groups, std::uint64_t Group::*set) {
        for (std::size_t group = 0; group < kGroups; ++group)
            for (std::uint64_t bits = groups[group].*set; bits != 0; bits &= bits - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
                lanes[count] = static_cast<std::uint16_t>(group * kLanes + lane);
                places[count++] = static_cast<std::int32_t>(group * (sizeof(Group) / sizeof(float)) + lane);
            }
        for (filled = count; filled % hn::Lanes(Float()) != 0; ++filled) places[filled] = places[count - 1];
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
