// Walks on float lanes: what they share beside their physics. Included once per instruction set.
#if defined(SEARCHLIGHT_TRANSPORT_LANE_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_LANE_WALK_INL_H_
#undef SEARCHLIGHT_TRANSPORT_LANE_WALK_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_LANE_WALK_INL_H_
#endif

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/random.h"
#include "transport/walk/lane_scatter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

// Packs of lanes are independent: while one waits for its logarithm, the processor works on the next.
constexpr std::size_t kLanes = 64;
constexpr std::size_t kPackLanes = 4;  // the fewest that a target has
constexpr std::int32_t kNever = std::numeric_limits<std::int32_t>::max();

struct alignas(64) Lanes {
    float x[kLanes], y[kLanes], z[kLanes];  // z grows into the medium
    float u[kLanes], v[kLanes], w[kLanes];  // direction
    std::int32_t collisions[kLanes];        // so far
    std::uint64_t s0[kLanes / 2], s1[kLanes / 2];
};

// One vector of walks in registers.
struct Pack {
    FloatV x, y, z;
    Direction direction;
    IntV collisions;
    Generator random;
};

HWY_INLINE Pack load(const Lanes& lanes, std::size_t at) {
    const Float d;
    const Word dw;
    return {hn::Load(d, lanes.x + at),
            hn::Load(d, lanes.y + at),
            hn::Load(d, lanes.z + at),
            {hn::Load(d, lanes.u + at), hn::Load(d, lanes.v + at), hn::Load(d, lanes.w + at)},
            hn::Load(Int(), lanes.collisions + at),
            {hn::Load(dw, lanes.s0 + at / 2), hn::Load(dw, lanes.s1 + at / 2)}};
}

HWY_INLINE void store(const Pack& pack, Lanes& lanes, std::size_t at) {
    const Float d;
    const Word dw;
    hn::Store(pack.x, d, lanes.x + at);
    hn::Store(pack.y, d, lanes.y + at);
    hn::Store(pack.z, d, lanes.z + at);
    hn::Store(pack.direction.u, d, lanes.u + at);
    hn::Store(pack.direction.v, d, lanes.v + at);
    hn::Store(pack.direction.w, d, lanes.w + at);
    hn::Store(pack.collisions, Int(), lanes.collisions + at);
    hn::Store(pack.random.s0, dw, lanes.s0 + at / 2);
    hn::Store(pack.random.s1, dw, lanes.s1 + at / 2);
}

/// Seeds the generators of any lanes that have them.
template <class AnyLanes>
void seed(AnyLanes& lanes, SplitMix64& seeds) {
    for (std::size_t i = 0; i < kLanes / 2; ++i) {
        lanes.s0[i] = seeds.next();
        lanes.s1[i] = seeds.next();
    }
}

HWY_INLINE void storeWhere(hn::Mask<Int> mask, IntV value, std::int32_t* lanes) {
    const Int di;
    hn::Store(hn::IfThenElse(mask, value, hn::Load(di, lanes)), di, lanes);
}

/// On to the next collision.
HWY_INLINE void fly(Pack& pack, FloatV length) {
    pack.x = hn::MulAdd(length, pack.direction.u, pack.x);
    pack.y = hn::MulAdd(length, pack.direction.v, pack.y);
    pack.z = hn::MulAdd(length, pack.direction.w, pack.z);
    pack.collisions = hn::Add(pack.collisions, hn::Set(Int(), 1));
}

/// A new direction; isotropic walks need no g and half_qq (lane_scatter-inl.h).
template <bool kIsotropic>
HWY_INLINE void scatter(Pack& pack, FloatV g, FloatV half_qq) {
    const FloatV s = signedUniform(pack.random.next());
    const Azimuth phi = azimuth(pack.random.next());
    if constexpr (kIsotropic)
        pack.direction = isotropicDirection(s, phi);
    else
        pack.direction = henyeyGreenstein(pack.direction, g, half_qq, s, phi);
}

/// Moves the free lanes to the entry point of the beam.
HWY_INLINE void moveToEntry(Pack& pack, FloatM free, double sin_beam, double cos_beam) {
    const Float d;
    pack.x = hn::IfThenZeroElse(free, pack.x);
    pack.y = hn::IfThenZeroElse(free, pack.y);
    pack.z = hn::IfThenZeroElse(free, pack.z);
    pack.direction.u = hn::IfThenElse(free, hn::Set(d, static_cast<float>(sin_beam)), pack.direction.u);
    pack.direction.v = hn::IfThenZeroElse(free, pack.direction.v);
    pack.direction.w = hn::IfThenElse(free, hn::Set(d, static_cast<float>(cos_beam)), pack.direction.w);
    pack.collisions = hn::IfThenZeroElse(hn::RebindMask(Int(), free), pack.collisions);
}

/// Calls visit(lane, how many set lanes came before) for the set lanes in order.
template <class Visit>
void forEachLane(FloatM mask, const Visit& visit) {
    const Float d;
    HWY_ALIGN float flags[16];
    hn::Store(hn::IfThenElseZero(mask, hn::Set(d, 1.0f)), d, flags);
    for (std::size_t lane = 0, i = 0; lane < hn::Lanes(d); ++lane)
        if (flags[lane] != 0) visit(lane, i++);
}

/// The first `count` lanes that are set.
HWY_NOINLINE inline FloatM firstOf(FloatM mask, std::size_t count) {
    const Float d;
    HWY_ALIGN float flags[16] = {};
    forEachLane(mask, [&](std::size_t lane, std::size_t i) { flags[lane] = i < count ? 1.0f : 0.0f; });
    return hn::Ne(hn::Load(d, flags), hn::Zero(d));
}

struct Started {
    FloatM lanes;
    std::size_t count;
};

/// Gives the free lanes to waiting walks, in lane order; lanes may remain.
HWY_INLINE Started takeWaiting(FloatM free, std::uint64_t& waiting) {
    Started started{free, hn::CountTrue(Float(), free)};
    if (started.count > waiting) {
        started.count = static_cast<std::size_t>(waiting);
        started.lanes = firstOf(free, started.count);
    }
    waiting -= started.count;
    return started;
}

/// Lanes of the medium below which nothing is: walks there fall and never return.
HWY_INLINE void park(Pack& pack, FloatM parked) {
    const Float d;
    pack.z = hn::IfThenElse(parked, hn::Set(d, 1e30f), pack.z);
}

/// Collisions survived by a walk that survives n of them with probability exp(-n / scale).
HWY_INLINE IntV collisionsSurvived(IntV bits, FloatV scale) {
    const Float d;
    // The largest float below 2^31 keeps the conversion defined.
    return hn::ConvertTo(Int(), hn::Min(hn::Mul(exponential(bits), scale), hn::Set(d, 0x1.fffffep30f)));
}

/// Stores the lanes that are set, without gaps; up to a vector of what follows them is undefined. For AVX2, Highway 1.0
/// has a table that GCC 12 copies to the stack at every call, which halves the speed of a walk.
template <class D>
HWY_INLINE void storeSet(hn::Vec<D> v, hn::Mask<D> mask, D d, hn::TFromD<D>* to) {
#if HWY_TARGET == HWY_AVX2
    HWY_ALIGN hn::TFromD<D> lanes[8];
    std::uint8_t bits[8] = {};
    hn::Store(v, d, lanes);
    hn::StoreMaskBits(d, mask, bits);
    for (unsigned set = bits[0]; set != 0; set &= set - 1) *to++ = lanes[std::countr_zero(set)];
#else
    hn::StoreU(hn::Compress(v, mask), d, to);
#endif
}

/// Runs a walker until no lane walks; returns the number of steps. Of the pack that begins at a lane, start() puts new
/// walks into free lanes and returns their number, advance() makes the step between `from` and `to` and says whether
/// something happens to a walk on its way, settle() then does what happens and returns the number of lanes that found
/// no further walk.
template <class Walker, class AnyLanes>
HWY_INLINE std::uint64_t walkAll(Walker& walker, AnyLanes*& from, AnyLanes*& to) {
    const Float d;
    const std::size_t width = hn::Lanes(d);
    std::size_t active[kLanes] = {};
    std::uint64_t alive = 0, steps = 0;
    for (std::size_t at = 0; at < kLanes; at += width) {
        auto pack = load(*from, at);
        active[at] = walker.start(pack, hn::FirstN(d, width), at);
        alive += active[at];
        store(pack, *from, at);
    }
    while (alive > 0) {
        // Two passes: a branch on the outcome of a step would cost its whole latency when mispredicted, unless the
        // steps of the other packs are under way by then.
        std::uint64_t events = 0;
        for (std::size_t at = 0; at < kLanes; at += width)
            if (active[at] > 0) events |= static_cast<std::uint64_t>(walker.advance(at)) << (at / kPackLanes);
        steps += alive;
        for (; events != 0; events &= events - 1) {
            const auto at = static_cast<std::size_t>(std::countr_zero(events)) * kPackLanes;
            const std::size_t parked = walker.settle(at);
            active[at] -= parked;
            alive -= parked;
        }
        std::swap(from, to);
    }
    return steps;
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
