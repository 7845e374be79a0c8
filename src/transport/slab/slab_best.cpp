// Unbiased, with less noise than the analogue walk of slab_walk.cpp: half_space_best.cpp between two surfaces.
//
// Each collision tallies the flux that leaves on either side without another collision or a reflection, along ways out
// that 16 lanes share and their opposites. A walk that then leaves just so was counted; one that was reflected on its
// way, or comes from a layer that does not foresee, is tallied where it leaves. Of a pencil at normal incidence the
// straight ways of order 1 are known and none is tallied (slab_single.h). At the outer surfaces the reflected
// part goes on, at interfaces between layers a walk is reflected or passes.
//
// As in slab_walk.cpp a step ends at the next collision or interface, depths are counted from the top of the layer, and
// lengths are in mm.
#include "transport/slab/slab_best.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>

#include "transport/walk/long_walk.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/slab/slab_best.cpp"
#include <hwy/foreach_target.h>

#include "transport/slab/slab_best_lanes-inl.h"
#include "transport/slab/slab_depths-inl.h"
#include "transport/slab/slab_ways-inl.h"
#include "transport/walk/lane_foresee-inl.h"
#include "transport/walk/lane_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {
namespace {

constexpr float kRoulette = 0.6f;
// Up to so many collisions walks keep their weight: where little is scattered, few would be left to tell of what is
// scattered twice.
constexpr std::int32_t kUnjudged = 2;

template <bool kIsotropic, bool kLayered>
class SlabBestWalker {
public:
    SlabBestWalker(const SlabBestPlan& plan, SplitMix64 seeds, std::uint64_t walks, const SlabLead* lead)
        : plan_(plan),
          importance_(lead != nullptr ? lead->importance : plan.importance),
          lead_(lead != nullptr ? lead->rate : std::vector<float>()),
          waiting_(walks),
          slots_(plan.bins.next_edge.size()),
          stride_(3 * slots_ | 1),
          histogram_(2 * sides * kCopies * stride_),
          flux_(3 * slots_),
          angle_sums_(sides * plan.layout.angles() * kCopies),
          angle_flux_(sides * plan.layout.angles()),
          depths_(plan.depths),
          last_(static_cast<std::int32_t>(plan.walk.layers.size()) - 1),
          has_below_(!std::isinf(plan.walk.layers.back().thickness_mm)),
          ways_{{plan.walk, true, plan.layout.angles(), seeds}, {plan.walk, false, plan.layout.angles(), seeds}} {
        for (std::size_t i = 0; i < plan.walk.layers.size(); ++i) {
            const SlabWalk::Layer& layer = plan.walk.layers[i];
            const auto add = [](std::vector<float>& list, double value) { list.push_back(static_cast<float>(value)); };
            add(mfp_, layer.mfp_mm);
            add(thickness_, layer.thickness_mm);
            add(albedo_, 1 - layer.absorbed);
            add(g_, layer.g);
            add(half_qq_, 0.5 * (1 - layer.g) * (1 - layer.g));
            add(eta_, layer.eta_down);
            add(eta_, layer.eta_up);
            add(rows_per_mm_, importance_.layers[i].rows_per_mm);
            first_row_.push_back(importance_.layers[i].first_row);
            last_row_.push_back(importance_.layers[i].rows - 1);
            after_.push_back(plan.foresees[i] ? foreseen : uncounted);
        }
        std::memset(&lanes_, 0, sizeof lanes_);
        seed(lanes_, seeds);
        rare_ = SplitMix64(seeds.next());
    }

    SlabBestSums run() {
        SlabBestSums sums;
        // Depths are met by all.
        const std::size_t flush_steps =
            std::max(kFlushSteps, 2 * std::min({slots_, angle_flux_.size() / sides, depths_.weights.size()}));
        std::size_t steps = 0;
        while (const int alive = refill()) {
            sums.steps += static_cast<std::uint64_t>(alive);
            free_ = split_ = 0;
            if ((way_ += kLanes / kCopies) == SlabWays::kCount) {
                ways_[up].renew();
                if (has_below_) ways_[down].renew();
                way_ = 0;
            }
            for (std::size_t at = 0; at < kLanes; at += hn::Lanes(Float())) advance(at);
            if (exits_.count > 0) countExits();
            if (split_ != 0) splitWalks();
            if (++steps == flush_steps) {
                flush();
                steps = 0;
            }
        }
        flush();
        const auto run = [&](std::size_t from) {
            const auto begin = flux_.begin() + static_cast<std::ptrdiff_t>(from * slots_);
            return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(slots_));
        };
        sums.single = run(0);
        sums.multiple = run(1);
        sums.transmitted = run(2);
        const auto transmitted_a = angle_flux_.begin() + static_cast<std::ptrdiff_t>(plan_.layout.angles());
        sums.reflected_a.assign(angle_flux_.begin(), transmitted_a);
        sums.transmitted_a.assign(transmitted_a, angle_flux_.end());
        sums.collided = depths_.weights;
        sums.collisions = collisions_;
        return sums;
    }

private:
    // What the layer of each lane has in a list.
    static HWY_INLINE FloatV of(const std::vector<float>& list, IntV layer) {
        if constexpr (kLayered) return hn::GatherIndex(Float(), list.data(), layer);
        return hn::Set(Float(), list[0]);
    }
    static HWY_INLINE IntV of(const std::vector<std::int32_t>& list, IntV layer) {
        if constexpr (kLayered) return hn::GatherIndex(Int(), list.data(), layer);
        return hn::Set(Int(), list[0]);
    }

    // The collision of each walk that stands at one, its flight to the next or to an interface, and whether what
    // follows is worth having.
    HWY_INLINE void advance(std::size_t at) {
        const Float d;
        const Int di;
        SlabBestPack pack = load(lanes_, at);
        const FloatV luck = fineUniform(pack.random.next());
        const FloatV s = signedUniform(pack.random.next());
        const Azimuth phi = azimuth(pack.random.next());
        const hn::Mask<Int> scatters_i = hn::Eq(pack.flight, hn::Set(di, collides));
        const FloatM scatters = hn::RebindMask(d, scatters_i);
        const IntV after = of(after_, pack.layer);
        hn::Mask<Int> foresees_i = hn::And(scatters_i, hn::Eq(after, hn::Set(di, foreseen)));
        if (plan_.single) foresees_i = hn::And(foresees_i, hn::Ne(pack.order, hn::Set(di, 1)));
        const FloatM foresees = hn::RebindMask(d, foresees_i);
        if (!hn::AllFalse(d, foresees)) {
            foresee<up>(pack, foresees, pack.z, at);
            if (has_below_) foresee<down>(pack, foresees, hn::Sub(of(thickness_, pack.layer), pack.z), at);
        }
        Direction turned;
        if constexpr (kIsotropic)
            turned = isotropicDirection(s, phi);
        else
            turned = henyeyGreenstein(pack.direction, of(g_, pack.layer), of(half_qq_, pack.layer), s, phi);
        pack.direction.u = hn::IfThenElse(scatters, turned.u, pack.direction.u);
        pack.direction.v = hn::IfThenElse(scatters, turned.v, pack.direction.v);
        pack.direction.w = hn::IfThenElse(scatters, turned.w, pack.direction.w);
        pack.flight = hn::IfThenElse(scatters_i, after, pack.flight);

        FloatV length = hn::Mul(exponential(pack.random.next()), of(mfp_, pack.layer));
        if (!lead_.empty()) length = hn::Div(length, ledRate(pack));
        const FloatV x = hn::MulAdd(length, pack.direction.u, pack.x);
        const FloatV y = hn::MulAdd(length, pack.direction.v, pack.y);
        const FloatV z = hn::MulAdd(length, pack.direction.w, pack.z);
        const FloatM crosses = hn::Or(hn::Lt(z, hn::Zero(d)), hn::Gt(z, of(thickness_, pack.layer)));
        const FloatM arrives = hn::Not(crosses);
        const hn::Mask<Int> arrives_i = hn::RebindMask(di, arrives);
        if (!lead_.empty()) repay(pack, z, crosses);
        countCollision(pack, z, arrives, at);
        pack.weight = hn::IfThenElse(arrives, hn::Mul(pack.weight, of(albedo_, pack.layer)), pack.weight);
        const IntV order = hn::Min(hn::Add(pack.order, hn::Set(di, 1)), hn::Set(di, kEndlessWalk));
        pack.order = hn::IfThenElse(arrives_i, order, pack.order);
        if (!hn::AllFalse(d, crosses)) cross(pack, crosses);
        pack.x = hn::IfThenElse(arrives, x, pack.x);
        pack.y = hn::IfThenElse(arrives, y, pack.y);
        pack.z = hn::IfThenElse(arrives, z, pack.z);
        pack.flight = hn::IfThenElse(arrives_i, hn::Set(di, collides), pack.flight);

        const FloatV importance = importanceOf(pack);
        const FloatV value = hn::Mul(pack.weight, importance);
        // Reflected parts are small from the start.
        const hn::Mask<Int> judged =
            hn::Or(hn::Gt(pack.order, hn::Set(di, kUnjudged)), hn::Eq(pack.flight, hn::Set(di, uncounted)));
        const FloatM low = hn::And(hn::Lt(value, hn::Set(d, kRoulette)),
                                   hn::Or(hn::RebindMask(d, judged), hn::Le(pack.weight, hn::Zero(d))));
        const FloatM lives = hn::Lt(luck, value);
        pack.weight =
            hn::IfThenElse(low, hn::IfThenElseZero(lives, hn::Div(hn::Set(d, 1.0f), importance)), pack.weight);
        store(pack, lanes_, at);
        hn::Store(value, d, lanes_.value + at);
        collisions_ += hn::CountTrue(d, hn::And(arrives, hn::Gt(pack.weight, hn::Zero(d))));
        free_ |= bitsOf(hn::AndNot(lives, low), at);
        split_ |= bitsOf(hn::Gt(value, hn::Set(d, kSplit)), at);
    }

    // At which flights that are led end, for each of the medium.
    HWY_INLINE FloatV ledRate(const SlabBestPack& pack) const {
        return hn::NegMulAdd(of(lead_, pack.layer), pack.direction.w, hn::Set(Float(), 1.0f));
    }

    // What a flight to depth z, or to an interface, weighs for having been led.
    HWY_INLINE void repay(SlabBestPack& pack, FloatV z, FloatM crosses) const {
        const Float d;
        const FloatM rises = hn::Lt(pack.direction.w, hn::Zero(d));
        const FloatV interface = hn::IfThenZeroElse(rises, of(thickness_, pack.layer));
        const FloatV depth = hn::Sub(hn::IfThenElse(crosses, interface, z), pack.z);
        const FloatV exponent = hn::Mul(of(lead_, pack.layer), hn::Div(depth, of(mfp_, pack.layer)));
        const FloatV falls = expNegative(hn::Max(exponent, hn::Set(d, -87.0f)));
        pack.weight = hn::Mul(pack.weight, hn::IfThenElse(crosses, falls, hn::Div(falls, ledRate(pack))));
    }

    // Of every collision but the first, which is known.
    HWY_INLINE void countCollision(const SlabBestPack& pack, FloatV z, FloatM arrives, std::size_t at) {
        const FloatM counts = hn::And(arrives, hn::RebindMask(Float(), hn::Gt(pack.order, hn::Zero(Int()))));
        depths_.add(at, depths_.slotAt(z, pack.layer), counts, pack.weight);
    }

    // Tallies what leaves on one side; `depth`: to the end of the layer there.
    template <Side kSide>
    HWY_INLINE void foresee(const SlabBestPack& pack, FloatM foresees, FloatV depth, std::size_t at) {
        const Float d;
        const SlabWays& ways = ways_[kSide];
        const std::size_t way = way_ + at / kCopies;
        IntV index = hn::Set(Int(), static_cast<int>(way));
        if constexpr (kLayered)
            index = hn::Add(hn::Mul(pack.layer, hn::Set(Int(), static_cast<int>(SlabWays::kCount))), index);
        const auto get = [&](const std::vector<float>& field) HWY_ATTR {
            if constexpr (kLayered) return hn::GatherIndex(d, field.data(), index);
            return hn::Set(d, field[way]);
        };
        const FloatV tau = hn::MulAdd(depth, get(ways.path), get(ways.tau));
        const FloatV part = hn::Mul(hn::Mul(pack.weight, hn::Set(d, 0.5f)), get(ways.share));
        const FloatV leaves = hn::IfThenElseZero(foresees, hn::Mul(part, expNegative(tau)));
        const FloatV dx = hn::MulAdd(depth, get(ways.x), get(ways.x_beyond));
        const FloatV dy = hn::MulAdd(depth, get(ways.y), get(ways.y_beyond));
        FloatV one = leaves, other = leaves;
        if constexpr (!kIsotropic) {
            const FloatV across = hn::MulAdd(get(ways.u), pack.direction.u, hn::Mul(get(ways.v), pack.direction.v));
            const FloatV along = hn::Mul(kSide == up ? hn::Neg(get(ways.w)) : get(ways.w), pack.direction.w);
            const FloatV g = of(g_, pack.layer);
            one = hn::Mul(leaves, henyeyGreensteinGain(g, hn::Add(along, across)));
            other = hn::Mul(leaves, henyeyGreensteinGain(g, hn::Sub(along, across)));
        }
        float* const angles = angle_sums_.data() + (kSide == up ? 0 : angle_sums_.size() / sides);
        if constexpr (kLayered) {
            addToLanes(angles, at, hn::GatherIndex(Int(), ways.angle.data(), index), hn::Add(one, other));
        } else {
            float* const lanes = angles + static_cast<std::size_t>(ways.angle[way]) * kCopies + at % kCopies;
            hn::StoreU(hn::Add(hn::LoadU(d, lanes), hn::Add(one, other)), d, lanes);
        }
        deposit<2 * kSide>(pack, at, hn::Add(pack.x, dx), hn::Add(pack.y, dy), one);
        deposit<2 * kSide + 1>(pack, at, hn::Sub(pack.x, dx), hn::Sub(pack.y, dy), other);
    }

    template <std::size_t kWay>
    HWY_INLINE void deposit(const SlabBestPack& pack, std::size_t at, FloatV x, FloatV y, FloatV weight) {
        const Int di;
        IntV slot = slotOf(plan_.bins, hn::MulAdd(x, x, hn::Mul(y, y)));
        const auto slots = static_cast<int>(slots_);
        if constexpr (kWay < 2)
            slot = hn::Add(slot, hn::IfThenZeroElse(hn::Eq(pack.order, hn::Set(di, 1)), hn::Set(di, slots)));
        else
            slot = hn::Add(slot, hn::Set(di, 2 * slots));
        addToCopies(histogram_.data() + kWay * kCopies * stride_, stride_, at, slot, weight);
    }

    // Takes walks to the interface that they would cross, and beyond or back.
    HWY_INLINE void cross(SlabBestPack& pack, FloatM crosses) {
        const Float d;
        const Int di;
        Direction& in = pack.direction;
        const FloatM rises = hn::Lt(in.w, hn::Zero(d));
        const hn::Mask<Int> rises_i = hn::RebindMask(di, rises), crosses_i = hn::RebindMask(di, crosses);
        const FloatV interface = hn::IfThenZeroElse(rises, of(thickness_, pack.layer));
        const FloatV length = hn::Div(hn::Sub(interface, pack.z), in.w);
        const IntV side = hn::IfThenElseZero(rises_i, hn::Set(di, 1));
        const FloatV eta = hn::GatherIndex(d, eta_.data(), hn::Add(hn::Add(pack.layer, pack.layer), side));
        const Refraction ray = fresnel(hn::Abs(in.w), eta);
        const IntV beyond = hn::Add(pack.layer, hn::IfThenElse(rises_i, hn::Set(di, -1), hn::Set(di, 1)));
        pack.x = hn::IfThenElse(crosses, hn::MulAdd(length, in.u, pack.x), pack.x);
        pack.y = hn::IfThenElse(crosses, hn::MulAdd(length, in.v, pack.y), pack.y);
        pack.z = hn::IfThenElse(crosses, interface, pack.z);

        FloatM passes = hn::MaskFromVec(hn::Zero(d));
        FloatM ends = crosses;
        if constexpr (kLayered) {
            const FloatM outer =
                hn::RebindMask(d, hn::Or(hn::Lt(beyond, hn::Zero(di)), hn::Gt(beyond, hn::Set(di, last_))));
            ends = hn::And(crosses, outer);
            const FloatM within = hn::AndNot(outer, crosses);
            const FloatV chance = uniform(pack.random.nextWhere(within));
            passes = hn::And(within, hn::Ge(chance, ray.reflectance));
        }
        const FloatV reflected = hn::Mul(pack.weight, ray.reflectance);
        const FloatM counts = hn::And(ends, hn::RebindMask(d, hn::Eq(pack.flight, hn::Set(di, uncounted))));
        if (!hn::AllFalse(d, counts)) {
            storeSet(pack.x, counts, d, exits_.x + exits_.count);
            storeSet(pack.y, counts, d, exits_.y + exits_.count);
            storeSet(ray.cosine, counts, d, exits_.cosine + exits_.count);
            storeSet(hn::Sub(pack.weight, reflected), counts, d, exits_.weight + exits_.count);
            const hn::Mask<Int> counts_i = hn::RebindMask(di, counts);
            storeSet(pack.order, counts_i, di, exits_.order + exits_.count);
            storeSet(beyond, counts_i, di, exits_.beyond + exits_.count);
            exits_.count += hn::CountTrue(d, counts);
        }
        pack.weight = hn::IfThenElse(ends, reflected, pack.weight);
        const FloatM turns = hn::AndNot(passes, crosses);
        pack.flight =
            hn::IfThenElse(hn::And(crosses_i, hn::RebindMask(di, turns)), hn::Set(di, uncounted), pack.flight);
        in.u = hn::IfThenElse(passes, hn::Mul(eta, in.u), in.u);
        in.v = hn::IfThenElse(passes, hn::Mul(eta, in.v), in.v);
        in.w = hn::IfThenElse(passes, hn::CopySign(ray.cosine, in.w), hn::IfThenElse(turns, hn::Neg(in.w), in.w));
        if constexpr (kLayered) {
            pack.layer = hn::IfThenElse(hn::RebindMask(di, passes), beyond, pack.layer);
            pack.z = hn::IfThenElse(passes, hn::IfThenElseZero(rises, of(thickness_, pack.layer)), pack.z);
        }
    }

    HWY_INLINE FloatV importanceOf(const SlabBestPack& pack) const {
        const Float d;
        const Int di;
        const FloatV offset = hn::Set(d, importance_.offset);
        const FloatV square = hn::MulAdd(pack.x, pack.x, hn::MulAdd(pack.y, pack.y, offset));
        const IntV column =
            logarithmicCell<SlabImportance::kMantissaBits>(square, offset, SlabImportance::kColumns - 1);
        const IntV last = of(last_row_, pack.layer);
        // The conversion has to stay defined in a layer without end.
        const FloatV place = hn::Min(hn::Mul(pack.z, of(rows_per_mm_, pack.layer)), hn::Set(d, 1e6f));
        const IntV row = hn::Add(of(first_row_, pack.layer), hn::Min(hn::ConvertTo(di, place), last));
        const IntV index = hn::Add(hn::Mul(row, hn::Set(di, SlabImportance::kColumns)), column);
        return faded(hn::GatherIndex(d, importance_.value.data(), index), pack.order);
    }

    // Exits that no collision had foreseen.
    HWY_NOINLINE void countExits() {
        for (std::size_t i = 0; i < exits_.count; ++i) {
            const double weight = exits_.weight[i];
            const bool reflected = exits_.beyond[i] < 0;
            if (exits_.order[i] == 0) continue;  // known
            const double x = exits_.x[i], y = exits_.y[i];
            const std::size_t run = reflected ? (exits_.order[i] == 1 ? 0 : 1) : 2;
            flux_[run * slots_ + plan_.layout.row(x * x + y * y)] += weight;
            angle_flux_[(reflected ? 0 : plan_.layout.angles()) + plan_.layout.angle(exits_.cosine[i])] += weight;
        }
        exits_.count = 0;
    }

    HWY_NOINLINE void flush() {
        emptyCopies(histogram_, stride_, flux_.data(), flux_.size());
        emptyLanes(angle_sums_, angle_flux_);
        depths_.flush();
    }

    HWY_NOINLINE void splitWalks() {
        for (std::uint64_t bits = split_; bits != 0; bits &= bits - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(bits));
            const auto parts = static_cast<std::int32_t>(std::min(lanes_.value[i], kMostParts));
            lanes_.weight[i] /= static_cast<float>(parts);
            bank_.push_back({lanes_.x[i], lanes_.y[i], lanes_.z[i], lanes_.u[i], lanes_.v[i], lanes_.w[i],
                             lanes_.weight[i], lanes_.order[i], lanes_.layer[i], lanes_.flight[i], parts - 1});
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
            SlabWaiting& part = bank_.back();
            put(static_cast<std::size_t>(std::countr_zero(free)), part);
            if (--part.parts == 0) bank_.pop_back();
        }
        int parked = 0;
        for (; free != 0; free &= free - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(free));
            SlabWaiting start{0,
                              0,
                              0,
                              static_cast<float>(plan_.walk.sin_beam),
                              0,
                              static_cast<float>(plan_.walk.cos_beam),
                              0,
                              0,
                              plan_.walk.first,
                              uncounted,
                              1};
            if (waiting_ > 0) {
                --waiting_;
                start.weight = 1;
                const BeamPoint point = plan_.walk.shape.draw(rare_, plan_.walk.cos_incidence);
                start.x = static_cast<float>(point.x);
                start.y = static_cast<float>(point.y);
            } else {
                ++parked;
            }
            put(i, start);
        }
        return static_cast<int>(kLanes) - parked;
    }

    HWY_INLINE void put(std::size_t i, const SlabWaiting& walk) {
        lanes_.x[i] = walk.x, lanes_.y[i] = walk.y, lanes_.z[i] = walk.z;
        lanes_.u[i] = walk.u, lanes_.v[i] = walk.v, lanes_.w[i] = walk.w;
        lanes_.weight[i] = walk.weight;
        lanes_.order[i] = walk.order, lanes_.layer[i] = walk.layer, lanes_.flight[i] = walk.flight;
    }

    const SlabBestPlan& plan_;
    const SlabImportance& importance_;
    std::vector<float> lead_;  // per layer; empty: walks are not led
    std::uint64_t waiting_;    // walks not yet started
    std::size_t slots_, stride_;
    std::vector<float> histogram_;   // per way and lane: reflected once, more often, transmitted
    std::vector<double> flux_;       // the same
    std::vector<float> angle_sums_;  // per side and angle: kCopies
    std::vector<double> angle_flux_;
    LaneDepths depths_;
    std::int32_t last_;  // layer
    bool has_below_;
    SlabWays ways_[sides];
    std::size_t way_ = SlabWays::kCount - kLanes / kCopies;  // of the first lanes
    // Per layer.
    std::vector<float> mfp_, thickness_, albedo_, g_, half_qq_, rows_per_mm_;
    std::vector<float> eta_;  // downwards, upwards
    std::vector<std::int32_t> first_row_, last_row_, after_;
    std::uint64_t collisions_ = 0;
    std::uint64_t free_ = ~std::uint64_t{0}, split_ = 0;  // one bit a lane
    std::vector<SlabWaiting> bank_;
    SplitMix64 rare_;
    struct {
        float x[kLanes + 16], y[kLanes + 16], cosine[kLanes + 16], weight[kLanes + 16];
        std::int32_t order[kLanes + 16], beyond[kLanes + 16];
        std::size_t count = 0;
    } exits_;
    SlabBestLanes lanes_;
};

template <bool kIsotropic, bool kLayered>
SlabBestSums slabBestAs(const SlabBestPlan& plan, SplitMix64 seeds, std::uint64_t walks, const SlabLead* lead) {
    return std::make_unique<SlabBestWalker<kIsotropic, kLayered>>(plan, seeds, walks, lead)->run();
}

}  // namespace

SlabBestSums slabBestChunk(const SlabBestPlan& plan, SplitMix64 seeds, std::uint64_t walks, const SlabLead* lead) {
    const std::vector<SlabWalk::Layer>& layers = plan.walk.layers;
    const bool isotropic = std::ranges::all_of(layers, [](const SlabWalk::Layer& layer) { return layer.g == 0; });
    if (layers.size() > 1)
        return (isotropic ? slabBestAs<true, true> : slabBestAs<false, true>)(plan, seeds, walks, lead);
    return (isotropic ? slabBestAs<true, false> : slabBestAs<false, false>)(plan, seeds, walks, lead);
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(slabBestChunk);

SlabBestSums walkForeseeingSlabChunk(const SlabBestPlan& plan, SplitMix64 seeds, std::uint64_t walks,
                                     const SlabLead* lead) {
    return HWY_DYNAMIC_DISPATCH(slabBestChunk)(plan, seeds, walks, lead);
}

}  // namespace searchlight
#endif
