// The walk of half_space_walk.cpp without absorption, which measures its own path. The scheme is the same: 64 lanes in
// packs that hide each other's latency, two passes so that no branch waits for a step, a new walk wherever one ended,
// exactly the walks asked for, all of them finished.
//
// The path is a float sum of n lengths of mean 1. Each addition rounds by at most half a unit in the last place, up as
// often as down: 1e5 collisions leave 1 mean free path, against weights that change over 1e4 (largest albedo .9999).
#include "transport/white_walk.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <memory>
#include <utility>

#include "transport/random.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/white_walk.cpp"
#define HWY_DISABLED_TARGETS HWY_SSSE3
#define HWY_BROKEN_EMU128 0
#include <hwy/foreach_target.h>

#include "transport/lane_scatter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

constexpr std::size_t kLanes = 64;
constexpr std::size_t kPackLanes = 4;  // the fewest that a target has
constexpr std::int32_t kNever = std::numeric_limits<std::int32_t>::max();

struct alignas(64) WhiteLanes {
    float x[kLanes], y[kLanes], z[kLanes];  // z grows into the medium
    float u[kLanes], v[kLanes], w[kLanes];  // direction
    float length[kLanes];                   // of the path so far
    std::int32_t collisions[kLanes];        // so far
    std::int32_t survives[kLanes];          // so many collisions; the next one ends the walk
    std::uint64_t s0[kLanes / 2], s1[kLanes / 2];
};

// One vector of walks in registers.
struct WhitePack {
    FloatV x, y, z, length;
    Direction direction;
    IntV collisions, survives;
    Generator random;
};

template <bool kFresnel, bool kIsotropic>
class WhiteWalker {
public:
    WhiteWalker(const WhiteWalk& walk, SplitMix64 seeds, std::uint64_t walks, WhiteExits& exits)
        : walk_(walk), waiting_(walks), exits_(exits) {
        for (std::size_t i = 0; i < kLanes / 2; ++i) {
            from_->s0[i] = seeds.next();
            from_->s1[i] = seeds.next();
        }
        const std::size_t room = static_cast<std::size_t>(walks) + 16;  // compressed stores write whole vectors
        for (auto* list : {&exits.x, &exits.y, &exits.length}) list->resize(room);
        exits.collisions.resize(room);
        exits.count = 0;
    }

    std::uint64_t run() {
        const Float d;
        const std::size_t width = hn::Lanes(d);
        std::size_t active[kLanes] = {};
        std::uint64_t alive = 0, steps = 0;
        for (std::size_t at = 0; at < kLanes; at += width) {
            WhitePack pack = load(from_, at);
            active[at] = start(pack, hn::FirstN(d, width));
            alive += active[at];
            store(pack, from_, at);
        }
        while (alive > 0) {
            std::uint64_t events = 0;
            for (std::size_t at = 0; at < kLanes; at += width)
                if (active[at] > 0) events |= static_cast<std::uint64_t>(advance(at)) << (at / kPackLanes);
            steps += alive;
            for (; events != 0; events &= events - 1) {
                const auto at = static_cast<std::size_t>(std::countr_zero(events)) * kPackLanes;
                const std::size_t parked = settle(at);
                active[at] -= parked;
                alive -= parked;
            }
            std::swap(from_, to_);
        }
        return steps - exits_.count;  // a step ends in a collision or an exit
    }

private:
    static HWY_INLINE FloatV set(double value) { return hn::Set(Float(), static_cast<float>(value)); }

    static HWY_INLINE WhitePack load(const WhiteLanes* lanes, std::size_t at) {
        const Float d;
        const Int di;
        const Word dw;
        return {hn::Load(d, lanes->x + at),
                hn::Load(d, lanes->y + at),
                hn::Load(d, lanes->z + at),
                hn::Load(d, lanes->length + at),
                {hn::Load(d, lanes->u + at), hn::Load(d, lanes->v + at), hn::Load(d, lanes->w + at)},
                hn::Load(di, lanes->collisions + at),
                hn::Load(di, lanes->survives + at),
                {hn::Load(dw, lanes->s0 + at / 2), hn::Load(dw, lanes->s1 + at / 2)}};
    }

    static HWY_INLINE void store(const WhitePack& pack, WhiteLanes* lanes, std::size_t at) {
        const Float d;
        const Int di;
        const Word dw;
        hn::Store(pack.x, d, lanes->x + at);
        hn::Store(pack.y, d, lanes->y + at);
        hn::Store(pack.z, d, lanes->z + at);
        hn::Store(pack.length, d, lanes->length + at);
        hn::Store(pack.direction.u, d, lanes->u + at);
        hn::Store(pack.direction.v, d, lanes->v + at);
        hn::Store(pack.direction.w, d, lanes->w + at);
        hn::Store(pack.collisions, di, lanes->collisions + at);
        hn::Store(pack.survives, di, lanes->survives + at);
        hn::Store(pack.random.s0, dw, lanes->s0 + at / 2);
        hn::Store(pack.random.s1, dw, lanes->s1 + at / 2);
    }

    // Walks to the next collision as if there were no surface, and scatters. True when a walk of the pack crossed the
    // surface or ended.
    HWY_INLINE bool advance(std::size_t at) {
        const Float d;
        WhitePack pack = load(from_, at);
        const FloatV step = exponential(pack.random.next());
        pack.x = hn::MulAdd(step, pack.direction.u, pack.x);
        pack.y = hn::MulAdd(step, pack.direction.v, pack.y);
        pack.z = hn::MulAdd(step, pack.direction.w, pack.z);
        pack.length = hn::Add(pack.length, step);
        pack.collisions = hn::Add(pack.collisions, hn::Set(Int(), 1));
        const FloatM crosses = hn::Lt(pack.z, hn::Zero(d));
        // Of lanes that cross the surface the mirrored direction counts.
        pack.direction.w = hn::IfThenElse(crosses, hn::Neg(pack.direction.w), pack.direction.w);
        const FloatV s = signedUniform(pack.random.next());
        const Azimuth phi = azimuth(pack.random.next());
        if constexpr (kIsotropic)
            pack.direction = isotropicDirection(s, phi);
        else
            pack.direction =
                henyeyGreenstein(pack.direction, set(walk_.g), set(0.5 * (1 - walk_.g) * (1 - walk_.g)), s, phi);
        store(pack, to_, at);
        return !hn::AllFalse(d, hn::Or(crosses, ends(pack)));
    }

    // What the surface and the roulette do to the step just made; new walks in the place of those that ended. Returns
    // the number of lanes that found none.
    HWY_INLINE std::size_t settle(std::size_t at) {
        const Float d;
        const WhitePack before = load(from_, at);
        WhitePack pack = load(to_, at);
        const FloatM crosses = hn::Lt(pack.z, hn::Zero(d));
        pack.z = hn::Abs(pack.z);  // a path reflected by a plane is the mirrored path
        FloatM leaves = crosses;
        if constexpr (kFresnel) {
            const FloatV u = uniform(pack.random.nextWhere(crosses));
            leaves = hn::And(crosses, hn::Ge(u, fresnel(hn::Neg(before.direction.w), set(walk_.eta)).reflectance));
        }
        if (!hn::AllFalse(d, leaves)) leave(before, leaves);
        const FloatM free = hn::Or(leaves, ends(pack));
        const std::size_t parked = hn::AllFalse(d, free) ? 0 : hn::CountTrue(d, free) - start(pack, free);
        store(pack, to_, at);
        return parked;
    }

    static HWY_INLINE FloatM ends(const WhitePack& pack) {
        return hn::RebindMask(Float(), hn::Gt(pack.collisions, pack.survives));
    }

    HWY_INLINE void leave(const WhitePack& before, FloatM leaves) {
        const Float d;
        const std::size_t at = exits_.count;
        const FloatV step = hn::Div(before.z, hn::Neg(before.direction.w));
        hn::CompressStore(hn::MulAdd(step, before.direction.u, before.x), leaves, d, exits_.x.data() + at);
        hn::CompressStore(hn::MulAdd(step, before.direction.v, before.y), leaves, d, exits_.y.data() + at);
        hn::CompressStore(hn::Add(before.length, step), leaves, d, exits_.length.data() + at);
        hn::CompressStore(before.collisions, hn::RebindMask(Int(), leaves), Int(), exits_.collisions.data() + at);
        exits_.count += hn::CountTrue(d, leaves);
    }

    // Starts a walk in every free lane while any wait, in lane order; parks the others. Returns the number started.
    HWY_INLINE std::size_t start(WhitePack& pack, FloatM free) {
        const Float d;
        const Int di;
        std::size_t started = hn::CountTrue(d, free);
        FloatM starts = free;
        if (started > waiting_) {
            started = static_cast<std::size_t>(waiting_);
            starts = firstOf(free, started);
        }
        waiting_ -= started;
        const IntV survives = collisionsSurvived(pack.random, starts);
        const hn::Mask<Int> free_i = hn::RebindMask(di, free);
        pack.x = hn::IfThenZeroElse(free, pack.x);
        pack.y = hn::IfThenZeroElse(free, pack.y);
        pack.length = hn::IfThenZeroElse(free, pack.length);
        // Parked walks fall through a medium that they never leave.
        pack.z = hn::IfThenElse(free, hn::IfThenElse(starts, hn::Zero(d), hn::Set(d, 1e30f)), pack.z);
        pack.direction.u = hn::IfThenElse(free, set(walk_.sin_beam), pack.direction.u);
        pack.direction.v = hn::IfThenZeroElse(free, pack.direction.v);
        pack.direction.w = hn::IfThenElse(free, set(walk_.cos_beam), pack.direction.w);
        pack.collisions = hn::IfThenZeroElse(free_i, pack.collisions);
        pack.survives = hn::IfThenElse(
            free_i, hn::IfThenElse(hn::RebindMask(di, starts), survives, hn::Set(di, kNever)), pack.survives);
        return started;
    }

    static HWY_NOINLINE FloatM firstOf(FloatM mask, std::size_t count) {
        const Float d;
        HWY_ALIGN float flags[16];
        hn::Store(hn::IfThenElseZero(mask, hn::Set(d, 1.0f)), d, flags);
        for (std::size_t i = 0; i < hn::Lanes(d); ++i)
            if (flags[i] != 0 && count > 0)
                --count;
            else
                flags[i] = 0;
        return hn::Ne(hn::Load(d, flags), hn::Zero(d));
    }

    // The roulette of a whole walk, drawn at its start.
    HWY_INLINE IntV collisionsSurvived(Generator& random, FloatM starts) {
        const Float d;
        const Int di;
        const FloatV n = hn::Mul(exponential(random.nextWhere(starts)), set(1 / walk_.roulette));
        // The largest float below 2^31 keeps the conversion defined.
        return hn::ConvertTo(di, hn::Min(n, hn::Set(d, 0x1.fffffep30f)));
    }

    WhiteWalk walk_;
    std::uint64_t waiting_;  // walks not yet started
    WhiteExits& exits_;
    WhiteLanes lanes_[2];
    WhiteLanes *from_ = &lanes_[0], *to_ = &lanes_[1];  // before and after the current step
};

template <bool kFresnel, bool kIsotropic>
std::uint64_t whiteWalkAs(const WhiteWalk& walk, SplitMix64 seeds, std::uint64_t walks, WhiteExits& exits) {
    return std::make_unique<WhiteWalker<kFresnel, kIsotropic>>(walk, seeds, walks, exits)->run();
}

std::uint64_t whiteChunk(const WhiteWalk& walk, SplitMix64 seeds, std::uint64_t walks, WhiteExits& exits) {
    const bool fresnel = walk.eta != 1, isotropic = walk.g == 0;
    return (fresnel     ? isotropic ? whiteWalkAs<true, true> : whiteWalkAs<true, false>
                : isotropic ? whiteWalkAs<false, true>
                        : whiteWalkAs<false, false>)(walk, seeds, walks, exits);
}

const char* whiteTargetName() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(whiteChunk);
HWY_EXPORT(whiteTargetName);

std::uint64_t walkWhiteChunk(const WhiteWalk& walk, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                             WhiteExits& exits) {
    return HWY_DYNAMIC_DISPATCH(whiteChunk)(walk, streamOf(seed, chunk), walks, exits);
}

const char* whiteInstructionSet() { return HWY_DYNAMIC_DISPATCH(whiteTargetName)(); }

}  // namespace searchlight
#endif
