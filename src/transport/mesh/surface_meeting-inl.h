// Walks that meet a smooth surface from inside: which of them it reflects, and how. Included once per instruction set.
#if defined(SEARCHLIGHT_TRANSPORT_SURFACE_MEETING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_SURFACE_MEETING_INL_H_
#undef SEARCHLIGHT_TRANSPORT_SURFACE_MEETING_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_SURFACE_MEETING_INL_H_
#endif

#include "transport/mesh/flights.h"
#include "transport/mesh/lane_list-inl.h"
#include "transport/walk/lane_scatter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

// Beside the lists of FlightHits.
struct SurfaceMeeting {
    static constexpr std::size_t kRoom = FlightHits::kRoom;

    alignas(64) float u[kRoom] = {}, v[kRoom] = {}, w[kRoom] = {};  // the walks' directions; after reflect() those back
    alignas(64) std::int32_t bits[kRoom] = {};                      // random

    // For the vector of hits that begins at a place: a bit for each that is reflected.
    HWY_INLINE std::uint64_t reflect(const FlightHits& hits, std::size_t at, double eta) {
        const Float d;
        const FloatV x = hn::Load(d, u + at), y = hn::Load(d, v + at), z = hn::Load(d, w + at);
        const FloatV nx = hn::Load(d, hits.nx + at), ny = hn::Load(d, hits.ny + at), nz = hn::Load(d, hits.nz + at);
        const FloatV cosine = hn::MulAdd(x, nx, hn::MulAdd(y, ny, hn::Mul(z, nz)));
        const FloatV twice = hn::Add(cosine, cosine);
        const FloatV rx = hn::NegMulAdd(twice, nx, x), ry = hn::NegMulAdd(twice, ny, y),
                     rz = hn::NegMulAdd(twice, nz, z);
        // One Newton step holds the length at 1.
        const FloatV square = hn::MulAdd(rx, rx, hn::MulAdd(ry, ry, hn::Mul(rz, rz)));
        const FloatV mend = hn::NegMulAdd(hn::Set(d, 0.5f), square, hn::Set(d, 1.5f));
        hn::Store(hn::Mul(rx, mend), d, u + at);
        hn::Store(hn::Mul(ry, mend), d, v + at);
        hn::Store(hn::Mul(rz, mend), d, w + at);
        if (eta == 1) return 0;
        const FloatV clamped = hn::Min(hn::Max(cosine, hn::Zero(d)), hn::Set(d, 1.0f));
        const Refraction refraction = fresnel(clamped, hn::Set(d, static_cast<float>(eta)));
        // Rounding must not let out what is reflected totally.
        const FloatM total = hn::Eq(refraction.cosine, hn::Zero(d));
        return bitsOf(hn::Or(total, hn::Lt(uniform(hn::Load(Int(), bits + at)), refraction.reflectance)));
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
