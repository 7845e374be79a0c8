#include "transport/slab/slab_single.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "transport/half_space/quadrature.h"
#include "transport/walk/fresnel.h"

namespace searchlight {

namespace {

// The beam that has not met a scatterer, with all reflections between the interfaces.
struct Unscattered {
    std::vector<double> down, up;  // per layer: enters it at its top, at its bottom
    double above = 0, below = 0;   // leaves
};

double normalReflectance(double eta) { return std::pow((eta - 1) / (eta + 1), 2); }

Unscattered unscatteredIn(const SlabWalk& walk) {
    const std::vector<SlabWalk::Layer>& layers = walk.layers;
    const std::size_t count = layers.size();
    Unscattered beam{std::vector<double>(count), std::vector<double>(count)};
    std::vector<double> falls(count), rises(count);  // what has still to be followed
    falls[static_cast<std::size_t>(walk.first)] = 1;
    constexpr double nothing = 1e-14;
    for (double rest = 1; rest > nothing;) {
        double light = 0;
        for (std::size_t i = 0; i < count; ++i) {
            light += std::exchange(falls[i], 0.0);
            beam.down[i] += light;
            light *= std::exp(-layers[i].thickness_mm / layers[i].mfp_mm);
            const double back = normalReflectance(layers[i].eta_down) * light;
            rises[i] += back;
            light -= back;
        }
        beam.below += light;
        light = rest = 0;
        for (std::size_t i = count; i-- > 0;) {
            light += std::exchange(rises[i], 0.0);
            beam.up[i] += light;
            light *= std::exp(-layers[i].thickness_mm / layers[i].mfp_mm);
            const double back = normalReflectance(layers[i].eta_up) * light;
            falls[i] += back;
            rest += back;
            light -= back;
        }
        beam.above += light;
    }
    return beam;
}

// A straight way out of a layer through the others.
struct Way {
    double passes = 1, tau = 0, lateral = 0;  // beyond the layer
};

class WaysOut {
public:
    WaysOut(const SlabWalk& walk, std::size_t layer, bool up) : walk_(walk), layer_(layer), up_(up) {
        double index = 1, least = 1;  // refractive index, in units of that of the layer
        for (std::size_t at = layer;; at = up ? at - 1 : at + 1) {
            index /= eta(at);
            least = std::min(least, index);
            if (at == end()) break;
        }
        critical = least < 1 ? std::sqrt((1 - least) * (1 + least)) : 0;
    }

    Way at(double sine) const {
        Way way;
        double index = 1;
        for (std::size_t at = layer_;; at = up_ ? at - 1 : at + 1) {
            const SlabWalk::Layer& layer = walk_.layers[at];
            const double leg_sine = std::min(sine / index, 1.0);
            const double cosine = std::sqrt((1 - leg_sine) * (1 + leg_sine));
            if (cosine == 0) return {0, 0, 0};
            if (at != layer_) {
                way.tau += layer.thickness_mm / layer.mfp_mm / cosine;
                way.lateral += layer.thickness_mm * leg_sine / cosine;
            }
            way.passes *= 1 - internalReflectance(eta(at), cosine);
            if (at == end()) return way;
            index /= eta(at);
        }
    }

    double critical = 0;

private:
    std::size_t end() const { return up_ ? 0 : walk_.layers.size() - 1; }
    double eta(std::size_t at) const { return up_ ? walk_.layers[at].eta_up : walk_.layers[at].eta_down; }

    const SlabWalk& walk_;
    std::size_t layer_;
    bool up_;
};

// Integral of exp(-rate h) from 0 to h.
double decayed(double rate, double h) {
    if (rate * h < 1e-8) return h * (1 - 0.5 * rate * h);
    return -std::expm1(-rate * h) / rate;
}

}  // namespace

SlabSingle slabSingle(const SlabWalk& walk, std::span<const double> edges, const std::vector<char>& foresees) {
    const Unscattered beam = unscatteredIn(walk);
    SlabSingle single{std::vector<double>(edges.size() + 1), std::vector<double>(edges.size() + 1), beam.above,
                      beam.below};
    for (std::size_t i = 0; i < walk.layers.size(); ++i) {
        if (!foresees[i]) continue;
        const SlabWalk::Layer& layer = walk.layers[i];
        const double thickness = layer.thickness_mm, g = layer.g, per_mm = 1 / layer.mfp_mm;
        const double through = std::exp(-thickness * per_mm);
        for (const bool up : {true, false}) {
            if (!up && std::isinf(walk.layers.back().thickness_mm)) continue;
            const WaysOut ways(walk, i, up);
            std::vector<double>& flux = up ? single.reflected : single.transmitted;
            // At the distance h from the side where it leaves, light of the beam from that side has decayed by
            // exp(-h), of the beam towards it by exp(h - thickness).
            const double against = up ? beam.down[i] : beam.up[i], along = up ? beam.up[i] : beam.down[i];
            const auto add = [&](double mu, double one_minus_mu, double dmu) {
                const double sine = std::sqrt(one_minus_mu * (1 + mu));
                const Way way = ways.at(sine);
                const auto phase = [&](double cosine) {
                    return 0.5 * (1 - g * g) / std::pow(1 + g * g - 2 * g * cosine, 1.5);
                };
                const double weight = (1 - layer.absorbed) * per_mm * way.passes * std::exp(-way.tau) * dmu;
                const double towards = weight * against * phase(-mu), with = weight * along * through * phase(mu);
                const double towards_rate = per_mm * (1 / mu + 1), with_rate = per_mm * one_minus_mu / mu;
                double inner = 0;
                for (std::size_t k = 0; k <= edges.size(); ++k) {
                    double h = thickness;
                    if (k < edges.size() && sine * thickness > (edges[k] - way.lateral) * mu)
                        h = std::max(0.0, (edges[k] - way.lateral) * mu / sine);
                    const double outer =
                        towards * decayed(towards_rate, h) + (with > 0 ? with * decayed(with_rate, h) : 0);
                    flux[k] += outer - inner;
                    inner = outer;
                    if (h == thickness) break;
                }
            };
            // As in single_scattering.cpp. Annuli end within a panel where the layer does: many narrow ones.
            constexpr int parts = 8;
            const double critical = ways.critical, range = 1 - critical;
            integrateTowardsZero(0.5, parts, [&](double q, double dq) {
                add(critical + range * q * q, range * (1 - q * q), range * 2 * q * dq);
            });
            integrateTowardsZero(std::sqrt(0.5), parts, [&](double p, double dp) {
                const double q = 1 - p * p;
                add(critical + range * q * q, range * p * p * (1 + q), range * 4 * q * p * dp);
            });
        }
    }
    return single;
}

}  // namespace searchlight
