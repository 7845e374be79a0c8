// The analogue walk, 64 at a time. Walks that end are replaced at once, so the lanes stay full; exactly the walks asked
// for are started and all are finished (to stop at a number of exits would favour short walks).
//
// Positions are float, in mean free paths. Single precision is enough here: a coordinate of a walk is known to 6e-8 of
// its size, its rounding errors are as often up as down, and what the tally sees is a distance from the entry point,
// the origin, where float is finest. A walk of 1e4 collisions strays some 1e2 mean free paths and gathers 1e-3 of one.
// Whatever is small against 1 is kept out of float: absorption (1 - albedo may be 1e-5) ends a walk by a geometric
// variate rather than a comparison with the albedo, and free paths keep 32 bits so that long ones are not cut.
#include "transport/half_space/half_space_walk.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <type_traits>

#include "transport/walk/long_walk.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/half_space/half_space_walk.cpp"
#include <hwy/foreach_target.h>

#include "transport/walk/lane_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

constexpr std::size_t kExitCapacity = 1024;

struct Exits {
    // Whole vectors are stored at the end.
    float x[kExitCapacity + 16], y[kExitCapacity + 16];
    float u[kExitCapacity + 16], v[kExitCapacity + 16];  // direction inside; only for tallies that ask for it
    std::int32_t collisions[kExitCapacity + 16];
    std::size_t count = 0;
};

template <bool kFresnel, bool kIsotropic, class Tally>
class Walker {
public:
    Walker(const HalfSpaceWalk& walk, SplitMix64 seeds, std::uint64_t walks, Tally& tally)
        : walk_(walk), waiting_(walks), tally_(tally) {
        const double log_albedo = std::log1p(-walk.absorbed);
        absorbing_ = walk.absorbed > 0;
        collisions_per_log_ = absorbing_ ? static_cast<float>(std::min(-1 / log_albedo, 1e30)) : 0.0f;
        seed(*from_, seeds);
        rare_ = SplitMix64(seeds.next());
    }

    std::uint64_t run() {
        const std::uint64_t steps = walkAll(*this, from_, to_);
        flush();
        return steps - exits_total_;  // a step ends in a collision or an exit
    }

    // Walks to the next collision as if there were no surface, and scatters. True when a walk of the pack crossed the
    // surface or ended.
    HWY_INLINE bool advance(std::size_t at) {
        const Float d;
        Pack pack = load(*from_, at);
        const FloatV length = exponential(pack.random.next());
        fly(pack, length);
        const FloatM crosses = hn::Lt(pack.z, hn::Zero(d));
        // Of lanes that cross the surface the mirrored direction counts.
        pack.direction.w = hn::IfThenElse(crosses, hn::Neg(pack.direction.w), pack.direction.w);
        scatter<kIsotropic>(pack, set(walk_.g), set(0.5 * (1 - walk_.g) * (1 - walk_.g)));
        store(pack, *to_, at);
        return !hn::AllFalse(d, hn::Or(crosses, ends(pack, at)));
    }

    // What the surface and absorption do to the step just made; new walks in the place of those that ended. Returns the
    // number of lanes that found none.
    HWY_INLINE std::size_t settle(std::size_t at) {
        const Float d;
        const Pack before = load(*from_, at);
        Pack pack = load(*to_, at);
        const FloatM crosses = hn::Lt(pack.z, hn::Zero(d));
        // Algorithm 1 of [Bitterli2013] with line 8 mended: a path reflected at the surface goes on from the surface,
        // not from where it started. Under a plane mirror that is the mirrored path.
        pack.z = hn::Abs(pack.z);
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
    HWY_INLINE std::size_t start(Pack& pack, FloatM free, std::size_t at) {
        const Int di;
        const Started started = takeWaiting(free, waiting_);
        const IntV survives = drawSurvives(pack.random, started.lanes);
        moveToEntry(pack, free, walk_.sin_beam, walk_.cos_beam);
        if (walk_.shape.kind != BeamShape::pencil) place(pack, started.lanes);
        park(pack, hn::AndNot(started.lanes, free));
        const IntV drawn = hn::IfThenElse(hn::RebindMask(di, started.lanes), survives, hn::Set(di, kNever));
        storeWhere(hn::RebindMask(di, free), drawn, survives_ + at);
        return started.count;
    }

private:
    static constexpr bool kDirected = std::is_same_v<Tally, RadianceTally>;

    static HWY_INLINE FloatV set(double value) { return hn::Set(Float(), static_cast<float>(value)); }

    // Anywhere in the beam.
    HWY_NOINLINE void place(Pack& pack, FloatM starts) {
        const Float d;
        HWY_ALIGN float x[16] = {}, y[16] = {};
        forEachLane(starts, [&](std::size_t lane, std::size_t) {
            const BeamPoint point = walk_.shape.draw(rare_, walk_.cos_incidence);
            x[lane] = static_cast<float>(point.x);
            y[lane] = static_cast<float>(point.y);
        });
        pack.x = hn::IfThenElse(starts, hn::Load(d, x), pack.x);
        pack.y = hn::IfThenElse(starts, hn::Load(d, y), pack.y);
    }

    // Walks absorbed by the collision that they just had (unless the surface let them out before it).
    HWY_INLINE FloatM ends(const Pack& pack, std::size_t at) const {
        return hn::RebindMask(Float(), hn::Gt(pack.collisions, hn::Load(Int(), survives_ + at)));
    }

    HWY_INLINE void leave(const Pack& before, FloatM leaves) {
        const Float d;
        const Direction& out = before.direction;
        const FloatV length = hn::Div(before.z, hn::Neg(out.w));
        storeSet(hn::MulAdd(length, out.u, before.x), leaves, d, exits_.x + exits_.count);
        storeSet(hn::MulAdd(length, out.v, before.y), leaves, d, exits_.y + exits_.count);
        if constexpr (kDirected) {
            storeSet(out.u, leaves, d, exits_.u + exits_.count);
            storeSet(out.v, leaves, d, exits_.v + exits_.count);
        }
        storeSet(before.collisions, hn::RebindMask(Int(), leaves), Int(), exits_.collisions + exits_.count);
        exits_.count += hn::CountTrue(d, leaves);
        if (exits_.count >= kExitCapacity - 16) flush();
    }

    HWY_NOINLINE void flush() {
        const std::size_t n = exits_.count;
        if constexpr (kDirected)
            tally_.add({exits_.x, n}, {exits_.y, n}, {exits_.u, n}, {exits_.v, n}, {exits_.collisions, n});
        else
            tally_.add({exits_.x, n}, {exits_.y, n}, {exits_.collisions, n});
        exits_total_ += exits_.count;
        exits_.count = 0;
    }

    // The roulette of line 15 of Algorithm 1, drawn at once for the whole walk: it survives n collisions with
    // probability albedo^n.
    HWY_INLINE IntV drawSurvives(Generator& random, FloatM starts) {
        const Float d;
        const Int di;
        IntV survives = hn::Set(di, kNever);
        if (absorbing_) survives = collisionsSurvived(random.nextWhere(starts), hn::Set(d, collisions_per_log_));
        const FloatM is_long = hn::And(starts, hn::RebindMask(d, hn::Gt(survives, hn::Set(di, kLongWalk))));
        return hn::AllFalse(d, is_long) ? survives : rouletteLong(survives, is_long);
    }

    HWY_NOINLINE IntV rouletteLong(IntV survives, FloatM is_long) {
        const Int di;
        HWY_ALIGN std::int32_t ends[16];
        hn::Store(survives, di, ends);
        forEachLane(is_long,
                    [&](std::size_t lane, std::size_t) { ends[lane] = std::min(ends[lane], longWalkSurvives(rare_)); });
        return hn::Load(di, ends);
    }

    HalfSpaceWalk walk_;
    bool absorbing_;
    float collisions_per_log_;  // -1 / log(albedo)
    std::uint64_t waiting_;     // walks not yet started
    std::uint64_t exits_total_ = 0;
    SplitMix64 rare_;
    Tally& tally_;
    Lanes lanes_[2];
    Lanes *from_ = &lanes_[0], *to_ = &lanes_[1];  // before and after the current step
    // So many collisions; the next one ends the walk.
    alignas(64) std::int32_t survives_[kLanes];
    Exits exits_;
};

template <bool kFresnel, bool kIsotropic, class Tally>
std::uint64_t walkAs(const HalfSpaceWalk& walk, SplitMix64 seeds, std::uint64_t walks, Tally& tally) {
    return std::make_unique<Walker<kFresnel, kIsotropic, Tally>>(walk, seeds, walks, tally)->run();
}

template <class Tally>
std::uint64_t walkInto(const HalfSpaceWalk& walk, SplitMix64 seeds, std::uint64_t walks, Tally& tally) {
    const bool fresnel = walk.eta != 1, isotropic = walk.g == 0;
    return (fresnel     ? isotropic ? walkAs<true, true, Tally> : walkAs<true, false, Tally>
                : isotropic ? walkAs<false, true, Tally>
                        : walkAs<false, false, Tally>)(walk, seeds, walks, tally);
}

std::uint64_t walkChunk(const HalfSpaceWalk& walk, SplitMix64 seeds, std::uint64_t walks, ExitTally& tally) {
    return walkInto(walk, seeds, walks, tally);
}

std::uint64_t walkDirectedChunk(const HalfSpaceWalk& walk, SplitMix64 seeds, std::uint64_t walks,
                                RadianceTally& tally) {
    return walkInto(walk, seeds, walks, tally);
}

const char* targetName() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(walkChunk);
HWY_EXPORT(walkDirectedChunk);
HWY_EXPORT(targetName);

std::uint64_t walkHalfSpaceChunk(const HalfSpaceWalk& walk, std::uint64_t seed, std::uint64_t chunk,
                                 std::uint64_t walks, ExitTally& tally) {
    return HWY_DYNAMIC_DISPATCH(walkChunk)(walk, streamOf(seed, chunk), walks, tally);
}

std::uint64_t walkHalfSpaceChunk(const HalfSpaceWalk& walk, std::uint64_t seed, std::uint64_t chunk,
                                 std::uint64_t walks, RadianceTally& tally) {
    return HWY_DYNAMIC_DISPATCH(walkDirectedChunk)(walk, streamOf(seed, chunk), walks, tally);
}

const char* halfSpaceInstructionSet() { return HWY_DYNAMIC_DISPATCH(targetName)(); }

}  // namespace searchlight
#endif
