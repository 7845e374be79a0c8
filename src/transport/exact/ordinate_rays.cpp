#include "transport/exact/ordinate_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "transport/walk/fresnel.h"

namespace searchlight {

namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

// Indices closer than this have no total reflection of their own.
constexpr double kSameIndex = 1e-9;
// A range of cosines that has its full number of points.
constexpr double kWidePanel = 0.6;

// Those below the highest of the layers that scatter, where total reflection begins, and that one; ascending. No light
// gets into the directions beyond.
std::vector<double> indices(const OrdinateStack& stack) {
    double highest = 0;
    for (const OrdinateStack::Layer& layer : stack.layers)
        if (layer.sigma_s > 0) highest = std::max(highest, layer.n);
    std::vector<double> all{stack.n_above, stack.n_below}, kept;
    for (const OrdinateStack::Layer& layer : stack.layers) all.push_back(layer.n);
    std::sort(all.begin(), all.end());
    for (const double n : all)
        if (n <= highest && (kept.empty() || n > kept.back() + kSameIndex)) kept.push_back(n);
    return kept;
}

// Cosine in a medium of index n of light with the invariant xi = n sin.
double cosineIn(double n, double xi) { return std::sqrt(std::max(0.0, (n - xi) * (n + xi))) / n; }

double reflectance(double n, double beyond, double xi) {
    if (xi >= n || xi >= beyond) return 1;
    return n == beyond ? 0 : fresnelReflectance(n, cosineIn(n, xi), beyond, cosineIn(beyond, xi));
}

double indexAt(const OrdinateStack& stack, std::size_t layer, bool up) {
    if (up) return layer == 0 ? stack.n_above : stack.layers[layer - 1].n;
    return layer + 1 == stack.layers.size() ? stack.n_below : stack.layers[layer + 1].n;
}

// Straight through the layers between one and the outside.
Complex wayOut(const OrdinateStack& stack, std::size_t from, bool up, double xi, double along_per_sine, Complex rate) {
    Complex passes = 1;
    for (std::size_t at = from;; at = up ? at - 1 : at + 1) {
        const OrdinateStack::Layer& layer = stack.layers[at];
        if (std::isinf(layer.thickness) && !up) return 0;
        const double F = reflectance(layer.n, indexAt(stack, at, up), xi);
        if (F == 1) return 0;
        if (at != from) {
            const double sine = xi / layer.n, cosine = cosineIn(layer.n, xi);
            passes *= std::exp(-(layer.sigma_t - rate * sine * along_per_sine) / cosine * layer.thickness);
        }
        passes *= 1 - F;
        if (at == (up ? 0 : stack.layers.size() - 1)) return passes;
    }
}

// All azimuths at one cosine. They are crowded about those across the wave, where the decay varies, in proportion to
// the mean free path times the rate.
void add(LayerRays& rays, const OrdinateStack& stack, std::size_t at, double xi, double mu, double weight,
         const GaussRule& rule, Complex rate) {
    const OrdinateStack::Layer& layer = stack.layers[at];
    double reach = 0;
    for (const OrdinateStack::Layer& other : stack.layers)
        if (xi < other.n && other.sigma_t > 0) reach = std::max(reach, xi / (other.n * other.sigma_t));
    const double width = 1 / std::hypot(1, std::abs(rate) * reach), end = std::asinh(0.5 * pi / width);
    const double sine = xi / layer.n;
    double all = 0;  // of a full circle, but for the quadrature
    for (std::size_t j = 0; j < rule.x.size(); ++j) all += rule.weight[j] * std::cosh(end * (2 * rule.x[j] - 1));
    for (std::size_t j = 0; j < rule.x.size(); ++j) {
        const double x = end * (2 * rule.x[j] - 1), angle = width * std::sinh(x);
        rays.set.mu.push_back(mu);
        rays.set.weight.push_back(weight * 2 * pi * rule.weight[j] * std::cosh(x) / all);
        rays.set.phi.push_back(0.5 * pi - angle);
        rays.along.push_back(sine * std::sin(angle));
        rays.across.push_back(sine * std::cos(angle));
        rays.F_up.push_back(reflectance(layer.n, indexAt(stack, at, true), xi));
        rays.F_down.push_back(std::isinf(layer.thickness) ? 0 : reflectance(layer.n, indexAt(stack, at, false), xi));
        rays.Q.push_back((layer.sigma_t - rate * rays.along.back()) / mu);
        rays.up.push_back(wayOut(stack, at, true, xi, std::sin(angle), rate));
        rays.down.push_back(wayOut(stack, at, false, xi, std::sin(angle), rate));
    }
}

}  // namespace

std::vector<LayerRays> stackRays(const OrdinateStack& stack, const StackCount& count, Complex rate) {
    const std::vector<double> n = indices(stack);
    const GaussRule azimuths = gaussRule(count.azimuths);
    std::vector<LayerRays> layers(stack.layers.size());
    for (std::size_t panel = 0; panel < n.size(); ++panel) {
        const double low = panel == 0 ? 0 : n[panel - 1], high = n[panel];
        int cosines = n.size() > 1 ? count.escaping : count.escaping + count.alone;
        if (panel > 0) {
            // Fewer where the panel is narrow.
            const double part = (cosineIn(n.back(), low) - cosineIn(n.back(), high)) / kWidePanel;
            cosines = std::max(count.narrow, static_cast<int>(std::ceil(count.trapped * std::min(1.0, part + 0.1))));
        }
        const GaussRule rule = gaussRule(cosines);
        // In t = sqrt(high^2 - xi^2), all cosines and Fresnel terms are smooth.
        const double range = std::sqrt((high - low) * (high + low));
        for (std::size_t at = 0; at < layers.size(); ++at) {
            const double index = stack.layers[at].n;
            if (index < high - kSameIndex) continue;
            const double least = std::max(0.0, (index - high) * (index + high));
            const auto cosine = [&](double t) { return std::sqrt(least + t * t) / index; };
            const auto weight = [&](std::size_t i) {
                const double t = range * rule.x[i];
                return range * rule.weight[i] * t / (index * index * cosine(t));
            };
            // Where the index is just above the panel, the cosine is not that smooth, and the weights lack a little of
            // the panel's range.
            double sum = 0;
            for (std::size_t i = 0; i < rule.x.size(); ++i) sum += weight(i);
            const double scale = (cosine(range) - cosine(0)) / sum;
            layers[at].set.azimuths = azimuths.x.size();
            layers[at].panels.push_back({low, high, layers[at].size(), rule.x.size() * azimuths.x.size()});
            for (std::size_t i = rule.x.size(); i-- > 0;) {
                const double t = range * rule.x[i], xi = std::sqrt((high - t) * (high + t));
                add(layers[at], stack, at, xi, cosine(t), scale * weight(i), azimuths, rate);
            }
        }
    }
    return layers;
}

LayerRays fineRays(const OrdinateStack& stack, std::size_t at, const StackCount& count, Complex rate) {
    const OrdinateStack::Layer& layer = stack.layers[at];
    const GaussRule rule = gaussRule(count.second_panel), trapped = gaussRule(count.second_trapped),
                    azimuths = gaussRule(count.second_azimuths);
    LayerRays rays;
    rays.set.azimuths = azimuths.x.size();
    const auto put = [&](double mu, double sine, double weight) {
        add(rays, stack, at, layer.n * sine, mu, weight, azimuths, rate);
    };
    std::vector<double> edges;  // cosines of the critical angles, descending
    for (const double n : indices(stack))
        if (n < layer.n - kSameIndex) edges.push_back(cosineIn(layer.n, n));
    // Up to the first critical angle: crowded towards the normal, where sines are of the size of 1 / |rate|, and
    // towards its end, where the square smooths the root in the transmittance.
    const double critical = edges.empty() ? 0.5 * pi : std::acos(edges.front()), middle = 0.5 * critical;
    const double width = 1 / std::hypot(1, std::abs(rate) / layer.sigma_t), end = std::asinh(middle / width);
    for (std::size_t i = 0; i < rule.x.size(); ++i) {
        const double x = rule.x[i], w = rule.weight[i];
        const auto angle = [&](double theta, double weight) {
            put(std::cos(theta), std::sin(theta), std::sin(theta) * weight);
        };
        angle(width * std::sinh(end * x), end * width * std::cosh(end * x) * w);
        angle(critical - (critical - middle) * x * x, 2 * (critical - middle) * x * w);
    }
    for (std::size_t k = 0; k < edges.size(); ++k) {
        const double high = edges[k], low = k + 1 < edges.size() ? edges[k + 1] : 0;
        const double range = std::sqrt((high - low) * (high + low));
        for (std::size_t i = 0; i < trapped.x.size(); ++i) {
            const double t = range * trapped.x[i], mu = std::hypot(low, t);
            put(mu, std::sqrt((1 - mu) * (1 + mu)), range * trapped.weight[i] * t / mu);
        }
    }
    return rays;
}

}  // namespace searchlight
