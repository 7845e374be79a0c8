// The analogue walk, 64 at a time. Walks that end are replaced at once, so the lanes stay full; exactly the walks asked
// for are started and all are finished (to stop at a number of exits would favour short walks).
//
// Positions are float, in mean free paths. Single precision is enough here: a coordinate of a walk is known to 6e-8 of
// its size, its rounding errors are as often up as down, and what the tally sees is a distance from the entry point,
// the origin, where float is finest. A walk of 1e4 collisions strays some 1e2 mean free paths and gathers 1e-3 of one.
// Whatever is small against 1 is kept out of float: absorption (1 - albedo may be 1e-5) ends a walk by a geometric
// variate rather than a comparison with the albedo, and free paths keep 32 bits so that long ones are not cut.
#include "transport/half_space_walk.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "transport/long_walk.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/half_space_walk.cpp"
// SSSE3 would add a copy of the loop that no machine of the last fifteen years prefers. The fallback without SIMD has 4
// emulated lanes; Highway withholds it from GCC before 12.3 for a fault in 16-bit products, of which there are none
// here.
#define HWY_DISABLED_TARGETS HWY_SSSE3
#define HWY_BROKEN_EMU128 0
#include <hwy/foreach_target.h>

#include "transport/lane_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

// Packs of lanes are independent: while one waits for its logarithm, the processor works on the next.
constexpr std::size_t kLanes = 64;
constexpr std::size_t kPackLanes = 4;  // the fewest that a target has
constexpr std::int32_t kNever = std::numeric_limits<std::int32_t>::max();
constexpr std::size_t kExitCapacity = 1024;

struct alignas(64) Lanes {
    float x[kLanes], y[kLanes], z[kLanes];  // z grows into the medium
    float u[kLanes], v[kLanes], w[kLanes];  // direction
    std::int32_t collisions[kLanes];        // so far
    std::int32_t survives[kLanes];          // so many collisions; the next one ends the walk
    std::uint64_t s0[kLanes / 2], s1[kLanes / 2];
};

struct Exits {
    // Compressed stores write whole vectors.
    float x[kExitCapacity + 16], y[kExitCapacity + 16];
    std::int32_t collisions[kExitCapacity + 16];
    std::size_t count = 0;
};

// One vector of walks in registers.
struct Pack {
    FloatV x, y, z, u, v, w;
    IntV collisions, survives;
    Generator random;
};

template <bool kFresnel, bool kIsotropic>
class Walker {
public:
    Walker(const HalfSpaceWalk& walk, SplitMix64 seeds, std::uint64_t walks, ExitTally& tally)
        : walk_(walk), waiting_(walks), tally_(tally) {
        const double log_albedo = std::log1p(-walk.absorbed);
        absorbing_ = walk.absorbed > 0;
        collisions_per_log_ = absorbing_ ? static_cast<float>(std::min(-1 / log_albedo, 1e30)) : 0.0f;
        for (std::size_t i = 0; i < kLanes / 2; ++i) {
            from_->s0[i] = seeds.next();
            from_->s1[i] = seeds.next();
        }
        long_walks_ = SplitMix64(seeds.next());
    }

    std::uint64_t run() {
        const Float d;
        const std::size_t width = hn::Lanes(d);
        std::size_t active[kLanes] = {};
        std::uint64_t alive = 0, steps = 0;
        for (std::size_t at = 0; at < kLanes; at += width) {
            Pack pack = load(from_, at);
            active[at] = start(pack, hn::FirstN(d, width));
            alive += active[at];
            store(pack, from_, at);
        }
        while (alive > 0) {
            // Two passes: a branch on the outcome of a step would cost its whole latency when mispredicted, unless the
            // steps of the other packs are under way by then.
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
        flush();
        return steps - exits_total_;  // a step ends in a collision or an exit
    }

private:
    static HWY_INLINE Pack load(const Lanes* lanes, std::size_t at) {
        const Float d;
        const Int di;
        const Word dw;
        return {hn::Load(d, lanes->x + at),
                hn::Load(d, lanes->y + at),
                hn::Load(d, lanes->z + at),
                hn::Load(d, lanes->u + at),
                hn::Load(d, lanes->v + at),
                hn::Load(d, lanes->w + at),
                hn::Load(di, lanes->collisions + at),
                hn::Load(di, lanes->survives + at),
                {hn::Load(dw, lanes->s0 + at / 2), hn::Load(dw, lanes->s1 + at / 2)}};
    }

    static HWY_INLINE void store(const Pack& pack, Lanes* lanes, std::size_t at) {
        const Float d;
        const Int di;
        const Word dw;
        hn::Store(pack.x, d, lanes->x + at);
        hn::Store(pack.y, d, lanes->y + at);
        hn::Store(pack.z, d, lanes->z + at);
        hn::Store(pack.u, d, lanes->u + at);
        hn::Store(pack.v, d, lanes->v + at);
        hn::Store(pack.w, d, lanes->w + at);
        hn::Store(pack.collisions, di, lanes->collisions + at);
        hn::Store(pack.survives, di, lanes->survives + at);
        hn::Store(pack.random.s0, dw, lanes->s0 + at / 2);
        hn::Store(pack.random.s1, dw, lanes->s1 + at / 2);
    }

    // Walks to the next collision as if there were no surface, and scatters. True when a walk of the pack crossed the
    // surface or ended.
    HWY_INLINE bool advance(std::size_t at) {
        const Float d;
        Pack pack = load(from_, at);
        const FloatV length = exponential(pack.random.next());
        pack.x = hn::MulAdd(length, pack.u, pack.x);
        pack.y = hn::MulAdd(length, pack.v, pack.y);
        pack.z = hn::MulAdd(length, pack.w, pack.z);
        pack.collisions = hn::Add(pack.collisions, hn::Set(Int(), 1));
        const FloatM crosses = hn::Lt(pack.z, hn::Zero(d));
        scatter(pack, crosses);
        store(pack, to_, at);
        return !hn::AllFalse(d, hn::Or(crosses, ends(pack)));
    }

    // What the surface and absorption do to the step just made; new walks in the place of those that ended. Returns the
    // number of lanes that found none.
    HWY_INLINE std::size_t settle(std::size_t at) {
        const Float d;
        const Pack before = load(from_, at);
        Pack pack = load(to_, at);
        const FloatM crosses = hn::Lt(pack.z, hn::Zero(d));
        // Algorithm 1 of [Bitterli2013] with line 8 mended: a path reflected at the surface goes on from the surface,
        // not from where it started. Under a plane mirror that is the mirrored path.
        pack.z = hn::Abs(pack.z);
        FloatM leaves = crosses;
        if constexpr (kFresnel) {
            const FloatV u = uniform(pack.random.nextWhere(crosses));
            leaves = hn::And(crosses, hn::Ge(u, internalReflectance(hn::Neg(before.w))));
        }
        if (!hn::AllFalse(d, leaves)) leave(before, leaves);
        const FloatM free = hn::Or(leaves, ends(pack));
        const std::size_t parked = hn::AllFalse(d, free) ? 0 : hn::CountTrue(d, free) - start(pack, free);
        store(pack, to_, at);
        return parked;
    }

    // Walks absorbed by the collision that they just had (unless the surface let them out before it).
    static HWY_INLINE FloatM ends(const Pack& pack) {
        return hn::RebindMask(Float(), hn::Gt(pack.collisions, pack.survives));
    }

    // A new direction by Henyey-Greenstein; of lanes that cross the surface the mirrored direction counts.
    HWY_INLINE void scatter(Pack& pack, FloatM crosses) const {
        const Float d;
        const FloatV one = hn::Set(d, 1.0f);
        const FloatV s = signedUniform(pack.random.next());
        const Azimuth phi = azimuth(pack.random.next());
        if constexpr (kIsotropic) {
            const FloatV sine = hn::Sqrt(hn::Max(hn::NegMulAdd(s, s, one), hn::Zero(d)));
            pack.u = hn::Mul(sine, phi.cos);
            pack.v = hn::Mul(sine, phi.sin);
            pack.w = s;
        } else {
            // [HenyeyGreenstein1941]; m = 1 - cos is written without differences of near numbers, for g near 0 and near 1.
            const FloatV g = hn::Set(d, static_cast<float>(walk_.g));
            const FloatV p = hn::MulAdd(g, s, one);
            const FloatV half_qq = hn::Set(d, static_cast<float>(0.5 * (1 - walk_.g) * (1 - walk_.g)));
            const FloatV numerator = hn::Mul(hn::Mul(half_qq, hn::Sub(one, s)), hn::Add(hn::Add(one, g), p));
            const FloatV m = hn::Min(hn::Div(numerator, hn::Mul(p, p)), hn::Set(d, 2.0f));
            const FloatV cosine = hn::Sub(one, m);
            const FloatV sine = hn::Sqrt(hn::Mul(m, hn::Sub(hn::Set(d, 2.0f), m)));
            rotate(pack, hn::IfThenElse(crosses, hn::Neg(pack.w), pack.w), cosine, hn::Mul(sine, phi.cos),
                   hn::Mul(sine, phi.sin));
        }
    }

    // Turns (u, v, w) by the polar cosine c and the transverse components a, b: the frame of [Duff2017].
    static HWY_INLINE void rotate(Pack& pack, FloatV w, FloatV c, FloatV a, FloatV b) {
        const Float d;
        const FloatV one = hn::Set(d, 1.0f);
        const FloatV u = pack.u, v = pack.v;
        const FloatV sign = hn::CopySign(one, w);
        const FloatV k = hn::Div(hn::Neg(one), hn::Add(sign, w));
        const FloatV uvk = hn::Mul(hn::Mul(u, v), k);
        const FloatV tangent_x = hn::MulAdd(hn::Mul(sign, hn::Mul(u, u)), k, one);
        const FloatV bitangent_y = hn::MulAdd(hn::Mul(v, v), k, sign);
        const FloatV sa = hn::Mul(sign, a);
        const FloatV nu = hn::MulAdd(c, u, hn::MulAdd(a, tangent_x, hn::Mul(b, uvk)));
        const FloatV nv = hn::MulAdd(c, v, hn::MulAdd(sa, uvk, hn::Mul(b, bitangent_y)));
        const FloatV nw = hn::NegMulAdd(sa, u, hn::NegMulAdd(b, v, hn::Mul(c, w)));
        // One Newton step holds the length at 1: unmended, the rounding of thousands of turns would add up.
        const FloatV square = hn::MulAdd(nu, nu, hn::MulAdd(nv, nv, hn::Mul(nw, nw)));
        const FloatV mend = hn::NegMulAdd(hn::Set(d, 0.5f), square, hn::Set(d, 1.5f));
        pack.u = hn::Mul(nu, mend);
        pack.v = hn::Mul(nv, mend);
        pack.w = hn::Mul(nw, mend);
    }

    // Unpolarised Fresnel reflectance seen from inside under the cosine c; 1 under total reflection, where the
    // transmitted cosine is 0. Lanes with c <= 0 hold nonsense.
    HWY_INLINE FloatV internalReflectance(FloatV c) const {
        const Float d;
        const FloatV eta = hn::Set(d, static_cast<float>(walk_.eta));
        const FloatV eta2 = hn::Set(d, static_cast<float>(walk_.eta * walk_.eta));
        const FloatV sine2 = hn::NegMulAdd(c, c, hn::Set(d, 1.0f));
        const FloatV t = hn::Sqrt(hn::Max(hn::NegMulAdd(eta2, sine2, hn::Set(d, 1.0f)), hn::Zero(d)));
        const FloatV eta_c = hn::Mul(eta, c), eta_t = hn::Mul(eta, t);
        const FloatV s = hn::Div(hn::Sub(eta_c, t), hn::Add(eta_c, t));
        const FloatV p = hn::Div(hn::Sub(c, eta_t), hn::Add(c, eta_t));
        return hn::Mul(hn::Set(d, 0.5f), hn::MulAdd(s, s, hn::Mul(p, p)));
    }

    HWY_INLINE void leave(const Pack& before, FloatM leaves) {
        const Float d;
        const FloatV length = hn::Div(before.z, hn::Neg(before.w));
        hn::CompressStore(hn::MulAdd(length, before.u, before.x), leaves, d, exits_.x + exits_.count);
        hn::CompressStore(hn::MulAdd(length, before.v, before.y), leaves, d, exits_.y + exits_.count);
        hn::CompressStore(before.collisions, hn::RebindMask(Int(), leaves), Int(), exits_.collisions + exits_.count);
        exits_.count += hn::CountTrue(d, leaves);
        if (exits_.count >= kExitCapacity - 16) flush();
    }

    HWY_NOINLINE void flush() {
        tally_.add({exits_.x, exits_.count}, {exits_.y, exits_.count}, {exits_.collisions, exits_.count});
        exits_total_ += exits_.count;
        exits_.count = 0;
    }

    // Starts a walk in every free lane while any wait, in lane order; parks the others. Returns the number started.
    HWY_INLINE std::size_t start(Pack& pack, FloatM free) {
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
        // Parked walks fall through a medium that they never leave.
        pack.z = hn::IfThenElse(free, hn::IfThenElse(starts, hn::Zero(d), hn::Set(d, 1e30f)), pack.z);
        pack.u = hn::IfThenElse(free, hn::Set(d, static_cast<float>(walk_.sin_beam)), pack.u);
        pack.v = hn::IfThenZeroElse(free, pack.v);
        pack.w = hn::IfThenElse(free, hn::Set(d, static_cast<float>(walk_.cos_beam)), pack.w);
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

    // The roulette of line 15 of Algorithm 1, drawn at once for the whole walk: it survives n collisions with
    // probability albedo^n.
    HWY_INLINE IntV collisionsSurvived(Generator& random, FloatM starts) {
        const Float d;
        const Int di;
        IntV survives = hn::Set(di, kNever);
        if (absorbing_) {
            const FloatV n = hn::Mul(exponential(random.nextWhere(starts)), hn::Set(d, collisions_per_log_));
            // The largest float below 2^31 keeps the conversion defined.
            survives = hn::ConvertTo(di, hn::Min(n, hn::Set(d, 0x1.fffffep30f)));
        }
        const FloatM is_long = hn::And(starts, hn::RebindMask(d, hn::Gt(survives, hn::Set(di, kLongWalk))));
        return hn::AllFalse(d, is_long) ? survives : rouletteLong(survives, is_long);
    }

    HWY_NOINLINE IntV rouletteLong(IntV survives, FloatM is_long) {
        const Float d;
        const Int di;
        HWY_ALIGN std::int32_t ends[16];
        HWY_ALIGN float flags[16];
        hn::Store(survives, di, ends);
        hn::Store(hn::IfThenElseZero(is_long, hn::Set(d, 1.0f)), d, flags);
        for (std::size_t i = 0; i < hn::Lanes(d); ++i)
            if (flags[i] != 0) ends[i] = std::min(ends[i], longWalkSurvives(long_walks_));
        return hn::Load(di, ends);
    }

    HalfSpaceWalk walk_;
    bool absorbing_;
    float collisions_per_log_;  // -1 / log(albedo)
    std::uint64_t waiting_;     // walks not yet started
    std::uint64_t exits_total_ = 0;
    SplitMix64 long_walks_;
    ExitTally& tally_;
    Lanes lanes_[2];
    Lanes *from_ = &lanes_[0], *to_ = &lanes_[1];  // before and after the current step
    Exits exits_;
};

template <bool kFresnel, bool kIsotropic>
std::uint64_t walkAs(const HalfSpaceWalk& walk, SplitMix64 seeds, std::uint64_t walks, ExitTally& tally) {
    return std::make_unique<Walker<kFresnel, kIsotropic>>(walk, seeds, walks, tally)->run();
}

std::uint64_t walkChunk(const HalfSpaceWalk& walk, SplitMix64 seeds, std::uint64_t walks, ExitTally& tally) {
    const bool fresnel = walk.eta != 1, isotropic = walk.g == 0;
    return (fresnel     ? isotropic ? walkAs<true, true> : walkAs<true, false>
                : isotropic ? walkAs<false, true>
                        : walkAs<false, false>)(walk, seeds, walks, tally);
}

const char* targetName() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(walkChunk);
HWY_EXPORT(targetName);

std::uint64_t walkHalfSpaceChunk(const HalfSpaceWalk& walk, std::uint64_t seed, std::uint64_t chunk,
                                 std::uint64_t walks, ExitTally& tally) {
    return HWY_DYNAMIC_DISPATCH(walkChunk)(walk, streamOf(seed, chunk), walks, tally);
}

const char* halfSpaceInstructionSet() { return HWY_DYNAMIC_DISPATCH(targetName)(); }

}  // namespace searchlight
#endif
