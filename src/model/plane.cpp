#include "model/plane.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "base/error.h"
#include "model/physics.h"

namespace searchlight {

namespace {

constexpr double pi = std::numbers::pi;

struct Node {
    double x, weight;  // of [-1, 1]
};

// Gauss-Legendre with n points, by Newton's method on P_n.
template <std::size_t n>
const std::array<Node, n>& gaussLegendre() {
    static const std::array<Node, n> nodes = [] {
        std::array<Node, n> found{};
        for (std::size_t i = 0; i < n; ++i) {
            double x = -std::cos(pi * (static_cast<double>(i) + 0.75) / (n + 0.5)), slope = 0;
            for (int step = 0; step < 8; ++step) {
                double previous = 1, value = x;
                for (std::size_t k = 2; k <= n; ++k) {
                    const double next = ((2.0 * k - 1) * x * value - (k - 1.0) * previous) / static_cast<double>(k);
                    previous = value;
                    value = next;
                }
                slope = n * (x * value - previous) / (x * x - 1);
                x -= value / slope;
            }
            found[i] = {x, 2 / ((1 - x * x) * slope * slope)};
        }
        return found;
    }();
    return nodes;
}

struct Exit {
    Vec3 wo;
    double weight;  // T21 cos dw / (pi 4 C_phi(1/eta))
};

// One direction for a model that does not depend on it, else a product rule over the hemisphere outside.
std::vector<Exit> exitDirections(const Model& model, double eta) {
    if (model.file.no_wo) return {{{0, 0, 1}, 1}};
    constexpr int azimuths = 24;
    const double normalizer = pi * (1 - 2 * Physics<double>::fresnelMoment(1, 1 / eta));
    std::vector<Exit> exits;
    for (const Node& node : gaussLegendre<24>()) {
        const double mu = 0.5 * (1 + node.x), sine = std::sqrt(1 - mu * mu);
        const double transmitted = 1 - Physics<double>::fresnelReflectance(mu, 1 / eta);
        const double weight = 0.5 * node.weight * (2 * pi / azimuths) * transmitted * mu / normalizer;
        for (int k = 0; k < azimuths; ++k) {
            const double phi = 2 * pi * (k + 0.5) / azimuths;
            exits.push_back({{sine * std::cos(phi), sine * std::sin(phi), mu}, weight});
        }
    }
    return exits;
}

bool isRadialAbout(const Model& model, double angle_deg) {
    // A flat half-space under a normal beam is as symmetric as a radial model.
    return model.file.radial || angle_deg == 0;
}

// One trapezoidal sum over u = ln r. R_d is analytic in u for |Im u| < pi/2 (its singularities lie at r = +-i z), and
// 2 pi r^2 R_d vanishes at both ends, so that the sum converges like exp(-pi^2 / step).
Rgb logarithmicSum(Evaluator& evaluator, const Model& model, const Medium& medium, double angle_deg, double from,
                   double to, double step, double offset) {
    std::vector<double> radii;
    for (double u = std::log(from) + offset * step; u < std::log(to); u += step) radii.push_back(std::exp(u));
    const std::vector<Rgb> Rd = radialRd(evaluator, model, medium, angle_deg, radii);
    Rgb sum;
    for (std::size_t i = 0; i < radii.size(); ++i) sum = sum + 2 * pi * radii[i] * radii[i] * step * Rd[i];
    return sum;
}

// Lengths that a profile may have, mm: the medium's mean free paths, and those of profiles fixed in mm.
struct LengthRange {
    double min = 0.01, max = 10;
};
LengthRange lengthRange(const Medium& medium) {
    LengthRange range;
    for (int c = 0; c < Rgb::channels; ++c) {
        const double length = 1 / medium.sigmaTp()[c];
        range.min = std::min(range.min, length);
        range.max = std::max(range.max, length);
    }
    return range;
}

}  // namespace

PencilBeam pencilBeam(double eta, double angle_deg) {
    if (!(angle_deg >= 0 && angle_deg < 90))
        throw inputError(fmt::format("angle of incidence {} deg", angle_deg), "expected 0 to below 90");
    const double angle = angle_deg * pi / 180;
    return {1 - Physics<double>::fresnelReflectance(std::cos(angle), 1 / eta), {-std::sin(angle), 0, std::cos(angle)}};
}

std::vector<Rgb> planeRd(Evaluator& evaluator, const Model& model, const Medium& medium, double angle_deg,
                         std::span<const Vec3> points_mm) {
    const Vec3 up{0, 0, 1};
    const Vec3 wi = pencilBeam(medium.eta, angle_deg).wi;
    const std::vector<Exit> exits = exitDirections(model, medium.eta);
    std::vector<Rgb> Rd(points_mm.size());
    // In slices, so that an integral over directions at every point of an oblique plane stays within some MiB.
    const std::size_t slice = std::max<std::size_t>(1, (std::size_t{1} << 16) / exits.size());
    std::vector<Query> queries;
    std::vector<Rgb> values;
    for (std::size_t begin = 0; begin < points_mm.size(); begin += slice) {
        const auto points = points_mm.subspan(begin, std::min(slice, points_mm.size() - begin));
        queries.clear();
        for (const Vec3& point : points)
            for (const Exit& exit : exits) queries.push_back({{}, wi, up, {point.x, point.y, 0}, exit.wo, up});
        values.resize(queries.size());
        evaluator.evaluate(queries, values);
        for (std::size_t i = 0; i < values.size(); ++i) {
            Rgb& sum = Rd[begin + i / exits.size()];
            sum = sum + exits[i % exits.size()].weight * values[i];
        }
    }
    return Rd;
}

std::vector<Rgb> radialRd(Evaluator& evaluator, const Model& model, const Medium& medium, double angle_deg,
                          std::span<const double> radii_mm) {
    // The beam lies in the plane y = 0, so half a turn is enough. Midpoints of a smooth periodic function converge
    // exponentially.
    const int azimuths = isRadialAbout(model, angle_deg) ? 1 : 64;
    std::vector<Vec3> points;
    points.reserve(radii_mm.size() * static_cast<std::size_t>(azimuths));
    for (const double r : radii_mm)
        for (int k = 0; k < azimuths; ++k) {
            const double phi = azimuths == 1 ? 0 : pi * (k + 0.5) / azimuths;
            points.push_back({r * std::cos(phi), r * std::sin(phi), 0});
        }
    const std::vector<Rgb> values = planeRd(evaluator, model, medium, angle_deg, points);
    if (azimuths == 1) return values;
    std::vector<Rgb> means(radii_mm.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        Rgb& mean = means[i / static_cast<std::size_t>(azimuths)];
        mean = mean + 1.0 / azimuths * values[i];
    }
    return means;
}

std::vector<Rgb> annulusMeans(Evaluator& evaluator, const Model& model, const Medium& medium, double angle_deg,
                              std::span<const double> edges_mm) {
    // r R_d is finite at 0 even where R_d goes as 1/r. Each annulus is cut into panels whose ends have the ratio 2:
    // then what happens at depths or widths far below r is smooth on the panel.
    const auto& rule = gaussLegendre<16>();
    std::vector<double> radii, weights;
    std::vector<std::size_t> annulus;
    for (std::size_t i = 0; i + 1 < edges_mm.size(); ++i) {
        const double area = pi * (edges_mm[i + 1] - edges_mm[i]) * (edges_mm[i + 1] + edges_mm[i]);
        double outer = edges_mm[i + 1];
        while (outer > edges_mm[i]) {
            const bool last = outer <= 2 * edges_mm[i] || outer < 1e-9 * edges_mm[i + 1];
            const double inner = last ? edges_mm[i] : 0.5 * outer;
            for (const Node& node : rule) {
                const double r = 0.5 * (inner + outer + (outer - inner) * node.x);
                radii.push_back(r);
                weights.push_back(pi * r * (outer - inner) * node.weight / area);
                annulus.push_back(i);
            }
            outer = inner;
        }
    }
    const std::vector<Rgb> Rd = radialRd(evaluator, model, medium, angle_deg, radii);
    std::vector<Rgb> means(edges_mm.size() < 2 ? 0 : edges_mm.size() - 1);
    for (std::size_t i = 0; i < radii.size(); ++i) means[annulus[i]] = means[annulus[i]] + weights[i] * Rd[i];
    return means;
}

Rgb totalRd(Evaluator& evaluator, const Model& model, const Medium& medium, double angle_deg) {
    const LengthRange lengths = lengthRange(medium);
    // A profile that goes as 1/r loses 1e-12 below; one that goes as 1/r^3, without absorption, loses 1e-12 beyond.
    const double from = 1e-12 * lengths.min, to = 1e12 * lengths.max;
    double step = 0.5;
    Rgb sum = logarithmicSum(evaluator, model, medium, angle_deg, from, to, step, 0);
    double last_change = 1;
    for (int halving = 0; halving < 5; ++halving) {
        const Rgb between = logarithmicSum(evaluator, model, medium, angle_deg, from, to, step, 0.5);
        const Rgb refined = 0.5 * (sum + between);
        step *= 0.5;
        double change = 0;
        for (int c = 0; c < Rgb::channels; ++c)
            if (std::isfinite(refined[c]) && refined[c] != 0)
                change = std::max(change, std::abs((refined[c] - sum[c]) / refined[c]));
        sum = refined;
        // A small change that halving the step does not halve is rounding: the model answers in single precision.
        if (change <= 1e-11 || (change < 1e-5 && change > 0.5 * last_change)) break;
        last_change = change;
    }
    return sum;
}

}  // namespace searchlight
