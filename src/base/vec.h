// Plain vectors: points and directions, and colours; in double, and in float where there are millions of them.
#pragma once

#include <cmath>

namespace searchlight {

struct Vec3 {
    double x = 0, y = 0, z = 0;
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double length(Vec3 a) { return std::sqrt(dot(a, a)); }

inline Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
/// Requires length(a) > 0.
inline Vec3 normalize(Vec3 a) { return (1 / length(a)) * a; }

struct Vec2f {
    float x = 0, y = 0;
    bool operator==(const Vec2f&) const = default;
};

struct Vec3f {
    float x = 0, y = 0, z = 0;
    bool operator==(const Vec3f&) const = default;
};

inline Vec3 toDouble(Vec3f a) { return {a.x, a.y, a.z}; }
inline Vec3f toFloat(Vec3 a) { return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)}; }

/// Linear, Rec. 709 primaries; also any quantity that has a value per channel.
struct Rgb {
    double r = 0, g = 0, b = 0;

    static constexpr int channels = 3;
    double& operator[](int channel) { return channel == 0 ? r : channel == 1 ? g : b; }
    double operator[](int channel) const { return channel == 0 ? r : channel == 1 ? g : b; }
    bool operator==(const Rgb&) const = default;
};

inline Rgb operator+(Rgb a, Rgb b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
inline Rgb operator-(Rgb a, Rgb b) { return {a.r - b.r, a.g - b.g, a.b - b.b}; }
inline Rgb operator*(Rgb a, Rgb b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
inline Rgb operator/(Rgb a, Rgb b) { return {a.r / b.r, a.g / b.g, a.b / b.b}; }
inline Rgb operator*(double s, Rgb a) { return {s * a.r, s * a.g, s * a.b}; }

struct Rgbf {
    float r = 0, g = 0, b = 0;
    bool operator==(const Rgbf&) const = default;
};

inline Rgb toDouble(Rgbf a) { return {a.r, a.g, a.b}; }
inline Rgbf toFloat(Rgb a) { return {static_cast<float>(a.r), static_cast<float>(a.g), static_cast<float>(a.b)}; }

/// Relative luminance of linear Rec. 709.
inline double luminance(Rgb a) { return 0.2126 * a.r + 0.7152 * a.g + 0.0722 * a.b; }

}  // namespace searchlight
