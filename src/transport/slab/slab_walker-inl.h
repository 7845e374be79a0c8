// The analogue walk through layers, 64 at a time: half_space_walk.cpp with a surface below as well, and layers.
//
// A step that would leave its layer ends at the interface; free paths have no memory, so the walk goes on from there
// with a new one. Depths are counted from the top of the layer, so that a walk stands exactly on the interface that it
// has reached, and float is fine for the reasons given there. What a lane knows of its layer stands beside its walk and
// changes only where it crosses an interface: the step itself gathers nothing.
// Included once per instruction set.
#if defined(SEARCHLIGHT_TRANSPORT_SLAB_WALKER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_SLAB_WALKER_INL_H_
#undef SEARCHLIGHT_TRANSPORT_SLAB_WALKER_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_SLAB_WALKER_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "transport/slab/slab_control-inl.h"
#include "transport/slab/slab_depths-inl.h"
#include "transport/slab/slab_job.h"
#include "transport/slab/slab_lanes-inl.h"
#include "transport/walk/lane_foresee-inl.h"
#include "transport/walk/lane_walk-inl.h"
#include "transport/walk/long_walk.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

enum class Phase { isotropic, henyey_greenstein, any };

// Whether walks know where they are on the surfaces, or their depth alone.
enum class Knows { place, depth };

template <Phase kPhase, Knows kKnows>
class SlabWalker {
public:
    SlabWalker(const SlabJob& job, SplitMix64 seeds)
        : walk_(job.walk),
          waiting_(job.walks),
          tally_(job.tally),
          sums_(job.sums),
          crossings_at_(job.crossings),
          count_(static_cast<int>(job.walk.layers.size())),
          slots_(job.depths != nullptr ? &job.depths->slots : nullptr) {
        const SlabWalk& walk = job.walk;
        for (const SlabWalk::Layer& layer : walk.layers) {
            mfp_.push_back(static_cast<float>(layer.mfp_mm));
            thickness_.push_back(static_cast<float>(layer.thickness_mm));
            g_.push_back(static_cast<float>(layer.g));
            half_qq_.push_back(static_cast<float>(0.5 * (1 - layer.g) * (1 - layer.g)));
            table_.push_back(layer.phase.first);
            table_bins_.push_back(layer.phase.count);
            absorbed_.push_back(static_cast<std::int32_t>(std::lround(layer.absorbed * 0x1p30)));
            counted_.push_back(static_cast<std::int32_t>(std::lround(layer.counted * 0x1p30)));
            eta_.push_back(static_cast<float>(layer.eta_down));
            eta_.push_back(static_cast<float>(layer.eta_up));
        }
        seed(*from_, seeds);
        rare_ = SplitMix64(seeds.next());
        if constexpr (kKnows == Knows::depth) depths_.emplace(*job.depths);
        if (job.control == nullptr) return;
        for (const SlabControl::Layer& layer : job.control->layers) controls_.emplace_back(layer);
    }

    std::uint64_t run() {
        const std::uint64_t steps = walkAll(*this, from_, to_);
        tally_.addExits(exits_.take());
        tally_.addAbsorbed(absorptions_.take());
        tally_.addCollisions(collisions_.take());
        if constexpr (kKnows == Knows::depth) {
            depths_->flush();
            for (std::size_t slot = 0; slot < slots_->size(); ++slot) {
                const auto [index, depth] = (*slots_)[slot];
                const SlabWalk::Layer& layer = walk_.layers[index];
                tally_.addDepth(depth, depths_->weights[slot], layer.absorbed, layer.mfp_mm);
            }
        }
        for (std::size_t i = 0; i < controls_.size(); ++i)
            for (std::size_t k = 0; k < SlabControl::kSums; ++k)
                for (const float sum : controls_[i].sums[k])
                    sums_[SlabControl::kSums * i + k] += static_cast<double>(sum);
        if (crossings_at_ != nullptr) *crossings_at_ += crossings_;
        return steps - crossings_;  // a step ends in a collision or at an interface
    }

    // Walks to the next collision as if the layer had no end, and scatters. True when a walk of the pack left its
    // layer, was absorbed or has become long.
    HWY_INLINE bool advance(std::size_t at) {
        const Float d;
        const Int di;
        Pack pack = take(*from_, at);
        const FloatV length = hn::Mul(exponential(pack.random.next()), hn::Load(d, layers_.mfp + at));
        fly(pack, length);
        // 30 bits: what a smaller probability loses, below 5e-10 a collision, no sum of walks resolves.
        const hn::RebindToUnsigned<Int> du;
        const IntV chance = hn::BitCast(di, hn::ShiftRight<2>(hn::BitCast(du, pack.random.next())));
        const hn::Mask<Int> absorbed = hn::Lt(chance, hn::Load(di, layers_.absorbed + at));
        hn::Store(hn::VecFromMask(di, absorbed), di, layers_.fate + at);
        const FloatM crosses = outside(pack, at);
        if constexpr (kKnows == Knows::place) {
            const FloatM counted = hn::RebindMask(d, hn::Lt(chance, hn::Load(di, layers_.counted + at)));
            count(pack, hn::AndNot(crosses, counted), at);
        } else {
            // Parked lanes count for nothing.
            const hn::Mask<Int> walks = hn::Gt(hn::Load(di, layers_.counted + at), hn::Zero(di));
            countDepth(pack, hn::AndNot(crosses, hn::RebindMask(d, walks)), at);
        }

        turn(pack, at);
        keep(pack, *to_, at);
        const hn::Mask<Int> is_long = hn::Gt(pack.collisions, hn::Load(di, layers_.survives + at));
        return !hn::AllFalse(d, hn::Or(crosses, hn::RebindMask(d, hn::Or(absorbed, is_long))));
    }

    // What interfaces, absorption and the roulette do to the step just made; new walks in the place of those that
    // ended. Returns the number of lanes that found none.
    HWY_INLINE std::size_t settle(std::size_t at) {
        const Float d;
        const Int di;
        Pack pack = take(*to_, at);
        const FloatM crosses = outside(pack, at);
        const IntV index = hn::Load(di, layers_.index + at);
        FloatM free = hn::MaskFromVec(hn::Zero(d));
        if (!hn::AllFalse(d, crosses)) free = cross(pack, crosses, index, at);

        const FloatM collides = hn::Not(crosses);
        FloatM absorbed = hn::And(collides, hn::RebindMask(d, hn::MaskFromVec(hn::Load(di, layers_.fate + at))));
        const FloatM is_long =
            hn::And(collides, hn::RebindMask(d, hn::Gt(pack.collisions, hn::Load(di, layers_.survives + at))));
        if (!hn::AllFalse(d, is_long)) {
            const FloatM killed = rouletteLong(pack.collisions, is_long, at);
            absorbed = hn::AndNot(killed, absorbed);
            free = hn::Or(free, killed);
        }
        if (!hn::AllFalse(d, absorbed)) absorptions_.add(absorbed, pack.x, pack.y, pack.z, pack.collisions, index);
        if (absorptions_.full()) {
            tally_.addAbsorbed(absorptions_.take());
            if constexpr (kKnows == Knows::depth) depths_->flush();
        }
        free = hn::Or(free, absorbed);
        const std::size_t parked = hn::AllFalse(d, free) ? 0 : hn::CountTrue(d, free) - start(pack, free, at);
        keep(pack, *to_, at);
        return parked;
    }

    // Starts a walk in every free lane while any wait, in lane order; parks the others. Returns the number started.
    HWY_INLINE std::size_t start(Pack& pack, FloatM free, std::size_t at) {
        const Float d;
        const Int di;
        std::size_t started = hn::CountTrue(d, free);
        const bool all_start = started <= waiting_;
        if (!all_start) started = static_cast<std::size_t>(waiting_);
        waiting_ -= started;
        moveToEntry(pack, free, walk_.sin_beam, walk_.cos_beam);
        if constexpr (kKnows == Knows::place)
            if (walk_.entry.moves() || walk_.shape.kind != BeamShape::pencil) place(pack, free, started);
        enter(free, hn::Set(di, walk_.first), at);
        storeWhere(hn::RebindMask(di, free), hn::Set(di, kLongWalk), layers_.survives + at);
        if (!all_start) park(free, started, at);
        return started;
    }

private:
    static HWY_INLINE Pack take(const Lanes& lanes, std::size_t at) {
        if constexpr (kKnows == Knows::place) return load(lanes, at);
        const Float d;
        const Word dw;
        const FloatV zero = hn::Zero(d);
        return {zero,
                zero,
                hn::Load(d, lanes.z + at),
                {zero, zero, hn::Load(d, lanes.w + at)},
                hn::Load(Int(), lanes.collisions + at),
                {hn::Load(dw, lanes.s0 + at / 2), hn::Load(dw, lanes.s1 + at / 2)}};
    }

    static HWY_INLINE void keep(const Pack& pack, Lanes& lanes, std::size_t at) {
        if constexpr (kKnows == Knows::place) {
            store(pack, lanes, at);
        } else {
            const Float d;
            const Word dw;
            hn::Store(pack.z, d, lanes.z + at);
            hn::Store(pack.direction.w, d, lanes.w + at);
            hn::Store(pack.collisions, Int(), lanes.collisions + at);
            hn::Store(pack.random.s0, dw, lanes.s0 + at / 2);
            hn::Store(pack.random.s1, dw, lanes.s1 + at / 2);
        }
    }

    // Every collision, by layer and depth.
    HWY_INLINE void countDepth(const Pack& pack, FloatM collides, std::size_t at) {
        const Float d;
        const Int di;
        const IntV slot = depths_->slotAt(pack.z, hn::Load(di, layers_.index + at));
        const hn::Mask<Int> is_long = hn::Gt(pack.collisions, hn::Set(di, kLongWalk));
        if (HWY_UNLIKELY(!hn::AllFalse(di, is_long))) collides = countLong(pack.collisions, slot, collides);
        depths_->add(at, slot, collides, hn::Set(d, 1.0f));
    }

    // Counts the collisions of long walks, that came with a weight; returns the others.
    HWY_NOINLINE FloatM countLong(IntV collisions, IntV slot, FloatM collides) {
        const Float d;
        HWY_ALIGN std::int32_t count[16], to[16];
        HWY_ALIGN float others[16] = {};
        hn::Store(collisions, Int(), count);
        hn::Store(slot, Int(), to);
        forEachLane(collides, [&](std::size_t lane, std::size_t) {
            if (count[lane] <= kLongWalk)
                others[lane] = 1;
            else
                depths_->weights[static_cast<std::size_t>(to[lane])] += longWalkWeight(count[lane] - 1);
        });
        return hn::Ne(hn::Load(d, others), hn::Zero(d));
    }

    // 1 - cos of the scattering angle: of the lane's table, if it has one.
    HWY_INLINE FloatV tabulatedOr(FloatV versine, Pack& pack, std::size_t at, IntV bits) {
        const Int di;
        const IntV bins = hn::Load(di, layers_.table_bins + at), one = hn::Set(di, 1);
        const IntV alias_bits = pack.random.next();
        const FloatV table = tabulatedVersine(walk_.tables, hn::Load(di, layers_.table + at), hn::Max(bins, one), bits,
                                              alias_bits, pack.random.next());
        return hn::IfThenElse(hn::RebindMask(Float(), hn::Gt(bins, hn::Zero(di))), table, versine);
    }

    // Into the direction after a collision.
    HWY_INLINE void turn(Pack& pack, std::size_t at) {
        const Float d;
        if constexpr (kKnows == Knows::depth) {
            const IntV bits = pack.random.next();
            if constexpr (kPhase == Phase::isotropic) {
                pack.direction.w = signedUniform(bits);
                return;
            }
            FloatV versine = henyeyGreensteinVersine(hn::Load(d, layers_.g + at), hn::Load(d, layers_.half_qq + at),
                                                     signedUniform(bits));
            if constexpr (kPhase == Phase::any) versine = tabulatedOr(versine, pack, at, bits);
            const FloatV one = hn::Set(d, 1.0f), w = pack.direction.w;
            const FloatV across2 = hn::Mul(hn::Mul(versine, hn::Sub(hn::Set(d, 2.0f), versine)),
                                           hn::Max(hn::NegMulAdd(w, w, one), hn::Zero(d)));
            const FloatV cosine =
                hn::MulAdd(hn::Sqrt(across2), azimuth(pack.random.next()).cos, hn::NegMulAdd(w, versine, w));
            pack.direction.w = hn::Min(hn::Max(cosine, hn::Set(d, -1.0f)), one);
        } else if constexpr (kPhase != Phase::any) {
            scatter<kPhase == Phase::isotropic>(pack, hn::Load(d, layers_.g + at), hn::Load(d, layers_.half_qq + at));
        } else {
            const IntV bits = pack.random.next();
            const FloatV versine = henyeyGreensteinVersine(hn::Load(d, layers_.g + at),
                                                           hn::Load(d, layers_.half_qq + at), signedUniform(bits));
            const FloatV drawn = tabulatedOr(versine, pack, at, bits);
            pack.direction = turnedBy(pack.direction, drawn, azimuth(pack.random.next()));
        }
    }

    HWY_INLINE FloatM outside(const Pack& pack, std::size_t at) const {
        const Float d;
        return hn::Or(hn::Lt(pack.z, hn::Zero(d)), hn::Gt(pack.z, hn::Load(d, layers_.thickness + at)));
    }

    // Counts collisions, before a roulette that they may bring.
    HWY_INLINE void count(const Pack& pack, FloatM counted, std::size_t at) {
        if (hn::AllFalse(Float(), counted)) return;
        collisions_.add(counted, pack.x, pack.y, pack.z, pack.collisions, hn::Load(Int(), layers_.index + at));
        if (collisions_.full()) tally_.addCollisions(collisions_.take());
    }

    // Takes the walks that left their layer to the interface, where they are reflected or pass. Returns those that left
    // the slab.
    HWY_INLINE FloatM cross(Pack& pack, FloatM crosses, IntV index, std::size_t at) {
        const Float d;
        const Int di;
        const Pack before = take(*from_, at);
        const Direction& in = before.direction;
        const FloatM up = hn::Lt(in.w, hn::Zero(d));
        const hn::Mask<Int> up_i = hn::RebindMask(di, up);
        const FloatV interface = hn::IfThenZeroElse(up, hn::Load(d, layers_.thickness + at));
        const FloatV length = hn::Div(hn::Sub(interface, before.z), in.w);
        const IntV side = hn::IfThenElseZero(up_i, hn::Set(di, 1));
        const FloatV eta = hn::GatherIndex(d, eta_.data(), hn::Add(hn::Add(index, index), side));
        const Refraction ray = fresnel(hn::Abs(in.w), eta);
        const FloatM passes = hn::And(crosses, hn::Ge(uniform(pack.random.nextWhere(crosses)), ray.reflectance));

        const IntV beyond = hn::Add(index, hn::IfThenElse(up_i, hn::Set(di, -1), hn::Set(di, 1)));
        const FloatM is_out =
            hn::RebindMask(d, hn::Or(hn::Lt(beyond, hn::Zero(di)), hn::Gt(beyond, hn::Set(di, count_ - 1))));
        const FloatM leaves = hn::And(passes, is_out), enters = hn::AndNot(is_out, passes);
        if (!controls_.empty()) tellControls(before, crosses, passes, enters, index, beyond, ray.cosine, at);
        pack.x = hn::IfThenElse(crosses, hn::MulAdd(length, in.u, before.x), pack.x);
        pack.y = hn::IfThenElse(crosses, hn::MulAdd(length, in.v, before.y), pack.y);
        pack.z = hn::IfThenElse(crosses, interface, pack.z);
        pack.collisions = hn::IfThenElse(hn::RebindMask(di, crosses), before.collisions, pack.collisions);
        pack.direction.u = hn::IfThenElse(crosses, hn::IfThenElse(passes, hn::Mul(eta, in.u), in.u), pack.direction.u);
        pack.direction.v = hn::IfThenElse(crosses, hn::IfThenElse(passes, hn::Mul(eta, in.v), in.v), pack.direction.v);
        pack.direction.w = hn::IfThenElse(
            crosses, hn::IfThenElse(passes, hn::CopySign(ray.cosine, in.w), hn::Neg(in.w)), pack.direction.w);
        if (!hn::AllFalse(d, enters)) {
            enter(enters, beyond, at);
            pack.z = hn::IfThenElse(enters, hn::IfThenElseZero(up, hn::Load(d, layers_.thickness + at)), pack.z);
        }
        if (!hn::AllFalse(d, leaves)) {
            exits_.add(leaves, pack.x, pack.y, ray.cosine, pack.collisions, beyond);
            if (exits_.full()) {
                tally_.addExits(exits_.take());
                // Floats count to 2^24, and no walk is nearly so long that 1,000 of them get there in one lane.
                if constexpr (kKnows == Knows::depth) depths_->flush();
            }
        }
        crossings_ += hn::CountTrue(d, crosses);
        return leaves;
    }

    // What happens at an interface: those that pass one within the slab enter the layer beyond.
    HWY_INLINE void tellControls(const Pack& before, FloatM crosses, FloatM passes, FloatM enters, IntV index,
                                 IntV beyond, FloatV cosine_beyond, std::size_t at) {
        const Float d;
        const Int di;
        const FloatV weight = weightOf(before.collisions), w = hn::Abs(before.direction.w);
        const FloatM up = hn::Lt(before.direction.w, hn::Zero(d));
        for (LaneControl& control : controls_) {
            const hn::Mask<Int> here = hn::Eq(index, hn::Set(di, control.index));
            gain<true>(control, hn::And(crosses, hn::RebindMask(d, here)), up, passes, w, weight, at);
            const hn::Mask<Int> there = hn::Eq(beyond, hn::Set(di, control.index));
            gain<false>(control, hn::And(enters, hn::RebindMask(d, there)), up, passes, cosine_beyond, weight, at);
        }
    }

    // Puts lanes into the layer of that index.
    HWY_INLINE void enter(FloatM enters, IntV index, std::size_t at) {
        const Float d;
        const Int di;
        const hn::Mask<Int> enters_i = hn::RebindMask(di, enters);
        const IntV valid = hn::IfThenElseZero(enters_i, index);
        const auto set = [&](float* lanes, const std::vector<float>& table) HWY_ATTR {
            const FloatV old = hn::Load(d, lanes + at);
            hn::Store(hn::IfThenElse(enters, hn::GatherIndex(d, table.data(), valid), old), d, lanes + at);
        };
        set(layers_.mfp, mfp_);
        set(layers_.thickness, thickness_);
        if constexpr (kPhase != Phase::isotropic) {
            set(layers_.g, g_);
            set(layers_.half_qq, half_qq_);
        }
        if constexpr (kPhase == Phase::any) {
            storeWhere(enters_i, hn::GatherIndex(di, table_bins_.data(), valid), layers_.table_bins + at);
            storeWhere(enters_i, hn::GatherIndex(di, table_.data(), valid), layers_.table + at);
        }
        storeWhere(enters_i, hn::GatherIndex(di, absorbed_.data(), valid), layers_.absorbed + at);
        storeWhere(enters_i, hn::GatherIndex(di, counted_.data(), valid), layers_.counted + at);
        storeWhere(enters_i, index, layers_.index + at);
    }

    // Of the free lanes, those beyond the first `started` stand still from now on, in a layer without end.
    HWY_NOINLINE void park(FloatM free, std::size_t started, std::size_t at) {
        forEachLane(free, [&](std::size_t lane, std::size_t i) {
            if (i < started) return;
            layers_.mfp[at + lane] = 0;
            layers_.thickness[at + lane] = std::numeric_limits<float>::infinity();
            layers_.absorbed[at + lane] = layers_.counted[at + lane] = 0;
            layers_.survives[at + lane] = kNever;
        });
    }

    // Where walks enter their first layer that scatters or absorbs: anywhere in the beam, after reflections between
    // the clear layers above.
    HWY_NOINLINE void place(Pack& pack, FloatM free, std::size_t started) {
        const Float d;
        HWY_ALIGN float x[16] = {}, y[16] = {};
        forEachLane(free, [&](std::size_t lane, std::size_t i) {
            if (i >= started) return;
            const BeamPoint point = walk_.shape.draw(rare_, walk_.cos_incidence);
            x[lane] = static_cast<float>(point.x);
            y[lane] = static_cast<float>(point.y);
            if (walk_.entry.moves()) x[lane] += static_cast<float>(walk_.entry.draw(rare_));
        });
        pack.x = hn::IfThenElse(free, hn::Load(d, x), pack.x);
        pack.y = hn::IfThenElse(free, hn::Load(d, y), pack.y);
    }

    HWY_NOINLINE FloatM rouletteLong(IntV collisions, FloatM is_long, std::size_t at) {
        const Float d;
        HWY_ALIGN std::int32_t count[16];
        HWY_ALIGN float killed[16] = {};
        hn::Store(collisions, Int(), count);
        forEachLane(is_long, [&](std::size_t lane, std::size_t) {
            std::int32_t& survives = layers_.survives[at + lane];
            if (survives == kLongWalk) survives = longWalkSurvives(rare_);
            if (count[lane] > survives) killed[lane] = 1;
        });
        return hn::Ne(hn::Load(d, killed), hn::Zero(d));
    }

    const SlabWalk& walk_;
    std::uint64_t waiting_;  // walks not yet started
    std::uint64_t crossings_ = 0;
    SplitMix64 rare_;
    SlabTally& tally_;
    std::span<double> sums_;
    std::uint64_t* crossings_at_;
    std::int32_t count_;
    std::vector<float> mfp_, thickness_, g_, half_qq_;
    std::vector<std::int32_t> table_, table_bins_;
    std::vector<float> eta_;  // per layer: downwards, upwards
    std::vector<std::int32_t> absorbed_, counted_;
    Lanes lanes_[2];
    Lanes *from_ = &lanes_[0], *to_ = &lanes_[1];  // before and after the current step
    Layers layers_;
    std::vector<LaneControl> controls_;
    std::optional<LaneDepths> depths_;
    const std::vector<SlabDepths::Slot>* slots_;
    Ends exits_, absorptions_, collisions_;
};

template <Phase kPhase, Knows kKnows>
std::uint64_t walkAs(const SlabJob& job, SplitMix64 seeds) {
    return std::make_unique<SlabWalker<kPhase, kKnows>>(job, seeds)->run();
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
