// Ways of walks through balls, for large steps: where a walk that starts in the middle of a ball first leaves it, in
// which direction, and after how many collisions. Included once per instruction set.
//
// A step along such a way is exact, whatever g and albedo, since the three are drawn together: the ball lies in one
// medium, free paths have no memory, and a way may be turned about the direction that it starts in. The ways of a chunk
// are walked for that chunk alone, and a walk takes those that follow one another from a random one on. So a walk's
// steps are independent of each other, its law is that of a walk without large steps, and chunks stay independent: the
// ways that walks of a chunk share are part of the scatter between chunks, from which the standard errors come.
#if defined(SEARCHLIGHT_TRANSPORT_LARGE_STEPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_LARGE_STEPS_INL_H_
#undef SEARCHLIGHT_TRANSPORT_LARGE_STEPS_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_LARGE_STEPS_INL_H_
#endif

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "transport/walk/lane_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

// Radii are sqrt(2) apart: up to 64 mean free paths for g = 0, where a step stands for 2,000 collisions.
constexpr std::int32_t kBalls = 10;

// Lanes of one vector that take a step.
struct LargeStep {
    FloatV x, y, z;
    Direction direction;
    IntV collisions;
};

template <bool kIsotropic>
class LargeSteps {
public:
    /// `ways` of each radius, a power of two, are walked when they are first needed.
    LargeSteps(double sigma_t, double g, std::int32_t ways, SplitMix64 seeds) : g_(g), ways_(ways), seeds_(seeds) {
        // Steps of fewer than some 6 collisions (more where scattering turns little) cost more than they spare.
        const double least = std::sqrt(8 / (1 - std::abs(g)));
        for (std::int32_t ball = 0; ball < kBalls; ++ball) {
            radii_[ball] = least * std::pow(2, 0.5 * ball);
            radii_mm_[ball] = static_cast<float>(radii_[ball] / sigma_t);
        }
    }

    /// mm: nothing closer to the surface steps.
    float least() const { return radii_mm_[0]; }
    std::int32_t ways() const { return ways_; }

    /// Which ball fits into the clear radii. At least the least, up to rounding.
    HWY_INLINE IntV ballOf(FloatV clear) const {
        const Float d;
        const Int di;
        const FloatV ratio = hn::Mul(clear, hn::Set(d, 1 / radii_mm_[0]));
        const IntV exponent = hn::Sub(hn::ShiftRight<23>(hn::BitCast(di, hn::Mul(ratio, ratio))), hn::Set(di, 127));
        return hn::Min(hn::Max(exponent, hn::Zero(di)), hn::Set(di, kBalls - 1));
    }

    /// Walks the ways of a ball unless that is done.
    void need(std::int32_t ball) {
        if ((walked_ >> ball & 1) == 0) walk(ball);
    }

    /// On along the way `way` of a ball that has been walked, turned by an azimuth.
    HWY_INLINE void take(LargeStep& step, IntV ball, IntV way, Azimuth turn) const {
        const Float d;
        const Int di;
        const IntV at = hn::Add(hn::Mul(ball, hn::Set(di, ways_)), hn::And(way, hn::Set(di, ways_ - 1)));
        const auto read = [&](const std::vector<float>& of) { return hn::GatherIndex(d, of.data(), at); };
        const FloatV c = read(along_), u = read(u_), v = read(v_), w = read(w_);
        const FloatV s = hn::Sqrt(hn::Max(hn::NegMulAdd(c, c, hn::Set(d, 1.0f)), hn::Zero(d)));
        const Direction out = turned(step.direction, c, hn::Mul(s, turn.cos), hn::Mul(s, turn.sin));
        const FloatV radius = hn::GatherIndex(d, radii_mm_.data(), ball);
        step.x = hn::MulAdd(radius, out.u, step.x);
        step.y = hn::MulAdd(radius, out.v, step.y);
        step.z = hn::MulAdd(radius, out.w, step.z);
        step.direction = turned(step.direction, w, hn::NegMulAdd(v, turn.sin, hn::Mul(u, turn.cos)),
                                hn::MulAdd(u, turn.sin, hn::Mul(v, turn.cos)));
        step.collisions = hn::Add(step.collisions, hn::GatherIndex(di, collisions_.data(), at));
    }

private:
    HWY_NOINLINE void walk(std::int32_t ball) {
        const Float d;
        const std::size_t width = hn::Lanes(d);
        const FloatV asymmetry = hn::Set(d, static_cast<float>(g_)),
                     half_qq = hn::Set(d, static_cast<float>(0.5 * (1 - g_) * (1 - g_)));
        const auto square = static_cast<float>(radii_[ball] * radii_[ball]);
        const auto size = std::max(along_.size(), static_cast<std::size_t>(ways_) * (ball + 1));
        for (auto* list : {&along_, &u_, &v_, &w_}) list->resize(size);
        collisions_.resize(size);
        walked_ |= 1u << ball;

        auto both = std::make_unique<std::array<Lanes, 2>>();
        Lanes *from = &(*both)[0], *to = &(*both)[1];
        seed(*from, seeds_);
        std::int32_t way[kLanes], next = 0;
        std::uint64_t walking = 0;
        // A lane takes the next way when it has ended one, and no way is given up: the long ones count as the others.
        const auto start = [&](Lanes& lanes, std::size_t lane) {
            lanes.x[lane] = lanes.y[lane] = lanes.z[lane] = lanes.u[lane] = lanes.v[lane] = 0;
            lanes.w[lane] = 1;
            lanes.collisions[lane] = 0;
            way[lane] = next;
            const std::uint64_t bit = std::uint64_t{1} << lane;
            if (next++ < ways_)
                walking |= bit;
            else
                walking &= ~bit;
        };
        for (std::size_t lane = 0; lane < kLanes; ++lane) start(*from, lane);
        while (walking != 0) {
            std::uint64_t out = 0;
            for (std::size_t at = 0; at < kLanes; at += width) {
                Pack pack = load(*from, at);
                fly(pack, exponential(pack.random.next()));
                const FloatV away = hn::MulAdd(pack.x, pack.x, hn::MulAdd(pack.y, pack.y, hn::Mul(pack.z, pack.z)));
                std::uint8_t bits[8] = {};
                hn::StoreMaskBits(d, hn::Ge(away, hn::Set(d, square)), bits);
                out |= (bits[0] | static_cast<std::uint64_t>(bits[1]) << 8) << at;
                scatter<kIsotropic>(pack, asymmetry, half_qq);
                store(pack, *to, at);
            }
            for (; out != 0; out &= out - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(out));
                if (walking >> lane & 1)
                    keep(*from, lane, radii_[ball], static_cast<std::size_t>(ways_) * ball + way[lane]);
                start(*to, lane);
            }
            std::swap(from, to);
        }
    }

    // The way whose last flight begins in a lane, in the frame in which it leaves at azimuth 0.
    void keep(const Lanes& lanes, std::size_t lane, double radius, std::size_t at) {
        const double x = lanes.x[lane], y = lanes.y[lane], z = lanes.z[lane];
        const double u = lanes.u[lane], v = lanes.v[lane], w = lanes.w[lane];
        const double a = u * u + v * v + w * w, b = x * u + y * v + z * w, c = x * x + y * y + z * z - radius * radius;
        const double t = (-b + std::sqrt(std::max(0.0, b * b - a * c))) / a;
        const double ex = x + t * u, ey = y + t * v, ring = std::hypot(ex, ey);
        const double cos = ring > 0 ? ex / ring : 1, sin = ring > 0 ? ey / ring : 0;
        along_[at] = static_cast<float>(std::clamp((z + t * w) / radius, -1.0, 1.0));
        u_[at] = static_cast<float>(cos * u + sin * v);
        v_[at] = static_cast<float>(cos * v - sin * u);
        w_[at] = static_cast<float>(w);
        collisions_[at] = lanes.collisions[lane];
    }

    double g_;
    std::int32_t ways_;
    SplitMix64 seeds_;
    std::uint32_t walked_ = 0;          // a bit per ball
    std::array<double, kBalls> radii_;  // mean free paths
    std::array<float, kBalls> radii_mm_;
    // Ways, ball after ball: cosine between the start's direction and where it leaves; the direction there, u towards
    // where it leaves; collisions.
    std::vector<float> along_, u_, v_, w_;
    std::vector<std::int32_t> collisions_;
};

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
