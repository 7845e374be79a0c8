// Random numbers and elementary functions on float lanes, for walks. Included once per instruction set.
// Every multiply-add is written out and every operation is correctly rounded, so that targets with FMA agree bit for
// bit.
#if defined(SEARCHLIGHT_TRANSPORT_LANE_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_LANE_MATH_INL_H_
#undef SEARCHLIGHT_TRANSPORT_LANE_MATH_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_LANE_MATH_INL_H_
#endif

#include "base/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

using Word = hn::Repartition<uint64_t, Float>;
using WordV = hn::Vec<Word>;

/// xoroshiro128++ ([Blackman2021]) in each 64-bit lane: two neighbouring float lanes share a generator and take the low
/// and the high half of its output.
struct Generator {
    WordV s0, s1;

    HWY_INLINE IntV next() {
        const WordV bits = hn::Add(rotateLeft<17>(hn::Add(s0, s1)), s0);
        advance();
        return hn::BitCast(Int(), bits);
    }

    /// As next(), but only generators with a wanted lane move on: what a lane draws may depend on itself and its
    /// neighbour, never on how many lanes the hardware has.
    HWY_INLINE IntV nextWhere(FloatM wanted) {
        const WordV old_s0 = s0, old_s1 = s1;
        const IntV bits = next();
        const Word d;
        const auto moves = hn::Ne(hn::BitCast(d, hn::VecFromMask(Float(), wanted)), hn::Zero(d));
        s0 = hn::IfThenElse(moves, s0, old_s0);
        s1 = hn::IfThenElse(moves, s1, old_s1);
        return bits;
    }

private:
    template <int kBits>
    static HWY_INLINE WordV rotateLeft(WordV v) {
        return hn::RotateRight<64 - kBits>(v);
    }
    HWY_INLINE void advance() {
        s1 = hn::Xor(s1, s0);
        s0 = hn::Xor(hn::Xor(rotateLeft<49>(s0), s1), hn::ShiftLeft<21>(s1));
        s1 = rotateLeft<28>(s1);
    }
};

/// [0, 1) in steps of 2^-24.
HWY_INLINE FloatV uniform(IntV bits) {
    const Float d;
    const hn::RebindToUnsigned<Float> du;
    const IntV top = hn::BitCast(Int(), hn::ShiftRight<8>(hn::BitCast(du, bits)));
    return hn::Mul(hn::ConvertTo(d, top), hn::Set(d, 0x1p-24f));
}

/// [-1, 1], all 32 bits.
HWY_INLINE FloatV signedUniform(IntV bits) {
    const Float d;
    return hn::Mul(hn::ConvertTo(d, bits), hn::Set(d, 0x1p-31f));
}

/// -log of a uniform number: an exponential variate of mean 1, relative error below 2e-7.
/// The uniform number is (k + 1/2) 2^-31, so the variate reaches 22.2 (what is cut has probability 2e-10); near 0 its
/// steps are 6e-8 mean free paths, far below any radius that is tallied.
HWY_INLINE FloatV exponential(IntV bits) {
    const Float d;
    const Int di;
    const IntV k = hn::And(bits, hn::Set(di, 0x7FFFFFFF));
    const IntV x = hn::BitCast(di, hn::Add(hn::ConvertTo(d, k), hn::Set(d, 0.5f)));
    // x = 2^exponent (1 + y) with 1 + y in [sqrt(1/2), sqrt(2)); 0x3F3504F3 is sqrt(1/2).
    const IntV shifted = hn::Add(x, hn::Set(di, 0x3F800000 - 0x3F3504F3));
    const FloatV exponent = hn::ConvertTo(d, hn::Sub(hn::ShiftRight<23>(shifted), hn::Set(di, 127 + 31)));
    const IntV mantissa = hn::Add(hn::And(shifted, hn::Set(di, 0x007FFFFF)), hn::Set(di, 0x3F3504F3));
    const FloatV y = hn::Sub(hn::BitCast(d, mantissa), hn::Set(d, 1.0f));
    // log(1 + y) = y + y^2 q(y): minimax fit of relative error 3.1e-8.
    FloatV q = hn::Set(d, 0.089803467f);
    q = hn::MulAdd(q, y, hn::Set(d, -0.144263872f));
    q = hn::MulAdd(q, y, hn::Set(d, 0.148831928f));
    q = hn::MulAdd(q, y, hn::Set(d, -0.165518558f));
    q = hn::MulAdd(q, y, hn::Set(d, 0.199635335f));
    q = hn::MulAdd(q, y, hn::Set(d, -0.250025804f));
    q = hn::MulAdd(q, y, hn::Set(d, 0.333339316f));
    q = hn::MulAdd(q, y, hn::Set(d, -0.499999832f));
    const FloatV log_mantissa = hn::MulAdd(hn::Mul(y, y), q, y);
    return hn::NegMulSub(exponent, hn::Set(d, 0.693147181f), log_mantissa);
}

struct Azimuth {
    FloatV cos, sin;
};

/// A uniform direction in the plane. The top 24 bits choose an angle in [-pi/2, pi/2), a low bit the sign of the
/// cosine; cos^2 + sin^2 = 1 within 5e-7.
HWY_INLINE Azimuth azimuth(IntV bits) {
    const Float d;
    const FloatV a = hn::Sub(uniform(bits), hn::Set(d, 0.5f));  // the angle over pi
    const FloatV t = hn::Mul(a, a);
    FloatV s = hn::Set(d, 0.0772406352f);  // sin(pi a) / a, minimax, 3.5e-9
    s = hn::MulAdd(s, t, hn::Set(d, -0.598057495f));
    s = hn::MulAdd(s, t, hn::Set(d, 2.55003391f));
    s = hn::MulAdd(s, t, hn::Set(d, -5.16770708f));
    s = hn::MulAdd(s, t, hn::Set(d, 3.14159259f));
    FloatV c = hn::Set(d, 0.219696798f);  // cos(pi a), minimax, 4.7e-8
    c = hn::MulAdd(c, t, hn::Set(d, -1.33188016f));
    c = hn::MulAdd(c, t, hn::Set(d, 4.05841191f));
    c = hn::MulAdd(c, t, hn::Set(d, -4.93479286f));
    c = hn::MulAdd(c, t, hn::Set(d, 0.999999953f));
    const IntV sign = hn::And(hn::ShiftLeft<24>(bits), hn::Set(Int(), static_cast<int>(0x80000000)));
    return {hn::Xor(c, hn::BitCast(d, sign)), hn::Mul(s, a)};
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
