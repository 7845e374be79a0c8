// Surfaces, lights and profiles for tests of the sum over points.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <span>
#include <string_view>
#include <vector>

#include "model/evaluator.h"
#include "model/plane.h"
#include "render/exitance_sum.h"
#include "scene/materials.h"

namespace searchlight {

inline Profile dipoleProfile(const Medium& medium) {
    const Model model = loadModel("dipole");
    const auto evaluator = makeNativeEvaluator(model);
    evaluator->set(medium, {});
    return tabulate(*evaluator, model, medium).profile;
}

inline Profile dipoleProfile(std::string_view material) { return dipoleProfile(findMaterial(material).medium); }

/// A sphere with smooth dents: curvature of both signs, and parts that hide others from a camera.
inline Vec3 dented(Vec3 unit, double radius_mm) {
    const double dent = 0.2 * std::sin(5 * unit.x + 1) * std::sin(4 * unit.y) * std::sin(6 * unit.z + 2);
    return radius_mm * (1 + dent) * unit;
}

/// Unit vectors spread evenly, on a spiral by the golden angle.
inline std::vector<Vec3> spiral(std::size_t count) {
    std::vector<Vec3> units;
    for (std::size_t i = 0; i < count; ++i) {
        const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
        const double ring = std::sqrt(1 - z * z), turn = 2.399963229728653 * static_cast<double>(i);
        units.push_back({ring * std::cos(turn), ring * std::sin(turn), z});
    }
    return units;
}

struct LitCloud {
    PointCloud cloud;
    std::vector<Rgbf> transmitted;
};

using LightAt = std::function<Rgbf(Vec3 unit)>;

inline LitCloud dentedSphere(std::size_t count, double radius_mm, const LightAt& light) {
    LitCloud points;
    for (const Vec3 unit : spiral(count)) {
        points.cloud.positions.push_back(toFloat(dented(unit, radius_mm)));
        points.cloud.areas.push_back(
            static_cast<float>(4 * std::numbers::pi * radius_mm * radius_mm / static_cast<double>(count)));
        points.transmitted.push_back(light(unit));
    }
    return points;
}

inline Rgbf lambert(Vec3 unit) {
    const auto cosine = static_cast<float>(std::max(0.0, dot(unit, normalize(Vec3{1, 1, 1}))));
    return {cosine, cosine, cosine};
}
inline Rgbf halfDark(Vec3 unit) { return unit.x > 0.3 ? Rgbf{1, 1, 1} : Rgbf{}; }
inline Rgbf checker(Vec3 unit) {
    const int cell = static_cast<int>(std::floor(8 * unit.x) + std::floor(8 * unit.y) + std::floor(8 * unit.z));
    return cell % 2 == 0 ? Rgbf{1, 0.1f, 0} : Rgbf{0, 0.3f, 1};
}

/// What a camera far away on the z axis sees of it, tile by tile.
inline std::vector<Vec3f> pixelsOfDentedSphere(int side, double radius_mm) {
    std::vector<Vec3f> receivers;
    for (int tile = 0; tile < side * side / 64; ++tile)
        for (int i = 0; i < 64; ++i) {
            const int x = 8 * (tile % (side / 8)) + i % 8, y = 8 * (tile / (side / 8)) + i / 8;
            const double u = (x + 0.5) / side * 2.04 - 1.02, v = 1.02 - (y + 0.5) / side * 2.04;
            if (u * u + v * v < 1)
                receivers.push_back(toFloat(dented({u, v, std::sqrt(1 - u * u - v * v)}, radius_mm)));
        }
    return receivers;
}

struct SumError {
    double rmse = 0;     ///< relative, worst channel
    double largest = 0;  ///< relative to the RMS, worst channel
};

inline SumError errorOf(std::span<const Rgbf> sum, std::span<const Rgb> truth) {
    SumError error;
    for (int c = 0; c < Rgb::channels; ++c) {
        double squares = 0, norm = 0, largest = 0;
        for (std::size_t i = 0; i < truth.size(); ++i) {
            const double off = toDouble(sum[i])[c] - truth[i][c];
            squares += off * off;
            norm += truth[i][c] * truth[i][c];
            largest = std::max(largest, std::abs(off));
        }
        if (norm == 0) {
            if (squares > 0) return {INFINITY, INFINITY};
            continue;
        }
        error.rmse = std::max(error.rmse, std::sqrt(squares / norm));
        error.largest = std::max(error.largest, largest / std::sqrt(norm / static_cast<double>(truth.size())));
    }
    return error;
}

/// Every k-th of a list.
template <class T>
std::vector<T> everyNth(std::span<const T> all, std::size_t k) {
    std::vector<T> some;
    for (std::size_t i = k / 2; i < all.size(); i += k) some.push_back(all[i]);
    return some;
}

}  // namespace searchlight
