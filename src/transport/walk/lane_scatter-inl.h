// Directions and reflection on float lanes: phase functions, and a smooth surface. Included once per instruction set.
#if defined(SEARCHLIGHT_TRANSPORT_LANE_SCATTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_LANE_SCATTER_INL_H_
#undef SEARCHLIGHT_TRANSPORT_LANE_SCATTER_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_LANE_SCATTER_INL_H_
#endif

#include "transport/walk/lane_math-inl.h"
#include "transport/walk/phase_function.h"

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

/// Turns a direction by the angle whose 1 - cos is m.
HWY_INLINE Direction turnedBy(const Direction& from, FloatV m, Azimuth phi) {
    const Float d;
    const FloatV sine = hn::Sqrt(hn::Mul(m, hn::Sub(hn::Set(d, 2.0f), m)));
    return turned(from, hn::Sub(hn::Set(d, 1.0f), m), hn::Mul(sine, phi.cos), hn::Mul(sine, phi.sin));
}

/// 1 - cos of a scattering angle of [HenyeyGreenstein1941] by inversion, s uniform in [-1, 1]; half_qq = (1 - g)^2 / 2.
/// Written without differences of near numbers, for g near 0 and near 1.
HWY_INLINE FloatV henyeyGreensteinVersine(FloatV g, FloatV half_qq, FloatV s) {
    const Float d;
    const FloatV one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f);
    const FloatV p = hn::MulAdd(g, s, one);
    const FloatV numerator = hn::Mul(hn::Mul(half_qq, hn::Sub(one, s)), hn::Add(hn::Add(one, g), p));
    return hn::Min(hn::Div(numerator, hn::Mul(p, p)), two);
}

HWY_INLINE Direction henyeyGreenstein(const Direction& from, FloatV g, FloatV half_qq, FloatV s, Azimuth phi) {
    return turnedBy(from, henyeyGreensteinVersine(g, half_qq, s), phi);
}

/// The integer part of count times a uniform number, from all of its 32 bits; count above 0.
HWY_INLINE IntV uniformBelow(IntV count, IntV bits) {
    const hn::RebindToUnsigned<Int> du;
    const Word d;
    const auto n = hn::BitCast(du, count), u = hn::BitCast(du, bits);
    const auto even = hn::MulEven(n, u);
    const auto odd = hn::MulEven(hn::BitCast(du, hn::ShiftRight<32>(hn::BitCast(d, n))),
                                 hn::BitCast(du, hn::ShiftRight<32>(hn::BitCast(d, u))));
    return hn::BitCast(Int(), hn::OddEven(hn::BitCast(du, odd), hn::BitCast(du, hn::ShiftRight<32>(even))));
}

/// 1 - cos of a scattering angle from the bins [first, first + count) of the tables; count at least 1.
HWY_INLINE FloatV tabulatedVersine(const PhaseTables& tables, IntV first, IntV count, IntV bin_bits, IntV alias_bits,
                                   IntV bits) {
    const Float d;
    const Int di;
    const IntV drawn = hn::Add(first, uniformBelow(count, bin_bits));
    const auto stays =
        hn::Lt(hn::And(alias_bits, hn::Set(di, PhaseTables::kStays)), hn::GatherIndex(di, tables.stay.data(), drawn));
    const IntV at = hn::IfThenElse(stays, drawn, hn::GatherIndex(di, tables.alias.data(), drawn));
    // Inverse of the integral of a linear density that begins at a and ends at 2 - a.
    const FloatV two = hn::Set(d, 2.0f), v = uniform(bits), a = hn::GatherIndex(d, tables.density.data(), at);
    const FloatV twice = hn::Mul(two, v);
    const FloatV root =
        hn::Sqrt(hn::Max(hn::MulAdd(hn::Mul(twice, two), hn::Sub(hn::Set(d, 1.0f), a), hn::Mul(a, a)), hn::Zero(d)));
    const FloatV part = hn::Div(twice, hn::Max(hn::Add(a, root), hn::Set(d, 1e-30f)));
    const FloatV begin = hn::GatherIndex(d, tables.begin.data(), at);
    return hn::Min(hn::MulAdd(part, hn::GatherIndex(d, tables.width.data(), at), begin), two);
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
    // Two quotients for one division.
    const FloatV s_below = hn::Add(eta_c, t), p_below = hn::Add(c, eta_t);
    // Both vanish where a matched interface is grazed.
    const FloatV inverse = hn::Div(one, hn::Max(hn::Mul(s_below, p_below), hn::Set(d, 1e-30f)));
    const FloatV s = hn::Mul(hn::Mul(hn::Sub(eta_c, t), p_below), inverse);
    const FloatV p = hn::Mul(hn::Mul(hn::Sub(c, eta_t), s_below), inverse);
    return {hn::Mul(hn::Set(d, 0.5f), hn::MulAdd(s, s, hn::Mul(p, p))), t};
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
