// A plane as a camera sees it, made without rays: what filters of the picture are tested on.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "kernel/kernel.h"
#include "render/screen/screen_filter.h"
#include "render/view.h"

namespace searchlight::test {

/// The plane through the origin with these unit axes, seen from +z.
struct ScreenPlane {
    View view;
    Vec3 s, t;
    VisibleSurface visible;
    ScreenSamples samples;

    /// The plane is turned by `tilt_deg` about the direction in the picture at `about_deg` against x.
    ScreenPlane(double distance_mm, double tilt_deg, double about_deg, int size = 200, double field_deg = 30) {
        constexpr double degree = std::numbers::pi / 180;
        view = {.width = size,
                .height = size,
                .eye = {0, 0, distance_mm},
                .right = {1, 0, 0},
                .up = {0, 1, 0},
                .forward = {0, 0, -1},
                .tan_half = std::tan(0.5 * field_deg * degree)};
        const Vec3 about{std::cos(about_deg * degree), std::sin(about_deg * degree), 0};
        const Vec3 across = cross({0, 0, 1}, about);
        const Vec3 normal = std::cos(tilt_deg * degree) * Vec3{0, 0, 1} + std::sin(tilt_deg * degree) * across;
        s = about;
        t = cross(normal, s);
        visible = {.width = size, .height = size, .eye = view.eye};
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const Vec3 way = view.direction(x + 0.5, y + 0.5);
                const double along = -dot(view.eye, normal) / dot(way, normal);
                if (!(along > 0)) continue;
                visible.pixels.push_back(static_cast<std::uint32_t>(y * size + x));
                visible.coverage.push_back(1);
                visible.positions.push_back(toFloat(view.eye + along * way));
                visible.normals.push_back(toFloat(normal));
                visible.geometric_normals.push_back(toFloat(normal));
            }
        samples = screenSamples(view, visible, 1);
    }

    std::vector<Rgbf> light(const std::function<double(double, double)>& at) const {
        std::vector<Rgbf> values;
        for (const Vec3f& position : visible.positions) {
            const double value = at(dot(toDouble(position), s), dot(toDouble(position), t));
            values.push_back(toFloat(Rgb{value, 0.5 * value, 2 * value}));
        }
        return values;
    }

    /// The sample that is seen at the middle of the picture.
    std::size_t middle() const {
        const auto pixel = static_cast<std::uint32_t>(view.height / 2 * view.width + view.width / 2);
        for (std::size_t i = 0; i < visible.pixels.size(); ++i)
            if (visible.pixels[i] == pixel) return i;
        return 0;
    }
};

/// A Gaussian of that standard deviation, and a delta of mass `delta` in its middle, by `count` even steps over four
/// standard deviations to each side: what the sum misses of the integral is below 1e-4.
inline Taps gaussianTaps(double sigma_mm, double delta = 0, int count = 41, double angle_deg = 0) {
    TapTerm term{.angle_deg = angle_deg, .delta = {delta, delta, delta}};
    double sum = 0;
    for (int i = -count / 2; i <= count / 2; ++i) {
        const double offset = 4 * sigma_mm * i / (count / 2);
        const double weight = std::exp(-0.5 * offset * offset / (sigma_mm * sigma_mm));
        term.offsets_mm.push_back(offset);
        term.weights.push_back({weight, weight, weight});
        sum += weight;
    }
    for (Rgb& weight : term.weights) weight = ((1 - delta) / sum) * weight;
    return {.terms = {term}, .extent_mm = 4 * sigma_mm};
}

}  // namespace searchlight::test
