// The walk of half_space_walk.cpp without absorption, which measures its own path. The scheme is the same: 64 lanes in
// packs that hide each other's latency, two passes so that no branch waits for a step, a new walk wherever one ended,
// exactly the walks asked for, all of them finished.
//
// The path is a float sum of n lengths of mean 1. Each addition rounds by at most half a unit in the last place, up as
// often as down: 1e5 collisions leave 1 mean free path, against weights that change over 1e4 (largest albedo .9999).
#include "transport/white/white_walk.h"

#include <memory>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/white/white_walk.cpp"
#include <hwy/foreach_target.h>

#include "transport/walk/lane_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

struct WhiteLanes : Lanes {
    float length[kLanes];  // of the path so far
};

struct WhitePack : Pack {
    FloatV length;
};

HWY_INLINE WhitePack load(const WhiteLanes& lanes, std::size_t at) {
    return {load(static_cast<const Lanes&>(lanes), at), hn::Load(Float(), lanes.length + at)};
}

HWY_INLINE void store(const WhitePack& pack, WhiteLanes& lanes, std::size_t at) {
    store(static_cast<const Pack&>(pack), static_cast<Lanes&>(lanes), at);
    hn::Store(pack.length, Float(), lanes.length + at);
}

template <bool kFresnel, bool kIsotropic>
class WhiteWalker {
public:
    WhiteWalker(const WhiteWalk& walk, SplitMix64 seeds, std::uint64_t walks, WhiteExits& exits)
        : walk_(walk), waiting_(walks), exits_(exits) {
        seed(*from_, seeds);
        const std::size_t room = static_cast<std::size_t>(walks) + 16;  // whole vectors are stored at the end
        for (auto* list : {&exits.x, &exits.y, &exits.length}) list->resize(room);
        exits.collisions.resize(room);
        exits.count = 0;
    }

    std::uint64_t run() {
        const std::uint64_t steps = walkAll(*this, from_, to_);
        return steps - exits_.count;  // a step ends in a collision or an exit
    }

    // Walks to the next collision as if there were no surface, and scatters. True when a walk of the pack crossed the
    // surface or ended.
    HWY_INLINE bool advance(std::size_t at) {
        const Float d;
        WhitePack pack = load(*from_, at);
        const FloatV step = exponential(pack.random.next());
        fly(pack, step);
        pack.length = hn::Add(pack.length, step);
        const FloatM crosses = hn::Lt(pack.z, hn::Zero(d));
        // Of lanes that cross the surface the mirrored direction counts.
        pack.direction.w = hn::IfThenElse(crosses, hn::Neg(pack.direction.w), pack.direction.w);
        scatter<kIsotropic>(pack, set(walk_.g), set(0.5 * (1 - walk_.g) * (1 - walk_.g)));
        store(pack, *to_, at);
        return !hn::AllFalse(d, hn::Or(crosses, ends(pack, at)));
    }

    // What the surface and the roulette do to the step just made; new walks in the place of those that ended. Returns
    // the number of lanes that found none.
    HWY_INLINE std::size_t settle(std::size_t at) {
        const Float d;
        const WhitePack before = load(*from_, at);
        WhitePack pack = load(*to_, at);
        const FloatM crosses = hn::Lt(pack.z, hn::Zero(d));
        pack.z = hn::Abs(pack.z);  // a path reflected by a plane is the mirrored path
        FloatM leaves = crosses;
        if constexpr (kFresnel) {
            const FloatV u = uniform(pack.random.nextWhere(crosses));
            leaves = hn::And(crosses, hn::Ge(u, fresnel(hn::Neg(before.direction.w), set(walk_.eta)).reflectance));
        }
        if (!hn::AllFalse(d, leaves)) leave(before, leaves);
        const FloatM free = hn::Or(leaves, ends(pack, at));
        const std::size_t parked = hn::AllFalse(d, free) ? 0 : hn::CountTrue(d, free) - start(pack, free, at);
        store(pack, *to_, at);
        return parked;
    }

    // Starts a walk in every free lane while any wait, in lane order; parks the others. Returns the number started.
    HWY_INLINE std::size_t start(WhitePack& pack, FloatM free, std::size_t at) {
        const Int di;
        const Started started = takeWaiting(free, waiting_);
        // The roulette of a whole walk, drawn at its start.
        const IntV survives = collisionsSurvived(pack.random.nextWhere(started.lanes), set(1 / walk_.roulette));
        moveToEntry(pack, free, walk_.sin_beam, walk_.cos_beam);
        pack.length = hn::IfThenZeroElse(free, pack.length);
        park(pack, hn::AndNot(started.lanes, free));
        const IntV drawn = hn::IfThenElse(hn::RebindMask(di, started.lanes), survives, hn::Set(di, kNever));
        storeWhere(hn::RebindMask(di, free), drawn, survives_ + at);
        return started.count;
    }

private:
    static HWY_INLINE FloatV set(double value) { return hn::Set(Float(), static_cast<float>(value)); }

    HWY_INLINE FloatM ends(const WhitePack& pack, std::size_t at) const {
        return hn::RebindMask(Float(), hn::Gt(pack.collisions, hn::Load(Int(), survives_ + at)));
    }

    HWY_INLINE void leave(const WhitePack& before, FloatM leaves) {
        const Float d;
        const std::size_t at = exits_.count;
        const FloatV step = hn::Div(before.z, hn::Neg(before.direction.w));
        storeSet(hn::MulAdd(step, before.direction.u, before.x), leaves, d, exits_.x.data() + at);
        storeSet(hn::MulAdd(step, before.direction.v, before.y), leaves, d, exits_.y.data() + at);
        storeSet(hn::Add(before.length, step), leaves, d, exits_.length.data() + at);
        storeSet(before.collisions, hn::RebindMask(Int(), leaves), Int(), exits_.collisions.data() + at);
        exits_.count += hn::CountTrue(d, leaves);
    }

    WhiteWalk walk_;
    std::uint64_t waiting_;  // walks not yet started
    WhiteExits& exits_;
    WhiteLanes lanes_[2];
    WhiteLanes *from_ = &lanes_[0], *to_ = &lanes_[1];  // before and after the current step
    // So many collisions; the next one ends the walk.
    alignas(64) std::int32_t survives_[kLanes];
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
