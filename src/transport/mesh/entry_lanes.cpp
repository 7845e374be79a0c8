#include "transport/mesh/entry_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/mesh/entry_lanes.cpp"
#include <hwy/foreach_target.h>

#include "transport/mesh/lane_list-inl.h"
#include "transport/walk/lane_scatter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

void drawDiffuseLanes(EntryLanes& lanes, const std::int32_t* heights, const std::int32_t* turns) {
    const Float d;
    for (std::size_t at = 0; at < lanes.count; at += hn::Lanes(d)) {
        const FloatV square = uniform(hn::Load(Int(), heights + at));
        const FloatV ring = hn::Sqrt(square), cosine = hn::Sqrt(hn::Sub(hn::Set(d, 1.0f), square));
        const Azimuth turn = azimuth(hn::Load(Int(), turns + at));
        const Direction normal{hn::Load(d, lanes.nx + at), hn::Load(d, lanes.ny + at), hn::Load(d, lanes.nz + at)};
        const Direction wi = turned(normal, cosine, hn::Mul(ring, turn.cos), hn::Mul(ring, turn.sin));
        hn::Store(wi.u, d, lanes.wx + at), hn::Store(wi.v, d, lanes.wy + at), hn::Store(wi.w, d, lanes.wz + at);
    }
}

void refractInwardsLanes(EntryLanes& lanes, double eta) {
    const Float d;
    const FloatV zero = hn::Zero(d), inverse = hn::Set(d, static_cast<float>(1 / eta));
    lanes.enters = 0;
    for (std::size_t at = 0; at < lanes.count; at += hn::Lanes(d)) {
        const FloatV nx = hn::Load(d, lanes.nx + at), ny = hn::Load(d, lanes.ny + at), nz = hn::Load(d, lanes.nz + at);
        const FloatV wx = hn::Load(d, lanes.wx + at), wy = hn::Load(d, lanes.wy + at), wz = hn::Load(d, lanes.wz + at);
        const FloatV c = hn::MulAdd(wx, nx, hn::MulAdd(wy, ny, hn::Mul(wz, nz)));
        FloatM enters = hn::And(hn::Gt(c, zero), hn::FirstN(d, lanes.count - at));
        FloatV x = hn::Neg(wx), y = hn::Neg(wy), z = hn::Neg(wz);
        if (eta != 1) {
            const Refraction refraction = fresnel(hn::Min(c, hn::Set(d, 1.0f)), inverse);
            enters = hn::And(enters, hn::Ge(uniform(hn::Load(Int(), lanes.bits + at)), refraction.reflectance));
            const FloatV along = hn::MulSub(c, inverse, refraction.cosine);
            x = hn::MulAdd(x, inverse, hn::Mul(along, nx));
            y = hn::MulAdd(y, inverse, hn::Mul(along, ny));
            z = hn::MulAdd(z, inverse, hn::Mul(along, nz));
            const FloatV square = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
            const FloatV mend = hn::NegMulAdd(hn::Set(d, 0.5f), square, hn::Set(d, 1.5f));
            x = hn::Mul(x, mend), y = hn::Mul(y, mend), z = hn::Mul(z, mend);
        }
        hn::Store(x, d, lanes.dx + at), hn::Store(y, d, lanes.dy + at), hn::Store(z, d, lanes.dz + at);
        lanes.enters |= bitsOf(enters) << at;
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(drawDiffuseLanes);
HWY_EXPORT(refractInwardsLanes);

void drawDiffuse(EntryLanes& lanes, const std::int32_t* heights, const std::int32_t* turns) {
    HWY_DYNAMIC_DISPATCH(drawDiffuseLanes)(lanes, heights, turns);
}

void refractInwards(EntryLanes& lanes, double eta) { HWY_DYNAMIC_DISPATCH(refractInwardsLanes)(lanes, eta); }

}  // namespace searchlight
#endif
