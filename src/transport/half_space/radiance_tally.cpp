#include "transport/half_space/radiance_tally.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "transport/walk/long_walk.h"

namespace searchlight {

namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

void RadianceTally::add(std::span<const float> xs, std::span<const float> ys, std::span<const float> us,
                        std::span<const float> vs, std::span<const std::int32_t> collisions) {
    const RadianceLayout& layout = *layout_;
    const double inner = layout.r0 * layout.r0, outer = layout.r1 * layout.r1;
    const auto cellOf = [](double part, std::size_t cells) {
        return std::min(static_cast<std::size_t>(part * static_cast<double>(cells)), cells - 1);
    };
    for (std::size_t i = 0; i < xs.size(); ++i) {
        const double x = xs[i], r2 = x * x + static_cast<double>(ys[i]) * ys[i];
        if (!(r2 >= inner && r2 < outer)) continue;
        const double weight = 0.5 * (collisions[i] <= kLongWalk ? 1.0 : longWalkWeight(collisions[i]));
        // Refraction keeps the azimuth; rounding may take the sine past 1.
        const double sine = std::min(1.0, layout.eta * std::hypot(us[i], vs[i]));
        const std::size_t polar = cellOf(std::asin(sine) / (0.5 * pi), layout.polar);
        for (const double side : {1.0, -1.0}) {
            const double off = std::remainder(std::atan2(side * ys[i], x) - layout.azimuth, 2 * pi);
            if (std::abs(off) > layout.half_width) continue;
            const double turn = std::atan2(side * vs[i], us[i]) / (2 * pi);
            flux_[0] += weight;
            flux_[1 + polar * layout.turns + cellOf(turn < 0 ? turn + 1 : turn, layout.turns)] += weight;
        }
    }
}

}  // namespace searchlight
