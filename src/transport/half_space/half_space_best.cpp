// Unbiased, with less noise than the analogue walk of half_space_walk.cpp, for three reasons.
//
// Expected escape: each collision tallies the flux that leaves without another collision, at points drawn on the
// surface. The way out is drawn inside the escape cone, uniform in its cosine (uniform in radius would have a variance
// without bound), and comes with its opposite azimuth; 16 lanes share it (ways_out-inl.h). What crosses the surface
// later was counted already: only the reflected part goes on.
//
// Where a phase function is too sharp for that, what crosses the surface is tallied: its refracted part, and the other
// goes on.
//
// Importance: weight times importance below 0.8 meets a roulette, above 2 the walk is split (importance.h).
//
// Order 1 is exact (single_scattering.h).
//
// Everything that is random depends on the lane and its 16 alone, and sums run in lane order: the result does not
// depend on the width of the hardware's vectors.
#include "transport/half_space/half_space_best.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "transport/walk/long_walk.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/half_space/half_space_best.cpp"
#include <hwy/foreach_target.h>

#include "transport/half_space/ways_out-inl.h"
#include "transport/walk/lane_foresee-inl.h"
#include "transport/walk/lane_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

// A flight that is drawn longer is so many times as long.
constexpr double kStretch = 3;

struct alignas(64) BestLanes {
    float x[kLanes], y[kLanes], z[kLanes];  // of the collision to come, z grows into the medium
    float u[kLanes], v[kLanes], w[kLanes];  // direction before it
    float weight[kLanes];
    float value[kLanes];  // weight times importance
    std::int32_t order[kLanes];
    std::uint64_t s0[kLanes / 2], s1[kLanes / 2];
    float moments[4][kLanes];  // weight times x and r^2, of order 1 and of all, not yet in the sums
};

// What crossed the surface, until there is enough of it.
struct alignas(64) BestExits {
    static constexpr std::size_t kEnough = 192;
    float x[kEnough + kLanes + 16], y[kEnough + kLanes + 16], weight[kEnough + kLanes + 16];
    std::int32_t order[kEnough + kLanes + 16];
    std::size_t count = 0;
};

struct BestPack {
    FloatV x, y, z;
    Direction direction;
    FloatV weight;
    IntV order;
    Generator random;
};

// Part of a split walk that waits for a lane.
struct Waiting {
    float x, y, z, u, v, w, weight;
    std::int32_t order, parts;
};

template <bool kFresnel, bool kIsotropic, bool kForesees>
class BestWalker {
public:
    BestWalker(const BestPlan& plan, SplitMix64 seeds, std::uint64_t walks)
        : plan_(plan),
          waiting_(walks),
          slots_(plan.bins.next_edge.size()),
          stride_((plan.single ? 1 : 2) * slots_ | 1),
          histogram_(kWays * kCopies * stride_),
          sums_(2 * slots_),
          albedo_(static_cast<float>(1 - plan.walk.absorbed)),
          ways_(plan.walk, seeds) {
        std::memset(&lanes_, 0, sizeof lanes_);
        seed(lanes_, seeds);
    }

    std::uint64_t run(ExitTally& tally) {
        std::uint64_t collisions = 0;
        const std::size_t flush_steps = std::max(kFlushSteps, 2 * slots_);
        std::size_t steps = 0;
        while (const int alive = refill()) {
            collisions += static_cast<std::uint64_t>(alive);
            free_ = split_ = 0;
            if (kForesees && (way_ += kLanes / kCopies) == WaysOut::kCount) {
                ways_.renew();
                way_ = 0;
            }
            // Long flights of operations are cut in two, so that those of several packs overlap.
            for (std::size_t at = 0; at < kLanes; at += hn::Lanes(Float())) fly(at);
            for (std::size_t at = 0; at < kLanes; at += hn::Lanes(Float())) judge(at);
            if (!kForesees && exits_.count >= BestExits::kEnough) depositExits();
            if (split_ != 0) splitWalks();
            if (++steps == flush_steps) {
                flush();
                steps = 0;
            }
        }
        if constexpr (!kForesees) depositExits();
        flush();
        finish(tally);
        return collisions;
    }

private:
    // Ways out of a collision: one, and the same turned by half a turn.
    static constexpr std::size_t kWays = !kForesees ? 1 : 2;

    static HWY_INLINE FloatV set(double value) { return hn::Set(Float(), static_cast<float>(value)); }

    HWY_INLINE BestPack load(std::size_t at) const {
        const Float d;
        const Word dw;
        BestPack pack{hn::Load(d, lanes_.x + at),
                      hn::Load(d, lanes_.y + at),
                      hn::Load(d, lanes_.z + at),
                      {hn::Zero(d), hn::Zero(d), hn::Zero(d)},
                      hn::Load(d, lanes_.weight + at),
                      hn::Load(Int(), lanes_.order + at),
                      {hn::Load(dw, lanes_.s0 + at / 2), hn::Load(dw, lanes_.s1 + at / 2)}};
        if constexpr (!kIsotropic)
            pack.direction = {hn::Load(d, lanes_.u + at), hn::Load(d, lanes_.v + at), hn::Load(d, lanes_.w + at)};
        return pack;
    }

    HWY_INLINE void store(const BestPack& pack, std::size_t at) {
        const Float d;
        const Word dw;
        hn::Store(pack.x, d, lanes_.x + at);
        hn::Store(pack.y, d, lanes_.y + at);
        hn::Store(pack.z, d, lanes_.z + at);
        if constexpr (!kIsotropic) {
            hn::Store(pack.direction.u, d, lanes_.u + at);
            hn::Store(pack.direction.v, d, lanes_.v + at);
            hn::Store(pack.direction.w, d, lanes_.w + at);
        }
        hn::Store(pack.weight, d, lanes_.weight + at);
        hn::Store(pack.order, Int(), lanes_.order + at);
        hn::Store(pack.random.s0, dw, lanes_.s0 + at / 2);
        hn::Store(pack.random.s1, dw, lanes_.s1 + at / 2);
    }

    // The collision of each walk, its flight to the next, and whether that one is worth having.
    HWY_INLINE void fly(std::size_t at) {
        const Float d;
        BestPack pack = load(at);
        const FloatV luck = fineUniform(pack.random.next());
        const FloatV s = signedUniform(pack.random.next());
        const Azimuth phi = azimuth(pack.random.next());
        if constexpr (kForesees) foresee(pack, at);
        if constexpr (kIsotropic)
            pack.direction = isotropicDirection(s, phi);
        else
            pack.direction = henyeyGreenstein(pack.direction, set(plan_.walk.g),
                                              set(0.5 * (1 - plan_.walk.g) * (1 - plan_.walk.g)), s, phi);

        FloatV length = exponential(pack.random.next());
        if (plan_.tuning.stretched > 0) stretch(pack, length);
        pack.x = hn::MulAdd(length, pack.direction.u, pack.x);
        pack.y = hn::MulAdd(length, pack.direction.v, pack.y);
        pack.z = hn::MulAdd(length, pack.direction.w, pack.z);
        hn::Store(luck, d, lanes_.value + at);
        store(pack, at);
        if constexpr (kIsotropic) hn::Store(pack.direction.w, d, lanes_.w + at);
    }

    // What the surface and the importance do to it.
    HWY_INLINE void judge(std::size_t at) {
        const Float d;
        const Int di;
        const FloatV zero = hn::Zero(d), one = hn::Set(d, 1.0f);
        BestPack pack = load(at);
        if constexpr (kIsotropic) pack.direction.w = hn::Load(d, lanes_.w + at);
        const FloatV luck = hn::Load(d, lanes_.value + at), z = pack.z;
        const FloatM crosses = hn::Lt(z, zero);
        const FloatV onward = pack.direction.w;
        pack.z = hn::Abs(z);  // under a plane mirror the reflected path is the mirrored path
        if constexpr (!kIsotropic) pack.direction.w = hn::IfThenElse(crosses, hn::Neg(onward), onward);
        FloatV reflected = zero;
        if constexpr (kFresnel) reflected = hn::Mul(pack.weight, reflectance(hn::Neg(onward)));
        if constexpr (!kForesees) {
            const FloatV back = hn::Div(z, hn::Neg(onward));  // from where the surface was crossed
            const std::size_t count = exits_.count;
            storeSet(hn::MulAdd(back, pack.direction.u, pack.x), crosses, d, exits_.x + count);
            storeSet(hn::MulAdd(back, pack.direction.v, pack.y), crosses, d, exits_.y + count);
            storeSet(hn::Sub(pack.weight, reflected), crosses, d, exits_.weight + count);
            storeSet(pack.order, hn::RebindMask(di, crosses), di, exits_.order + count);
            exits_.count += hn::CountTrue(d, crosses);
        }
        pack.weight = hn::IfThenElse(crosses, reflected, pack.weight);
        pack.order = hn::Min(hn::Add(pack.order, hn::Set(di, 1)), hn::Set(di, kEndlessWalk));
        // The first two collisions are common to all walks: finish() counts what they absorb.
        const FloatM absorbs = hn::RebindMask(d, hn::Gt(pack.order, hn::Set(di, 2)));
        pack.weight = hn::IfThenElse(absorbs, hn::Mul(pack.weight, hn::Set(d, albedo_)), pack.weight);

        const FloatV importance = importanceOf(pack);
        const FloatV value = hn::Mul(pack.weight, importance);
        const FloatM low = hn::Lt(value, set(plan_.tuning.roulette));
        const FloatM lives = hn::Lt(luck, value);
        pack.weight = hn::IfThenElse(low, hn::IfThenElseZero(lives, hn::Div(one, importance)), pack.weight);
        store(pack, at);
        hn::Store(value, d, lanes_.value + at);
        free_ |= bitsOf(hn::AndNot(lives, low), at);
        split_ |= bitsOf(hn::Gt(value, hn::Set(d, kSplit)), at);
    }

    // Draws some flights longer; the weight makes up for it.
    HWY_INLINE void stretch(BestPack& pack, FloatV& length) const {
        const Float d;
        const FloatV part = set(plan_.tuning.stretched), times = set(kStretch);
        const FloatM longer = hn::Lt(uniform(pack.random.next()), part);
        length = hn::IfThenElse(longer, hn::Mul(times, length), length);
        // exp(-s) over the density of the mixture, with nothing that overflows.
        const FloatV natural = expNegative(length), slow = expNegative(hn::Mul(length, set(1 / kStretch)));
        const FloatV density =
            hn::MulAdd(hn::Sub(hn::Set(d, 1.0f), part), natural, hn::Mul(hn::Mul(part, set(1 / kStretch)), slow));
        pack.weight = hn::Mul(pack.weight, hn::Div(natural, density));
    }

    HWY_INLINE FloatV reflectance(FloatV cosine) const { return fresnel(cosine, set(plan_.walk.eta)).reflectance; }

    // Tallies what leaves without another collision, along ways out that 16 lanes share.
    HWY_INLINE void foresee(const BestPack& pack, std::size_t at) {
        const Float d;
        const std::size_t way = way_ + at / kCopies;
        const FloatV path = hn::Mul(pack.z, hn::Set(d, ways_.path[way]));
        const FloatV leaves = hn::Mul(hn::Mul(pack.weight, hn::Set(d, ways_.share[way] / kWays)), expNegative(path));
        const FloatV dx = hn::Mul(pack.z, hn::Set(d, ways_.x[way])), dy = hn::Mul(pack.z, hn::Set(d, ways_.y[way]));
        if constexpr (kIsotropic) {
            deposit<0>(pack.order, at, hn::Add(pack.x, dx), hn::Add(pack.y, dy), leaves);
            deposit<1>(pack.order, at, hn::Sub(pack.x, dx), hn::Sub(pack.y, dy), leaves);
        } else {
            const FloatV across = hn::MulAdd(hn::Set(d, ways_.u[way]), pack.direction.u,
                                             hn::Mul(hn::Set(d, ways_.v[way]), pack.direction.v));
            const FloatV up = hn::Mul(hn::Set(d, ways_.w[way]), pack.direction.w), g = set(plan_.walk.g);
            deposit<0>(pack.order, at, hn::Add(pack.x, dx), hn::Add(pack.y, dy),
                       hn::Mul(leaves, henyeyGreensteinGain(g, hn::Sub(across, up))));
            deposit<1>(pack.order, at, hn::Sub(pack.x, dx), hn::Sub(pack.y, dy),
                       hn::Mul(leaves, henyeyGreensteinGain(g, hn::Neg(hn::Add(across, up)))));
        }
    }

    HWY_NOINLINE void depositExits() {
        const Float d;
        // The last vector is filled up with what weighs nothing.
        for (std::size_t i = exits_.count; i % kCopies != 0; ++i)
            exits_.x[i] = exits_.y[i] = exits_.weight[i] = 0, exits_.order[i] = 1;
        for (std::size_t i = 0; i < exits_.count; i += hn::Lanes(d))
            deposit<0>(hn::Load(Int(), exits_.order + i), i % kCopies, hn::Load(d, exits_.x + i),
                       hn::Load(d, exits_.y + i), hn::Load(d, exits_.weight + i));
        exits_.count = 0;
    }

    // `weight` leaves at (x, y); kWay is one of the collision's.
    template <std::size_t kWay>
    HWY_INLINE void deposit(IntV order, std::size_t at, FloatV x, FloatV y, FloatV weight) {
        const Float d;
        const Int di;
        const FloatV r2 = hn::MulAdd(x, x, hn::Mul(y, y));
        const hn::Mask<Int> first = hn::Eq(order, hn::Set(di, 1));
        const FloatM is_first = hn::RebindMask(d, first);
        IntV slot = slotOf(plan_.bins, r2);
        if (plan_.single)
            weight = hn::IfThenZeroElse(is_first, weight);
        else
            slot = hn::Add(slot, hn::IfThenZeroElse(first, hn::Set(di, static_cast<int>(slots_))));
        const FloatV wx = hn::Mul(weight, x), wr2 = hn::Mul(weight, r2);
        if (!plan_.single) {
            addMoment(0, at, hn::IfThenElseZero(is_first, wx));
            addMoment(1, at, hn::IfThenElseZero(is_first, wr2));
        }
        if (!plan_.guided_moments) {
            addMoment(2, at, wx);
            addMoment(3, at, wr2);
        }
        addToCopies(histogram_.data() + kWay * kCopies * stride_, stride_, at, slot, weight);
    }

    HWY_INLINE void addMoment(std::size_t which, std::size_t at, FloatV value) {
        const Float d;
        float* moment = lanes_.moments[which] + at;
        hn::Store(hn::Add(hn::Load(d, moment), value), d, moment);
    }

    HWY_INLINE FloatV importanceOf(const BestPack& pack) const {
        const Float d;
        const Int di;
        const FloatV offset = hn::Set(d, plan_.importance.offset);
        constexpr int last = ImportanceTable::kCells - 1, bits = ImportanceTable::kMantissaBits;
        FloatV x = pack.x, y = pack.y, z = pack.z;
        if constexpr (!kIsotropic) {
            const FloatV ahead = hn::Set(d, plan_.importance.ahead);
            x = hn::MulAdd(ahead, pack.direction.u, x);
            y = hn::MulAdd(ahead, pack.direction.v, y);
            z = hn::Max(hn::MulAdd(ahead, pack.direction.w, z), hn::Zero(d));
        }
        const FloatV rho2 = hn::MulAdd(x, x, hn::MulAdd(y, y, offset));
        const IntV column = logarithmicCell<bits>(rho2, offset, last);
        const IntV row = logarithmicCell<bits>(hn::MulAdd(z, z, offset), offset, last);
        const IntV index = hn::Add(hn::Mul(row, hn::Set(di, ImportanceTable::kCells)), column);
        return faded(hn::GatherIndex(d, plan_.importance.value.data(), index), pack.order);
    }

    HWY_NOINLINE void flush() {
        const std::size_t known = plan_.single ? slots_ : 0;
        emptyCopies(histogram_, stride_, sums_.data() + known, 2 * slots_ - known);
        for (std::size_t which = 0; which < 4; ++which)
            for (float& moment : lanes_.moments[which]) {
                moments_[which] += static_cast<double>(moment);
                moment = 0;
            }
    }

    HWY_NOINLINE void splitWalks() {
        for (std::uint64_t bits = split_; bits != 0; bits &= bits - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(bits));
            const auto parts = static_cast<std::int32_t>(std::min(lanes_.value[i], kMostParts));
            lanes_.weight[i] /= static_cast<float>(parts);
            bank_.push_back({lanes_.x[i], lanes_.y[i], lanes_.z[i], lanes_.u[i], lanes_.v[i], lanes_.w[i],
                             lanes_.weight[i], lanes_.order[i], parts - 1});
        }
    }

    // Puts parts of split walks, then new walks, into free lanes. Returns the number of lanes that walk.
    HWY_INLINE int refill() {
        if (free_ == 0) return kLanes;
        return refillFree();
    }

    HWY_NOINLINE int refillFree() {
        std::uint64_t free = free_;
        for (; free != 0 && !bank_.empty(); free &= free - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(free));
            Waiting& part = bank_.back();
            lanes_.x[i] = part.x, lanes_.y[i] = part.y, lanes_.z[i] = part.z;
            lanes_.u[i] = part.u, lanes_.v[i] = part.v, lanes_.w[i] = part.w;
            lanes_.weight[i] = part.weight, lanes_.order[i] = part.order;
            if (--part.parts == 0) bank_.pop_back();
        }
        std::uint64_t starts = 0, parked = free;
        for (; parked != 0 && waiting_ > 0; parked &= parked - 1, --waiting_) starts |= parked & -parked;
        for (std::size_t at = 0; at < kLanes; at += hn::Lanes(Float())) start(at, starts, parked);
        return static_cast<int>(kLanes) - std::popcount(parked);
    }

    // New walks stand before their first collision; parked lanes weigh nothing.
    HWY_INLINE void start(std::size_t at, std::uint64_t start_bits, std::uint64_t parked_bits) {
        const Float d;
        const FloatM starts = maskOf(start_bits, at), parked = maskOf(parked_bits, at);
        const FloatM either = hn::Or(starts, parked);
        if (hn::AllFalse(d, either)) return;
        BestPack pack = load(at);
        const FloatV length = hn::IfThenElseZero(starts, exponential(pack.random.nextWhere(starts)));
        const FloatV sine = hn::Set(d, static_cast<float>(plan_.walk.sin_beam));
        const FloatV cosine = hn::Set(d, static_cast<float>(plan_.walk.cos_beam));
        pack.x = hn::IfThenElse(either, hn::Mul(length, sine), pack.x);
        pack.y = hn::IfThenZeroElse(either, pack.y);
        pack.z = hn::IfThenElse(either, hn::Mul(length, cosine), pack.z);
        if constexpr (!kIsotropic)
            pack.direction = {hn::IfThenElse(either, sine, pack.direction.u),
                              hn::IfThenZeroElse(either, pack.direction.v),
                              hn::IfThenElse(either, cosine, pack.direction.w)};
        pack.weight = hn::IfThenElse(starts, hn::Set(d, 1.0f), hn::IfThenZeroElse(parked, pack.weight));
        pack.order = hn::IfThenElse(hn::RebindMask(Int(), either), hn::Set(Int(), 1), pack.order);
        store(pack, at);
    }

    void finish(ExitTally& tally) const {
        const double albedo = 1 - plan_.walk.absorbed;
        const double scale[] = {albedo, albedo * albedo};
        for (std::size_t order = 0; order < 2; ++order) {
            ExitTally::Sums& sums = tally.sums(order == 0 ? ExitTally::single : ExitTally::multiple);
            for (std::size_t slot = 0; slot < slots_; ++slot) {
                const double weight = sums_[order * slots_ + slot];
                sums.flux[1 + slot] += scale[order] * weight;
                sums.flux[0] += scale[order] * weight;
            }
            // Moments of order 1 were counted among all.
            const double x = order == 0 ? moments_[0] : moments_[2] - moments_[0];
            const double r2 = order == 0 ? moments_[1] : moments_[3] - moments_[1];
            sums.x += scale[order] * x;
            sums.r2 += scale[order] * r2;
        }
    }

    const BestPlan& plan_;
    std::uint64_t waiting_;  // walks not yet started
    std::size_t slots_;
    std::size_t stride_;
    std::vector<float> histogram_;  // kWays x kCopies: slots of order 1, unless it is known, then those of the others
    std::vector<double> sums_;      // slots of order 1, slots of the others
    float albedo_;
    WaysOut ways_;
    std::size_t way_ = WaysOut::kCount - kLanes / kCopies;  // of the first lanes
    double moments_[4] = {};
    std::uint64_t free_ = ~std::uint64_t{0}, split_ = 0;  // one bit a lane
    std::vector<Waiting> bank_;
    BestLanes lanes_;
    BestExits exits_;
};

template <bool kFresnel, bool kIsotropic, bool kForesees>
std::uint64_t bestAs(const BestPlan& plan, SplitMix64 seeds, std::uint64_t walks, ExitTally& tally) {
    return std::make_unique<BestWalker<kFresnel, kIsotropic, kForesees>>(plan, seeds, walks)->run(tally);
}

std::uint64_t bestChunk(const BestPlan& plan, SplitMix64 seeds, std::uint64_t walks, ExitTally& tally) {
    const bool fresnel = plan.walk.eta != 1, isotropic = plan.walk.g == 0;
    if (!plan.foresees)
        return (fresnel ? bestAs<true, false, false> : bestAs<false, false, false>)(plan, seeds, walks, tally);
    return (fresnel     ? isotropic ? bestAs<true, true, true> : bestAs<true, false, true>
                : isotropic ? bestAs<false, true, true>
                        : bestAs<false, false, true>)(plan, seeds, walks, tally);
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(bestChunk);

std::uint64_t walkForeseeingChunk(const BestPlan& plan, SplitMix64 seeds, std::uint64_t walks, ExitTally& tally) {
    return HWY_DYNAMIC_DISPATCH(bestChunk)(plan, seeds, walks, tally);
}

}  // namespace searchlight
#endif
