// Directions and reflection on float lanes: what every walk with a Henyey-Greenstein phase function and a smooth
// surface does. Included once per instruction set.
#if defined(SEARCHLIGHT_TRANSPORT_LANE_SCATTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_LANE_SCATTER_INL_H_
#undef SEARCHLIGHT_TRANSPORT_LANE_SCATTER_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_LANE_SCATTER_INL_H_
#endif

#include "transport/walk/lane_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

struct Direction {
    FloatV u, v, w;
};

/// Uniform on the sphere; s in [-1, 1] becomes w.
HWY_INLINE Direction isotropicDirection(FloatV s, Azimuth phi) {
    const Float d;
    const FloatV sine = hn::Sqrt(hn::Max(hn::NegMulAdd(s, s, hn::Set(d, 1.0f)), hn::Zero(d)));
    return {hn::Mul(sine, phi.cos), hn::Mul(sine, phi.sin), s};
}

/// Turns a unit vector by the polar cosine c and the transverse components a, b: the frame of [Duff2017].
HWY_INLINE Direction turned(const Direction& from, FloatV c, FloatV a, FloatV b) {
    const Float d;
    const FloatV one = hn::Set(d, 1.0f);
    const auto [u, v, w] = from;
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
    return {hn::Mul(nu, mend), hn::Mul(nv, mend), hn::Mul(nw, mend)};
}

/// [HenyeyGreenstein1941] by inversion, s uniform in [-1, 1]; half_qq = (1 - g)^2 / 2. m = 1 - cos is written without
/// differences of near numbers, for g near 0 and near 1.
HWY_INLINE Direction henyeyGreenstein(const Direction& from, FloatV g, FloatV half_qq, FloatV s, Azimuth phi) {
    const Float d;
    const FloatV one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f);
    const FloatV p = hn::MulAdd(g, s, one);
    const FloatV numerator = hn::Mul(hn::Mul(half_qq, hn::Sub(one, s)), hn::Add(hn::Add(one, g), p));
    const FloatV m = hn::Min(hn::Div(numerator, hn::Mul(p, p)), two);
    const FloatV sine = hn::Sqrt(hn::Mul(m, hn::Sub(two, m)));
    return turned(from, hn::Sub(one, m), hn::Mul(sine, phi.cos), hn::Mul(sine, phi.sin));
}

struct Refraction {
    FloatV reflectance;  ///< unpolarised; 1 under total reflection
    FloatV cosine;       ///< of the refracted direction; 0 under total reflection
};

/// A ray that meets a smooth interface under the cosine c; eta: index before it over the index behind it. Lanes with
/// c <= 0 hold nonsense.
HWY_INLINE Refraction fresnel(FloatV c, FloatV eta) {
    const Float d;
    const FloatV one = hn::Set(d, 1.0f);
    const FloatV sine2 = hn::NegMulAdd(c, c, one);
    const FloatV t = hn::Sqrt(hn::Max(hn::NegMulAdd(hn::Mul(eta, eta), sine2, one), hn::Zero(d)));
    const FloatV eta_c = hn::Mul(eta, c), eta_t = hn::Mul(eta, t);
    const FloatV s = hn::Div(hn::Sub(eta_c, t), hn::Add(eta_c, t));
    const FloatV p = hn::Div(hn::Sub(c, eta_t), hn::Add(c, eta_t));
    return {hn::Mul(hn::Set(d, 0.5f), hn::MulAdd(s, s, hn::Mul(p, p))), t};
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
