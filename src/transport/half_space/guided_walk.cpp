// Every walk ends by leaving: absorption, and the preference for the way up, are in its weight.
//
// weight(z) exp(-kappa z) is what a lane carries: a flight from z to z' along w has density (1 + kappa w) exp(-(1 +
// kappa w) s) instead of exp(-s), and the quotient is exp(kappa (z' - z)) / (1 + kappa w). At the surface, z = 0, it is
// the weight itself.
//
// With isotropic scattering the azimuths of a walk are independent: the mean of r^2 over them is the sum of the squared
// lateral steps, and x stays where the beam put it. Such walks know z alone.
//
// Moments have controls. With v = (-i k, 0, q), q^2 = kappa^2 + k^2, exp(-v r) psi(v Omega / kappa) is what a walk is
// worth to some end, exactly: its change along a walk has mean 0, and so have those of its derivatives by k,
//   V1 = exp(-kappa z) [x psi - (u / kappa) psi'],
//   V2 = exp(-kappa z) [(r^2 + 2 z / kappa) psi - (2 / kappa) (x u + y v + w / kappa) psi' + (1 - w^2) / kappa^2
//   psi''],
// psi at w. What they lose where a walk leaves or is reflected is known on average: their values at the entry. Nearly
// all of it is x and r^2 there. With isotropic scattering psi = 1 / (1 + kappa w), and the mean of x u + y v over
// azimuths is the last flight's share.
#include "transport/half_space/guided_walk.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "transport/walk/long_walk.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/half_space/guided_walk.cpp"
#include <hwy/foreach_target.h>

#include "transport/walk/lane_foresee-inl.h"
#include "transport/walk/lane_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

struct alignas(64) GuidedLanes {
    float x[kLanes], y[kLanes], z[kLanes];  // isotropic: x is the last flight, y is r^2 so far
    float u[kLanes], v[kLanes], w[kLanes];  // direction before the collision to come; isotropic: u is the mean x
    float weight[kLanes];                   // times exp(-kappa z)
    float lost_x[kLanes], lost_r2[kLanes];  // of V1 and V2 so far
    std::int32_t order[kLanes];
    std::uint64_t s0[kLanes / 2], s1[kLanes / 2];
};

template <bool kFresnel, bool kIsotropic>
class GuidedWalker {
public:
    GuidedWalker(const GuidedWalk& guided, SplitMix64 seeds, std::uint64_t walks, const RadialBins* bins,
                 ExitTally* tally)
        : guided_(guided),
          waiting_(walks),
          bins_(bins),
          tally_(tally),
          albedo_(static_cast<float>(1 - guided.walk.absorbed)) {
        std::memset(&lanes_, 0, sizeof lanes_);
        seed(lanes_, seeds);
        scalar_ = SplitMix64(seeds.next());
    }

    GuidedSums run() {
        while (refill()) {
            free_ = 0;
            std::uint64_t events = 0;
            for (std::size_t at = 0; at < kLanes; at += hn::Lanes(Float()))
                events |= static_cast<std::uint64_t>(advance(at)) << (at / kPackLanes);
            for (; events != 0; events &= events - 1)
                settle(static_cast<std::size_t>(std::countr_zero(events)) * kPackLanes);
            flush();
            if (HWY_UNLIKELY(++steps_ > kLongWalk)) rouletteLong();
        }
        return sums_;
    }

private:
    static HWY_INLINE FloatV set(double value) { return hn::Set(Float(), static_cast<float>(value)); }

    static HWY_INLINE FloatV series(const std::array<double, 4>& powers, FloatV w) {
        FloatV p = set(powers[3]);
        for (std::size_t i = 3; i-- > 0;) p = hn::MulAdd(p, w, set(powers[i]));
        return p;
    }

    // Proposes a direction to each walk; those that take it scatter and fly on as if there were no surface, the others
    // wait for the next proposal. True when a walk of the pack crossed the surface.
    HWY_INLINE bool advance(std::size_t at) {
        const Float d;
        const Int di;
        const Word dw;
        const FloatV zero = hn::Zero(d), one = hn::Set(d, 1.0f);
        Generator random{hn::Load(dw, lanes_.s0 + at / 2), hn::Load(dw, lanes_.s1 + at / 2)};
        const FloatV s = signedUniform(random.next());
        Direction from{zero, zero, hn::Load(d, lanes_.w + at)}, to{zero, zero, s};
        if constexpr (!kIsotropic) {
            from.u = hn::Load(d, lanes_.u + at);
            from.v = hn::Load(d, lanes_.v + at);
            const double g = guided_.walk.g;
            to = henyeyGreenstein(from, set(g), set(0.5 * (1 - g) * (1 - g)), s, azimuth(random.next()));
        }
        const FloatV psi = series(guided_.psi, to.w);
        const FloatV luck = hn::Mul(uniform(random.next()), set(guided_.most));
        const FloatM takes = hn::Lt(luck, psi);
        const FloatV rate = hn::MulAdd(set(guided_.kappa), to.w, one);
        const FloatV inverse = hn::Div(one, hn::Mul(rate, psi));  // one division for both
        const FloatV old_weight = hn::Load(d, lanes_.weight + at);
        FloatV weight = hn::Mul(hn::Mul(old_weight, hn::Set(d, albedo_)), inverse);
        if constexpr (!kIsotropic) weight = hn::Mul(weight, series(guided_.after, from.w));
        const FloatV length = hn::IfThenElseZero(takes, hn::Mul(exponential(random.next()), hn::Mul(psi, inverse)));
        const FloatV z = hn::MulAdd(length, to.w, hn::Load(d, lanes_.z + at));
        if constexpr (kIsotropic) {
            hn::Store(length, d, lanes_.x + at);
            const FloatV sine2 = hn::NegMulAdd(to.w, to.w, one);
            hn::Store(hn::MulAdd(hn::Mul(length, length), sine2, hn::Load(d, lanes_.y + at)), d, lanes_.y + at);
        } else {
            hn::Store(hn::MulAdd(length, to.u, hn::Load(d, lanes_.x + at)), d, lanes_.x + at);
            hn::Store(hn::MulAdd(length, to.v, hn::Load(d, lanes_.y + at)), d, lanes_.y + at);
            hn::Store(hn::IfThenElse(takes, to.u, from.u), d, lanes_.u + at);
            hn::Store(hn::IfThenElse(takes, to.v, from.v), d, lanes_.v + at);
        }
        hn::Store(z, d, lanes_.z + at);
        hn::Store(hn::IfThenElse(takes, to.w, from.w), d, lanes_.w + at);
        hn::Store(hn::IfThenElse(takes, weight, old_weight), d, lanes_.weight + at);
        const IntV scattered = hn::VecFromMask(di, hn::RebindMask(di, takes));
        const IntV order = hn::Add(hn::Load(di, lanes_.order + at), scattered);
        hn::Store(hn::Max(order, hn::Set(di, -kEndlessWalk)), di, lanes_.order + at);
        hn::Store(random.s0, dw, lanes_.s0 + at / 2);
        hn::Store(random.s1, dw, lanes_.s1 + at / 2);
        return !hn::AllFalse(d, hn::Lt(z, zero));
    }

    // What the surface does to the flights that crossed it: they leave there, or go on below it at another rate.
    HWY_INLINE void settle(std::size_t at) {
        const Float d;
        const Word dw;
        const FloatV zero = hn::Zero(d), one = hn::Set(d, 1.0f), kappa = set(guided_.kappa);
        const FloatV z = hn::Load(d, lanes_.z + at), w = hn::Load(d, lanes_.w + at);
        const FloatM crosses = hn::Lt(z, zero);
        const FloatV up = hn::Neg(w), beyond = hn::IfThenElseZero(crosses, hn::Div(z, w));
        const FloatV rate = hn::MulAdd(kappa, w, one), inward_rate = hn::MulAdd(kappa, up, one);
        FloatM leaves = crosses;
        FloatV rest = zero;
        if constexpr (kFresnel) {
            Generator random{hn::Load(dw, lanes_.s0 + at / 2), hn::Load(dw, lanes_.s1 + at / 2)};
            const FloatV chance = uniform(random.nextWhere(crosses));
            hn::Store(random.s0, dw, lanes_.s0 + at / 2);
            hn::Store(random.s1, dw, lanes_.s1 + at / 2);
            leaves = hn::And(crosses, hn::Ge(chance, fresnel(up, set(guided_.walk.eta)).reflectance));
            rest = hn::IfThenElse(leaves, zero, hn::Div(hn::Mul(beyond, rate), inward_rate));
        }
        const FloatV weight = hn::Load(d, lanes_.weight + at), at_surface = hn::Mul(weight, rate);
        const FloatV change = hn::Sub(rest, beyond);  // of the length
        FloatV x = hn::Load(d, lanes_.x + at), y = hn::Load(d, lanes_.y + at);
        const FloatV onward = hn::Div(at_surface, inward_rate);
        if constexpr (kIsotropic) {
            const FloatV sine2 = hn::NegMulAdd(w, w, one), two = hn::Set(d, 2.0f);
            // r^2 after the first `length + change` of the flight in place of all.
            const auto after = [&](FloatV by)
                                   HWY_ATTR { return hn::MulAdd(hn::Mul(by, hn::MulAdd(two, x, by)), sine2, y); };
            const FloatV surface = after(hn::Neg(beyond)), flight = hn::Sub(x, beyond);
            const FloatV slope = set(guided_.inverse_kappa);
            const auto value = [&](FloatV weight_psi, FloatV psi, FloatV cosine) HWY_ATTR {
                const FloatV lateral = hn::Mul(sine2, hn::Add(flight, psi));
                return hn::Mul(weight_psi, hn::MulAdd(hn::Add(psi, psi), hn::MulAdd(cosine, slope, lateral), surface));
            };
            FloatV loss = value(weight, hn::Div(one, rate), w);
            if constexpr (kFresnel)
                loss = hn::Sub(loss, hn::IfThenZeroElse(leaves, value(onward, hn::Div(one, inward_rate), up)));
            lose(crosses, loss, lanes_.lost_r2 + at);
            y = after(change);
        } else {
            const FloatV u = hn::Load(d, lanes_.u + at), v = hn::Load(d, lanes_.v + at);
            if (guided_.inverse_kappa > 0)
                loseMoments(at, crosses, leaves, at_surface, hn::NegMulAdd(beyond, u, x), hn::NegMulAdd(beyond, v, y));
            x = hn::MulAdd(change, u, x);
            y = hn::MulAdd(change, v, y);
            hn::Store(x, d, lanes_.x + at);
        }
        hn::Store(y, d, lanes_.y + at);
        hn::Store(hn::IfThenElse(crosses, hn::Mul(rest, up), z), d, lanes_.z + at);
        hn::Store(hn::IfThenElse(crosses, up, w), d, lanes_.w + at);
        hn::Store(hn::IfThenElse(crosses, onward, weight), d, lanes_.weight + at);
        if (hn::AllFalse(d, leaves)) return;
        storeSet(at_surface, leaves, d, exits_.weight + exits_.count);
        storeSet(kIsotropic ? hn::Load(d, lanes_.u + at) : x, leaves, d, exits_.x + exits_.count);
        storeSet(y, leaves, d, exits_.y + exits_.count);
        storeSet(hn::Load(d, lanes_.lost_x + at), leaves, d, exits_.lost_x + exits_.count);
        storeSet(hn::Load(d, lanes_.lost_r2 + at), leaves, d, exits_.lost_r2 + exits_.count);
        storeSet(hn::Load(Int(), lanes_.order + at), hn::RebindMask(Int(), leaves), Int(), exits_.order + exits_.count);
        exits_.count += hn::CountTrue(d, leaves);
        free_ |= bitsOf(leaves, at);
    }

    static HWY_INLINE void lose(FloatM where, FloatV what, float* lost) {
        const Float d;
        hn::Store(hn::Add(hn::Load(d, lost), hn::IfThenElseZero(where, what)), d, lost);
    }

    // What V1 and V2 lose at (x, y) of the surface.
    HWY_INLINE void loseMoments(std::size_t at, FloatM crosses, FloatM leaves, FloatV weight, FloatV x, FloatV y) {
        const Float d;
        const FloatV u = hn::Load(d, lanes_.u + at), v = hn::Load(d, lanes_.v + at), w = hn::Load(d, lanes_.w + at);
        const FloatV w2 = hn::Mul(w, w), sine2 = hn::Sub(hn::Set(d, 1.0f), w2), per = set(guided_.inverse_kappa);
        // psi and its derivatives: terms of even and of odd powers of w, which also make up those at -w.
        FloatV even[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)}, odd[3] = {even[0], even[0], even[0]};
        for (std::size_t i = guided_.exact[0].size(); i > 0; i -= 2)
            for (std::size_t k = 0; k < 3; ++k) {
                odd[k] = hn::MulAdd(odd[k], w2, hn::Set(d, guided_.exact[k][i - 1]));
                even[k] = hn::MulAdd(even[k], w2, hn::Set(d, guided_.exact[k][i - 2]));
            }
        const FloatV r2 = hn::MulAdd(x, x, hn::Mul(y, y)), radial = hn::MulAdd(x, u, hn::Mul(y, v));
        const auto value = [&](FloatV cosine, const FloatV(&psi)[3], FloatV& first, FloatV& second) HWY_ATTR {
            const FloatV slope = hn::Mul(per, psi[1]);
            first = hn::NegMulAdd(u, slope, hn::Mul(x, psi[0]));
            const FloatV turned = hn::MulAdd(cosine, per, radial);
            second = hn::NegMulAdd(hn::Add(turned, turned), slope, hn::Mul(r2, psi[0]));
            second = hn::MulAdd(hn::Mul(sine2, hn::Mul(per, per)), psi[2], second);
        };
        FloatV psi[3], first, second;
        for (std::size_t k = 0; k < 3; ++k) psi[k] = hn::MulAdd(odd[k], w, even[k]);
        value(w, psi, first, second);
        if constexpr (kFresnel) {
            FloatV first_on, second_on;
            for (std::size_t k = 0; k < 3; ++k) psi[k] = hn::NegMulAdd(odd[k], w, even[k]);
            value(hn::Neg(w), psi, first_on, second_on);
            first = hn::Sub(first, hn::IfThenZeroElse(leaves, first_on));
            second = hn::Sub(second, hn::IfThenZeroElse(leaves, second_on));
        }
        lose(crosses, hn::Mul(weight, first), lanes_.lost_x + at);
        lose(crosses, hn::Mul(weight, second), lanes_.lost_r2 + at);
    }

    HWY_INLINE void flush() {
        for (std::size_t i = 0; i < exits_.count; ++i) {
            const double weight = exits_.weight[i], x = exits_.x[i], y = exits_.y[i];
            sums_.total += weight;
            sums_.x += weight * x;
            sums_.r2 += weight * (kIsotropic ? y : x * x + y * y);
            sums_.x_control += static_cast<double>(exits_.lost_x[i]) - guided_.x_control;
            sums_.r2_control += static_cast<double>(exits_.lost_r2[i]) - guided_.r2_control;
        }
        if constexpr (!kIsotropic)
            if (tally_ != nullptr) addTo(*tally_);
        exits_.count = 0;
    }

    HWY_NOINLINE void addTo(ExitTally& tally) const {
        for (std::size_t i = 0; i < exits_.count; ++i) {
            const double weight = exits_.weight[i], x = exits_.x[i], y = exits_.y[i], r2 = x * x + y * y;
            ExitTally::Sums& sums = tally.sums(exits_.order[i] == -1 ? ExitTally::single : ExitTally::multiple);
            sums.flux[0] += weight;
            sums.x += weight * x;
            sums.r2 += weight * r2;
            sums.flux[1 + bins_->slot(r2)] += weight;
        }
    }

    // As longWalkWeight(): without absorption nothing leads walks back.
    HWY_NOINLINE void rouletteLong() {
        for (std::size_t i = 0; i < kLanes; ++i) {
            const double n = -static_cast<double>(lanes_.order[i]);
            if (n <= kLongWalk || lanes_.weight[i] == 0 || (free_ >> i & 1) != 0) continue;
            lanes_.weight[i] *= static_cast<float>(n / (n - 1));
            if (n * scalar_.uniform() < 1) free_ |= std::uint64_t{1} << i;
        }
    }

    HWY_INLINE bool refill() { return free_ == 0 || refillFree(); }

    // Puts new walks into free lanes, while there are any. Orders count down from 0.
    HWY_NOINLINE bool refillFree() {
        std::uint64_t starts = 0;
        for (std::uint64_t bits = free_; bits != 0; bits &= bits - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(bits));
            sums_.collisions -= static_cast<std::uint64_t>(static_cast<std::int64_t>(lanes_.order[i]));
            if (waiting_ == 0) continue;
            --waiting_;
            starts |= bits & -bits;
        }
        walking_ = walking_ + static_cast<std::uint64_t>(std::popcount(starts)) -
                   static_cast<std::uint64_t>(std::popcount(free_));
        for (std::size_t at = 0; at < kLanes; at += hn::Lanes(Float()))
            start(maskOf(starts, at), maskOf(free_, at), at);
        return walking_ > 0;
    }

    // New walks stand before their first collision; free lanes without one weigh nothing and are parked far below.
    HWY_INLINE void start(FloatM starts, FloatM free, std::size_t at) {
        const Float d;
        if (hn::AllFalse(d, free)) return;
        const Word dw;
        const double rate = 1 + guided_.kappa * guided_.walk.cos_beam;
        const FloatV sine = set(guided_.walk.sin_beam), cosine = set(guided_.walk.cos_beam);
        Generator random{hn::Load(dw, lanes_.s0 + at / 2), hn::Load(dw, lanes_.s1 + at / 2)};
        const FloatV length = hn::Mul(exponential(random.nextWhere(starts)), set(1 / rate));
        hn::Store(random.s0, dw, lanes_.s0 + at / 2);
        hn::Store(random.s1, dw, lanes_.s1 + at / 2);
        const auto put = [&](FloatV value, float* lanes) {
            hn::Store(hn::IfThenElse(free, value, hn::Load(d, lanes + at)), d, lanes + at);
        };
        const FloatV x = hn::Mul(length, sine);
        put(x, lanes_.x);
        put(kIsotropic ? hn::Mul(x, x) : hn::Zero(d), lanes_.y);
        put(hn::IfThenElse(starts, hn::Mul(length, cosine), hn::Set(d, 1e30f)), lanes_.z);
        put(kIsotropic ? x : sine, lanes_.u);
        put(hn::Zero(d), lanes_.v);
        put(hn::Zero(d), lanes_.lost_x);
        put(hn::Zero(d), lanes_.lost_r2);
        put(cosine, lanes_.w);
        put(hn::IfThenElseZero(starts, set(1 / rate)), lanes_.weight);
        storeWhere(hn::RebindMask(Int(), free), hn::Zero(Int()), lanes_.order + at);
    }

    const GuidedWalk& guided_;
    std::uint64_t waiting_;   // walks not yet started
    const RadialBins* bins_;  // with a tally, or null
    ExitTally* tally_;
    std::uint64_t walking_ = kLanes;
    float albedo_;
    std::uint64_t free_ = ~std::uint64_t{0};  // one bit a lane
    std::int64_t steps_ = 0;
    SplitMix64 scalar_;  // for what is rare
    GuidedSums sums_;
    GuidedLanes lanes_;
    struct {
        float weight[kLanes + 16], x[kLanes + 16], y[kLanes + 16], lost_x[kLanes + 16], lost_r2[kLanes + 16];
        std::int32_t order[kLanes + 16];
        std::size_t count = 0;
    } exits_;
};

template <bool kFresnel, bool kIsotropic>
GuidedSums guidedAs(const GuidedWalk& guided, SplitMix64 seeds, std::uint64_t walks, const RadialBins* bins,
                    ExitTally* tally) {
    return std::make_unique<GuidedWalker<kFresnel, kIsotropic>>(guided, seeds, walks, bins, tally)->run();
}

GuidedSums guidedChunk(const GuidedWalk& guided, SplitMix64 seeds, std::uint64_t walks, const RadialBins* bins,
                       ExitTally* tally) {
    const bool fresnel = guided.walk.eta != 1, isotropic = guided.walk.g == 0;
    return (fresnel     ? isotropic ? guidedAs<true, true> : guidedAs<true, false>
                : isotropic ? guidedAs<false, true>
                        : guidedAs<false, false>)(guided, seeds, walks, bins, tally);
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(guidedChunk);

GuidedSums walkGuidedChunk(const GuidedWalk& guided, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks) {
    return HWY_DYNAMIC_DISPATCH(guidedChunk)(guided, streamOf(seed, chunk), walks, nullptr, nullptr);
}

GuidedSums walkGuidedChunk(const GuidedWalk& guided, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                           const RadialBins& bins, ExitTally& tally) {
    return HWY_DYNAMIC_DISPATCH(guidedChunk)(guided, streamOf(seed, chunk), walks, &bins, &tally);
}

}  // namespace searchlight
#endif
