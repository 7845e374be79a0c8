// Ways out of a half-space that several collisions share. Included once per instruction set.
#if defined(SEARCHLIGHT_TRANSPORT_WAYS_OUT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_WAYS_OUT_INL_H_
#undef SEARCHLIGHT_TRANSPORT_WAYS_OUT_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_WAYS_OUT_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "base/random.h"
#include "transport/half_space/half_space_walk.h"
#include "transport/walk/fresnel.h"
#include "transport/walk/lane_foresee-inl.h"
#include "transport/walk/lane_scatter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

/// Directions inside the escape cone. Each is random by itself, uniform in cosine and azimuth; all together are spread
/// evenly. So what is foreseen along any of them is unbiased,
/// what is foreseen along all has little noise from them, and their roots and quotients are paid once for many
/// collisions.
class WaysOut {
public:
    static constexpr std::size_t kCount = 64;

    WaysOut(const HalfSpaceWalk& walk, SplitMix64& random)
        : critical_(static_cast<float>(criticalCosine(walk.eta))),
          eta_(static_cast<float>(walk.eta)),
          sequence_(random) {}

    /// The next kCount ways.
    HWY_NOINLINE void renew() {
        const Float d;
        const FloatV one = hn::Set(d, 1.0f), zero = hn::Zero(d), eta = hn::Set(d, eta_);
        const FloatV range = hn::Set(d, 1 - critical_);
        for (std::size_t at = 0; at < kCount; at += hn::Lanes(d)) {
            const FloatV mu =
                hn::MulAdd(range, hn::MulAdd(signedUniform(sequence_.draw(0)), hn::Set(d, 0.5f), hn::Set(d, 0.5f)),
                           hn::Set(d, critical_));
            const FloatV sine = hn::Sqrt(hn::Max(hn::NegMulAdd(mu, mu, one), zero));
            const Azimuth phi = azimuth(sequence_.draw(1));
            const FloatV inverse = hn::Div(one, hn::Max(mu, hn::Set(d, 1e-9f)));
            const FloatV across_x = hn::Mul(sine, phi.cos), across_y = hn::Mul(sine, phi.sin);
            hn::Store(inverse, d, path + at);
            hn::Store(hn::Mul(inverse, across_x), d, x + at);
            hn::Store(hn::Mul(inverse, across_y), d, y + at);
            hn::Store(across_x, d, u + at);
            hn::Store(across_y, d, v + at);
            hn::Store(mu, d, w + at);
            const FloatV passes = hn::Sub(one, fresnel(mu, eta).reflectance);
            hn::Store(hn::Mul(hn::Mul(hn::Set(d, 0.5f), range), passes), d, share + at);
        }
    }

    alignas(64) float path[kCount];   ///< to the surface from depth 1
    alignas(64) float x[kCount];      ///< lateral part of that path
    alignas(64) float y[kCount];      ///< the other
    alignas(64) float share[kCount];  ///< of isotropically scattered light: leaves by the cone, if not absorbed
    alignas(64) float u[kCount];      ///< the direction
    alignas(64) float v[kCount];      ///< of it
    alignas(64) float w[kCount];      ///< of it; positive is up

private:
    float critical_, eta_;
    EvenSequence sequence_;
};

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
