// Straight ways out of plane layers that several collisions share: ways_out-inl.h with surfaces on both sides. Included
// once per instruction set.
#if defined(SEARCHLIGHT_TRANSPORT_SLAB_WAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_SLAB_WAYS_INL_H_
#undef SEARCHLIGHT_TRANSPORT_SLAB_WAYS_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_SLAB_WAYS_INL_H_
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/random.h"
#include "transport/slab/slab_tally.h"
#include "transport/slab/slab_walk.h"
#include "transport/walk/lane_foresee-inl.h"
#include "transport/walk/lane_scatter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

/// From every layer through one side of the slab, without a reflection: directions inside the cone that passes all
/// interfaces on the way, each uniform in cosine and azimuth, together spread evenly.
/// Entry i of layer j is at j kCount + i. The layers share their random numbers.
class SlabWays {
public:
    static constexpr std::size_t kCount = 64;

    /// up: through the top. angles: into how many the quadrant outside is cut.
    SlabWays(const SlabWalk& walk, bool up, std::size_t angles, SplitMix64& random)
        : angle(walk.layers.size() * kCount), sines_(laneBins(sineEdges(angles))), sequence_(random) {
        const std::size_t layers = walk.layers.size();
        for (std::vector<float>* field : {&path, &tau, &x, &y, &x_beyond, &y_beyond, &share, &u, &v, &w})
            field->assign(layers * kCount, 0);
        if (!up && std::isinf(walk.layers.back().thickness_mm)) return;
        from_.resize(layers);
        for (std::size_t layer = 0; layer < layers; ++layer) {
            From& from = from_[layer];
            from.per_mm = static_cast<float>(1 / walk.layers[layer].mfp_mm);
            double index = 1, least = 1;  // refractive index, in units of that of the layer
            for (std::size_t at = layer;;) {
                const SlabWalk::Layer& through = walk.layers[at];
                const double eta = up ? through.eta_up : through.eta_down;
                Leg leg{static_cast<float>(1 / index), static_cast<float>(eta), 0, 0};
                if (at != layer) {
                    leg.thickness = static_cast<float>(through.thickness_mm);
                    leg.tau = static_cast<float>(through.thickness_mm / through.mfp_mm);
                }
                from.legs.push_back(leg);
                index /= eta;
                least = std::min(least, index);
                if (at == (up ? 0 : layers - 1)) break;
                at = up ? at - 1 : at + 1;
            }
            from.critical = static_cast<float>(least < 1 ? std::sqrt((1 - least) * (1 + least)) : 0);
        }
    }

    /// The next kCount ways.
    HWY_NOINLINE void renew() {
        const Float d;
        const FloatV one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
        for (std::size_t i = 0; i < kCount; i += hn::Lanes(d)) {
            const FloatV place = hn::MulAdd(signedUniform(sequence_.draw(0)), half, half);
            const Azimuth phi = azimuth(sequence_.draw(1));
            for (std::size_t layer = 0; layer < from_.size(); ++layer) {
                const From& from = from_[layer];
                const std::size_t at = layer * kCount + i;
                const FloatV range = hn::Set(d, 1 - from.critical);
                const FloatV mu = hn::MulAdd(range, place, hn::Set(d, from.critical));
                const FloatV sine = sineOf(mu), inverse = inverseOf(mu);
                const FloatV slope = hn::Mul(sine, inverse);
                FloatV passes = one, lateral = hn::Zero(d), depth = hn::Zero(d), outside = one;
                for (const Leg& leg : from.legs) {
                    // n sin is the same in all layers.
                    const FloatV leg_sine = hn::Min(hn::Mul(sine, hn::Set(d, leg.sine)), one);
                    const FloatV cosine = sineOf(leg_sine), leg_inverse = inverseOf(cosine);
                    lateral = hn::MulAdd(hn::Set(d, leg.thickness), hn::Mul(leg_sine, leg_inverse), lateral);
                    depth = hn::MulAdd(hn::Set(d, leg.tau), leg_inverse, depth);
                    const Refraction ray = fresnel(cosine, hn::Set(d, leg.eta));
                    passes = hn::Mul(passes, hn::Sub(one, ray.reflectance));
                    outside = ray.cosine;
                }
                // The slot below the first edge is empty.
                const IntV slot = slotOf(sines_, hn::NegMulAdd(outside, outside, one));
                const IntV last = hn::Set(Int(), static_cast<int>(sines_.next_edge.size()) - 3);
                hn::StoreU(hn::Min(hn::Sub(slot, hn::Set(Int(), 1)), last), Int(), angle.data() + at);
                hn::StoreU(hn::Mul(inverse, hn::Set(d, from.per_mm)), d, path.data() + at);
                hn::StoreU(depth, d, tau.data() + at);
                hn::StoreU(hn::Mul(slope, phi.cos), d, x.data() + at);
                hn::StoreU(hn::Mul(slope, phi.sin), d, y.data() + at);
                hn::StoreU(hn::Mul(lateral, phi.cos), d, x_beyond.data() + at);
                hn::StoreU(hn::Mul(lateral, phi.sin), d, y_beyond.data() + at);
                hn::StoreU(hn::Mul(hn::Mul(half, range), passes), d, share.data() + at);
                hn::StoreU(hn::Mul(sine, phi.cos), d, u.data() + at);
                hn::StoreU(hn::Mul(sine, phi.sin), d, v.data() + at);
                hn::StoreU(mu, d, w.data() + at);
            }
        }
    }

    std::vector<float> path;          ///< optical, for each mm between the collision and the end of its layer
    std::vector<float> tau;           ///< optical, beyond that
    std::vector<float> x, y;          ///< lateral, for each mm within the layer
    std::vector<float> x_beyond;      ///< lateral, beyond it, mm
    std::vector<float> y_beyond;      ///< the other
    std::vector<float> share;         ///< of isotropically scattered light: goes that way and is not reflected
    std::vector<float> u, v, w;       ///< the direction; w is above 0 on both sides
    std::vector<std::int32_t> angle;  ///< outside: which part of the quadrant

private:
    // A layer on the way, its own first, and the interface at its far side.
    struct Leg {
        float sine;            // over that of the direction in the layer of the collision
        float eta;             // refractive index over that beyond the interface
        float thickness, tau;  // 0 in the layer of the collision
    };
    struct From {
        float critical = 0, per_mm = 0;
        std::vector<Leg> legs;
    };

    static HWY_INLINE FloatV sineOf(FloatV cosine) {
        const Float d;
        return hn::Sqrt(hn::Max(hn::NegMulAdd(cosine, cosine, hn::Set(d, 1.0f)), hn::Zero(d)));
    }
    static HWY_INLINE FloatV inverseOf(FloatV cosine) {
        const Float d;
        return hn::Div(hn::Set(d, 1.0f), hn::Max(cosine, hn::Set(d, 1e-9f)));
    }

    LaneBins sines_;
    std::vector<From> from_;
    EvenSequence sequence_;
};

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
