// The vocabulary of the portable GLSL subset as C++ templates: what models and physics/*.glsl compile against when they
// are translated. `Real` is float or double. Semantics are [GLSL450] chapter 8's.
#pragma once

#include <cassert>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <type_traits>

namespace searchlight::glsl {

/// vec2..4, ivec2..4, uvec2..4 and bvec2..4; components are [0]..[N - 1].
template <class T, int N>
struct Vec {
    T e[N];

    constexpr Vec() : e{} {}

    /// One scalar fills every component; otherwise scalars and vectors are strung together, the surplus is dropped.
    template <class... Parts>
    explicit constexpr Vec(const Parts&... parts) : e{} {
        if constexpr (sizeof...(Parts) == 1 && (std::is_arithmetic_v<Parts> && ...)) {
            for (T& component : e) component = static_cast<T>((parts + ...));
        } else {
            int filled = 0;
            (append(filled, parts), ...);
        }
    }

    constexpr T& operator[](int i) {
        assert(i >= 0 && i < N);
        return e[i];
    }
    constexpr const T& operator[](int i) const {
        assert(i >= 0 && i < N);
        return e[i];
    }
    constexpr int length() const { return N; }

    template <int... Components>
    constexpr Vec<T, static_cast<int>(sizeof...(Components))> swizzle() const {
        return Vec<T, static_cast<int>(sizeof...(Components))>(e[Components]...);
    }

    friend constexpr Vec operator+(const Vec& a, const Vec& b) {
        return zip(a, b, [](T x, T y) { return x + y; });
    }
    friend constexpr Vec operator-(const Vec& a, const Vec& b) {
        return zip(a, b, [](T x, T y) { return x - y; });
    }
    friend constexpr Vec operator*(const Vec& a, const Vec& b) {
        return zip(a, b, [](T x, T y) { return x * y; });
    }
    friend constexpr Vec operator/(const Vec& a, const Vec& b) {
        return zip(a, b, [](T x, T y) { return x / y; });
    }
    friend constexpr Vec operator+(const Vec& a, T b) { return a + Vec(b); }
    friend constexpr Vec operator-(const Vec& a, T b) { return a - Vec(b); }
    friend constexpr Vec operator*(const Vec& a, T b) { return a * Vec(b); }
    friend constexpr Vec operator/(const Vec& a, T b) { return a / Vec(b); }
    friend constexpr Vec operator+(T a, const Vec& b) { return Vec(a) + b; }
    friend constexpr Vec operator-(T a, const Vec& b) { return Vec(a) - b; }
    friend constexpr Vec operator*(T a, const Vec& b) { return Vec(a) * b; }
    friend constexpr Vec operator/(T a, const Vec& b) { return Vec(a) / b; }
    friend constexpr Vec operator-(const Vec& a) {
        return map(a, [](T x) { return -x; });
    }
    friend constexpr Vec operator+(const Vec& a) { return a; }

    template <class B>
    constexpr Vec& operator+=(const B& b) {
        return *this = *this + b;
    }
    template <class B>
    constexpr Vec& operator-=(const B& b) {
        return *this = *this - b;
    }
    template <class B>
    constexpr Vec& operator*=(const B& b) {
        return *this = *this * b;
    }
    template <class B>
    constexpr Vec& operator/=(const B& b) {
        return *this = *this / b;
    }

    friend constexpr bool operator==(const Vec& a, const Vec& b) {
        bool same = true;
        for (int i = 0; i < N; ++i) same = same && a.e[i] == b.e[i];
        return same;
    }

    /// f for each pair of components.
    template <class F>
    static constexpr auto zip(const Vec& a, const Vec& b, F f) {
        Vec<decltype(f(a.e[0], b.e[0])), N> result;
        for (int i = 0; i < N; ++i) result.e[i] = f(a.e[i], b.e[i]);
        return result;
    }

    /// f for each component.
    template <class F>
    static constexpr auto map(const Vec& a, F f) {
        Vec<decltype(f(a.e[0])), N> result;
        for (int i = 0; i < N; ++i) result.e[i] = f(a.e[i]);
        return result;
    }

private:
    template <class Scalar>
    constexpr void append(int& filled, const Scalar& scalar) {
        if (filled < N) e[filled++] = static_cast<T>(scalar);
    }
    template <class U, int M>
    constexpr void append(int& filled, const Vec<U, M>& vector) {
        for (int i = 0; i < M; ++i) append(filled, vector.e[i]);
    }
};

/// Column major, as in GLSL: m[i] is column i.
template <class T>
struct Mat3 {
    Vec<T, 3> columns[3];

    constexpr Mat3() = default;
    explicit constexpr Mat3(T diagonal) {
        for (int i = 0; i < 3; ++i) columns[i][i] = diagonal;
    }
    constexpr Mat3(const Vec<T, 3>& a, const Vec<T, 3>& b, const Vec<T, 3>& c) : columns{a, b, c} {}
    constexpr Mat3(T a, T b, T c, T d, T e, T f, T g, T h, T i)
        : columns{Vec<T, 3>(a, b, c), Vec<T, 3>(d, e, f), Vec<T, 3>(g, h, i)} {}

    constexpr Vec<T, 3>& operator[](int i) { return columns[i]; }
    constexpr const Vec<T, 3>& operator[](int i) const { return columns[i]; }

    friend constexpr Vec<T, 3> operator*(const Mat3& m, const Vec<T, 3>& v) {
        return m[0] * v[0] + m[1] * v[1] + m[2] * v[2];
    }
    friend constexpr Vec<T, 3> operator*(const Vec<T, 3>& v, const Mat3& m) {
        Vec<T, 3> result;
        for (int i = 0; i < 3; ++i) result[i] = v[0] * m[i][0] + v[1] * m[i][1] + v[2] * m[i][2];
        return result;
    }
    friend constexpr Mat3 operator*(const Mat3& a, const Mat3& b) { return Mat3(a * b[0], a * b[1], a * b[2]); }
    friend constexpr Mat3 operator*(const Mat3& a, T b) { return Mat3(a[0] * b, a[1] * b, a[2] * b); }
    friend constexpr Mat3 operator*(T a, const Mat3& b) { return b * a; }
    friend constexpr Mat3 operator+(const Mat3& a, const Mat3& b) {
        return Mat3(a[0] + b[0], a[1] + b[1], a[2] + b[2]);
    }
    friend constexpr Mat3 operator-(const Mat3& a, const Mat3& b) {
        return Mat3(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    }
};

/// A fixed array that is copied by value and knows its length(), as in GLSL.
template <class T, int N>
struct Array {
    T e[N];

    constexpr T& operator[](int i) {
        assert(i >= 0 && i < N);
        return e[i];
    }
    constexpr const T& operator[](int i) const {
        assert(i >= 0 && i < N);
        return e[i];
    }
    constexpr int length() const { return N; }
};

/// float[](a, b, c).
template <class T, class... Values>
constexpr Array<T, static_cast<int>(sizeof...(Values))> arrayOf(const Values&... values) {
    return {{static_cast<T>(values)...}};
}

/// Types, PI and built-in functions. Functions are static members so that integers convert to Real as in GLSL, and so
/// that a model's own function of the same name hides them.
template <class Real>
struct Glsl {
    using vec2 = Vec<Real, 2>;
    using vec3 = Vec<Real, 3>;
    using vec4 = Vec<Real, 4>;
    using bvec2 = Vec<bool, 2>;
    using bvec3 = Vec<bool, 3>;
    using bvec4 = Vec<bool, 4>;
    using mat3 = Mat3<Real>;

    static constexpr Real PI = Real(3.14159265358979323846264338327950288L);

// One argument: for a scalar, and for each component of a vector.
#define SEARCHLIGHT_GLSL_UNARY(Result, name, expression)                          \
    static constexpr Result name(Real x) { return expression; }                   \
    template <int N>                                                              \
    static constexpr Vec<Result, N> name(const Vec<Real, N>& v) {                 \
        return Vec<Real, N>::map(v, [](Real x) -> Result { return expression; }); \
    }
    SEARCHLIGHT_GLSL_UNARY(Real, sqrt, std::sqrt(x))
    SEARCHLIGHT_GLSL_UNARY(Real, inversesqrt, Real(1) / std::sqrt(x))
    SEARCHLIGHT_GLSL_UNARY(Real, exp, std::exp(x))
    SEARCHLIGHT_GLSL_UNARY(Real, exp2, std::exp2(x))
    SEARCHLIGHT_GLSL_UNARY(Real, log, std::log(x))
    SEARCHLIGHT_GLSL_UNARY(Real, log2, std::log2(x))
    SEARCHLIGHT_GLSL_UNARY(Real, sin, std::sin(x))
    SEARCHLIGHT_GLSL_UNARY(Real, cos, std::cos(x))
    SEARCHLIGHT_GLSL_UNARY(Real, tan, std::tan(x))
    SEARCHLIGHT_GLSL_UNARY(Real, asin, std::asin(x))
    SEARCHLIGHT_GLSL_UNARY(Real, acos, std::acos(x))
    SEARCHLIGHT_GLSL_UNARY(Real, atan, std::atan(x))
    SEARCHLIGHT_GLSL_UNARY(Real, sinh, std::sinh(x))
    SEARCHLIGHT_GLSL_UNARY(Real, cosh, std::cosh(x))
    SEARCHLIGHT_GLSL_UNARY(Real, tanh, std::tanh(x))
    SEARCHLIGHT_GLSL_UNARY(Real, abs, std::fabs(x))
    SEARCHLIGHT_GLSL_UNARY(Real, sign, x > 0 ? Real(1) : x < 0 ? Real(-1) : Real(0))
    SEARCHLIGHT_GLSL_UNARY(Real, floor, std::floor(x))
    SEARCHLIGHT_GLSL_UNARY(Real, ceil, std::ceil(x))
    SEARCHLIGHT_GLSL_UNARY(Real, round, std::round(x))
    SEARCHLIGHT_GLSL_UNARY(Real, trunc, std::trunc(x))
    SEARCHLIGHT_GLSL_UNARY(Real, fract, x - std::floor(x))
    SEARCHLIGHT_GLSL_UNARY(Real, radians, x*(PI / Real(180)))
    SEARCHLIGHT_GLSL_UNARY(Real, degrees, x*(Real(180) / PI))
    SEARCHLIGHT_GLSL_UNARY(bool, isnan, std::isnan(x))
    SEARCHLIGHT_GLSL_UNARY(bool, isinf, std::isinf(x))
#undef SEARCHLIGHT_GLSL_UNARY

// Two arguments of one kind.
#define SEARCHLIGHT_GLSL_BINARY(name, expression)                                          \
    static constexpr Real name(Real x, Real y) { return expression; }                      \
    template <int N>                                                                       \
    static constexpr Vec<Real, N> name(const Vec<Real, N>& a, const Vec<Real, N>& b) {     \
        return Vec<Real, N>::zip(a, b, [](Real x, Real y) -> Real { return expression; }); \
    }
    SEARCHLIGHT_GLSL_BINARY(pow, std::pow(x, y))
    SEARCHLIGHT_GLSL_BINARY(atan, std::atan2(x, y))
    SEARCHLIGHT_GLSL_BINARY(min, y < x ? y : x)
    SEARCHLIGHT_GLSL_BINARY(max, x < y ? y : x)
    SEARCHLIGHT_GLSL_BINARY(mod, x - y * std::floor(x / y))
    SEARCHLIGHT_GLSL_BINARY(step, y < x ? Real(0) : Real(1))
#undef SEARCHLIGHT_GLSL_BINARY

    template <int N>
    static constexpr Vec<Real, N> min(const Vec<Real, N>& a, Real b) {
        return min(a, Vec<Real, N>(b));
    }
    template <int N>
    static constexpr Vec<Real, N> max(const Vec<Real, N>& a, Real b) {
        return max(a, Vec<Real, N>(b));
    }
    template <int N>
    static constexpr Vec<Real, N> mod(const Vec<Real, N>& a, Real b) {
        return mod(a, Vec<Real, N>(b));
    }
    template <int N>
    static constexpr Vec<Real, N> step(Real edge, const Vec<Real, N>& v) {
        return step(Vec<Real, N>(edge), v);
    }

    // Only two int arguments choose these: a template does not convert.
    template <std::same_as<int> Int>
    static constexpr Int abs(Int x) {
        return x < 0 ? -x : x;
    }
    template <std::same_as<int> Int>
    static constexpr Int sign(Int x) {
        return (x > 0) - (x < 0);
    }
    template <std::same_as<int> Int>
    static constexpr Int min(Int x, Int y) {
        return y < x ? y : x;
    }
    template <std::same_as<int> Int>
    static constexpr Int max(Int x, Int y) {
        return x < y ? y : x;
    }
    template <std::same_as<int> Int>
    static constexpr Int clamp(Int x, Int low, Int high) {
        return min(max(x, low), high);
    }

    static constexpr Real clamp(Real x, Real low, Real high) { return min(max(x, low), high); }
    template <int N>
    static constexpr Vec<Real, N> clamp(const Vec<Real, N>& v, Real low, Real high) {
        return min(max(v, low), high);
    }
    template <int N>
    static constexpr Vec<Real, N> clamp(const Vec<Real, N>& v, const Vec<Real, N>& low, const Vec<Real, N>& high) {
        return min(max(v, low), high);
    }

    static constexpr Real mix(Real a, Real b, Real t) { return a * (Real(1) - t) + b * t; }
    static constexpr Real mix(Real a, Real b, bool second) { return second ? b : a; }
    template <int N>
    static constexpr Vec<Real, N> mix(const Vec<Real, N>& a, const Vec<Real, N>& b, Real t) {
        return a * (Real(1) - t) + b * t;
    }
    template <int N>
    static constexpr Vec<Real, N> mix(const Vec<Real, N>& a, const Vec<Real, N>& b, const Vec<Real, N>& t) {
        return a * (Real(1) - t) + b * t;
    }
    template <int N>
    static constexpr Vec<Real, N> mix(const Vec<Real, N>& a, const Vec<Real, N>& b, const Vec<bool, N>& second) {
        Vec<Real, N> result;
        for (int i = 0; i < N; ++i) result[i] = second[i] ? b[i] : a[i];
        return result;
    }

    static constexpr Real smoothstep(Real low, Real high, Real x) {
        const Real t = clamp((x - low) / (high - low), Real(0), Real(1));
        return t * t * (Real(3) - Real(2) * t);
    }
    template <int N>
    static constexpr Vec<Real, N> smoothstep(Real low, Real high, const Vec<Real, N>& v) {
        return Vec<Real, N>::map(v, [=](Real x) { return smoothstep(low, high, x); });
    }

    static constexpr Real dot(Real a, Real b) { return a * b; }
    template <int N>
    static constexpr Real dot(const Vec<Real, N>& a, const Vec<Real, N>& b) {
        Real sum = a[0] * b[0];
        for (int i = 1; i < N; ++i) sum += a[i] * b[i];
        return sum;
    }
    static constexpr Real length(Real x) { return abs(x); }
    template <int N>
    static constexpr Real length(const Vec<Real, N>& v) {
        return std::sqrt(dot(v, v));
    }
    static constexpr Real distance(Real a, Real b) { return abs(a - b); }
    template <int N>
    static constexpr Real distance(const Vec<Real, N>& a, const Vec<Real, N>& b) {
        return length(a - b);
    }
    template <int N>
    static constexpr Vec<Real, N> normalize(const Vec<Real, N>& v) {
        return v / length(v);
    }
    static constexpr vec3 cross(const vec3& a, const vec3& b) {
        return vec3(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
    }
    template <int N>
    static constexpr Vec<Real, N> reflect(const Vec<Real, N>& incident, const Vec<Real, N>& normal) {
        return incident - Real(2) * dot(normal, incident) * normal;
    }
    template <int N>
    static constexpr Vec<Real, N> refract(const Vec<Real, N>& incident, const Vec<Real, N>& normal, Real eta) {
        const Real cosine = dot(normal, incident);
        const Real k = Real(1) - eta * eta * (Real(1) - cosine * cosine);
        if (k < 0) return Vec<Real, N>();
        return eta * incident - (eta * cosine + std::sqrt(k)) * normal;
    }
    static constexpr mat3 transpose(const mat3& m) {
        return mat3(m[0][0], m[1][0], m[2][0], m[0][1], m[1][1], m[2][1], m[0][2], m[1][2], m[2][2]);
    }

#define SEARCHLIGHT_GLSL_COMPARE(name, op)                                             \
    template <int N>                                                                   \
    static constexpr Vec<bool, N> name(const Vec<Real, N>& a, const Vec<Real, N>& b) { \
        return Vec<Real, N>::zip(a, b, [](Real x, Real y) -> bool { return x op y; }); \
    }
    SEARCHLIGHT_GLSL_COMPARE(lessThan, <)
    SEARCHLIGHT_GLSL_COMPARE(lessThanEqual, <=)
    SEARCHLIGHT_GLSL_COMPARE(greaterThan, >)
    SEARCHLIGHT_GLSL_COMPARE(greaterThanEqual, >=)
    SEARCHLIGHT_GLSL_COMPARE(equal, ==)
    SEARCHLIGHT_GLSL_COMPARE(notEqual, !=)
#undef SEARCHLIGHT_GLSL_COMPARE

    template <int N>
    static constexpr bool any(const Vec<bool, N>& v) {
        bool result = false;
        for (int i = 0; i < N; ++i) result = result || v[i];
        return result;
    }
    template <int N>
    static constexpr bool all(const Vec<bool, N>& v) {
        bool result = true;
        for (int i = 0; i < N; ++i) result = result && v[i];
        return result;
    }
    /// GLSL's not(): `not` is a word of C++.
    template <int N>
    static constexpr Vec<bool, N> not_glsl(const Vec<bool, N>& v) {
        return Vec<bool, N>::map(v, [](bool x) { return !x; });
    }
};

}  // namespace searchlight::glsl
