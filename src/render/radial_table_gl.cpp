#include "render/radial_table_gl.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace searchlight {

namespace {

// Derivatives by w of one channel.
struct Jet {
    double R = 0, R1 = 0, R2 = 0, R3 = 0;
};

double finite(double x) { return std::isfinite(x) ? x : 0; }

// By differences over q w to both sides: narrow enough for the curve (q^2 times its curvature), wide enough for the
// cubics of the profile, whose second derivative jumps.
Jet jetOf(const RadialKernel& kernel, double w, int channel) {
    const double offset = kernel.offset();
    const auto R = [&](double at) { return finite(kernel(std::sqrt(std::max(0.0, at - offset)))[channel]); };
    // About r = 0 there is nothing on one side: the kernel is smooth in w there, and so is its nearest parabola.
    const double q = 1.0 / 24, Q = 1.0 / 8;
    const double centre = std::max(w, offset / (1 - q)), wide = std::max(w, offset / (1 - Q));
    const double h = q * centre, H = Q * wide;
    Jet jet;
    const double low = R(centre - h), middle = R(centre), high = R(centre + h);
    jet.R = R(w);
    jet.R2 = (low - 2 * middle + high) / (h * h);
    jet.R1 = (high - low) / (2 * h) + (w - centre) * jet.R2;
    jet.R3 = (R(wide + H) - 2 * R(wide + H / 2) + 2 * R(wide - H / 2) - R(wide - H)) / (H * H * H / 4);
    return jet;
}

// The largest third derivative of R along any direction at distance r: with cosine c to the radius it is
// 12 R'' r c + 8 R''' r^3 c^3.
double thirdDerivative(const Jet& jet, double r) {
    double largest = 0;
    for (const double c : {0.25, 0.5, 0.75, 1.0})
        largest = std::max(largest, std::abs(12 * jet.R2 * r * c + 8 * jet.R3 * std::pow(r * c, 3)));
    return largest;
}

// R_d spread evenly over where the channel's light goes.
double meanExitance(const RadialKernel& kernel, double area_mm2, int channel) {
    const double spread = std::min(area_mm2, std::numbers::pi * kernel.meanSquareRadius()[channel]);
    return spread > 0 ? finite(std::abs(kernel.total()[channel]) / spread) : 0;
}

}  // namespace

int RadialTableGl::firstBits() const {
    return static_cast<int>(std::bit_cast<std::uint32_t>(static_cast<float>(offset)) >> (23 - bits));
}

float RadialTableGl::reach(float w) const {
    const int entry = static_cast<int>(std::bit_cast<std::uint32_t>(w) >> (23 - bits)) - firstBits();
    return texels[3 * static_cast<std::size_t>(std::clamp(entry, 0, entries() - 1))][3];
}

RadialTableGl makeRadialTableGl(const RadialKernel& kernel, double area_mm2) {
    RadialTableGl table;
    table.offset = kernel.offset();
    const std::size_t intervals = kernel.values().size() - 1;
    for (std::size_t k = 0; k < intervals; ++k) {
        const double w = 0.5 * (kernel.node(k) + kernel.node(k + 1)), r = std::sqrt(w - kernel.offset());
        std::array<float, 4> texels[3] = {};
        double reach = std::numeric_limits<double>::infinity();
        for (int c = 0; c < Rgb::channels; ++c) {
            const Jet jet = jetOf(kernel, w, c);
            texels[0][c] = static_cast<float>(jet.R);
            texels[1][c] = static_cast<float>(jet.R1);
            texels[2][c] = static_cast<float>(jet.R2);
            const double third = thirdDerivative(jet, r);
            if (third > 0)
                reach = std::min(reach, std::cbrt(6 * (std::abs(jet.R) + meanExitance(kernel, area_mm2, c)) / third));
        }
        texels[0][3] = static_cast<float>(std::min(reach, 1e6 * r));
        table.texels.insert(table.texels.end(), std::begin(texels), std::end(texels));
    }
    const std::array<float, 4> beyond{0, 0, 0, std::numeric_limits<float>::max()};
    table.texels.insert(table.texels.end(), {beyond, {}, {}});
    return table;
}

}  // namespace searchlight
