// The walks of slab_best.cpp in their lanes. Included once per instruction set.
#if defined(SEARCHLIGHT_TRANSPORT_SLAB_BEST_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_SLAB_BEST_LANES_INL_H_
#undef SEARCHLIGHT_TRANSPORT_SLAB_BEST_LANES_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_SLAB_BEST_LANES_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "transport/walk/lane_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

// Where a walk stands.
enum Flight : std::int32_t {
    collides,   // at a collision
    foreseen,   // at an interface; if it leaves as it flies, that was counted
    uncounted,  // at an interface; if it leaves, that is to be counted
};

enum Side { up, down, sides };

struct alignas(64) SlabBestLanes {
    float x[kLanes], y[kLanes], z[kLanes];  // z from the top of the layer
    float u[kLanes], v[kLanes], w[kLanes];
    float weight[kLanes];
    float value[kLanes];  // weight times importance
    std::int32_t order[kLanes], layer[kLanes], flight[kLanes];
    std::uint64_t s0[kLanes / 2], s1[kLanes / 2];
};

struct SlabBestPack {
    FloatV x, y, z;
    Direction direction;
    FloatV weight;
    IntV order, layer, flight;
    Generator random;
};

// Part of a split walk that waits for a lane.
struct SlabWaiting {
    float x, y, z, u, v, w, weight;
    std::int32_t order, layer, flight, parts;
};

HWY_INLINE SlabBestPack load(const SlabBestLanes& lanes, std::size_t at) {
    const Float d;
    const Int di;
    const Word dw;
    return {hn::Load(d, lanes.x + at),
            hn::Load(d, lanes.y + at),
            hn::Load(d, lanes.z + at),
            {hn::Load(d, lanes.u + at), hn::Load(d, lanes.v + at), hn::Load(d, lanes.w + at)},
            hn::Load(d, lanes.weight + at),
            hn::Load(di, lanes.order + at),
            hn::Load(di, lanes.layer + at),
            hn::Load(di, lanes.flight + at),
            {hn::Load(dw, lanes.s0 + at / 2), hn::Load(dw, lanes.s1 + at / 2)}};
}

HWY_INLINE void store(const SlabBestPack& pack, SlabBestLanes& lanes, std::size_t at) {
    const Float d;
    const Int di;
    const Word dw;
    hn::Store(pack.x, d, lanes.x + at);
    hn::Store(pack.y, d, lanes.y + at);
    hn::Store(pack.z, d, lanes.z + at);
    hn::Store(pack.direction.u, d, lanes.u + at);
    hn::Store(pack.direction.v, d, lanes.v + at);
    hn::Store(pack.direction.w, d, lanes.w + at);
    hn::Store(pack.weight, d, lanes.weight + at);
    hn::Store(pack.order, di, lanes.order + at);
    hn::Store(pack.layer, di, lanes.layer + at);
    hn::Store(pack.flight, di, lanes.flight + at);
    hn::Store(pack.random.s0, dw, lanes.s0 + at / 2);
    hn::Store(pack.random.s1, dw, lanes.s1 + at / 2);
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
