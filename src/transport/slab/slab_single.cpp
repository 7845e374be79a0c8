#include "transport/slab/slab_single.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "transport/walk/decay.h"
#include "transport/walk/fresnel.h"
#include "transport/walk/quadrature.h"

namespace searchlight {

namespace {

// A straight way out of a layer through the others.
struct Way {
    double passes = 1, tau = 0, lateral = 0;  // beyond the layer
};

class WaysOut {
public:
    WaysOut(const SlabWalk& walk, std::size_t layer, bool up) : walk_(walk), layer_(layer), up_(up) {
        double least = 1;
        for (std::size_t at = layer;; at = up ? at - 1 : at + 1) {
            index /= eta(at);
            least = std::min(least, index);
            if (at == end()) break;
        }
        critical = least < 1 ? std::sqrt((1 - least) * (1 + least)) : 0;
    }

    Way at(double sine) const {
        Way way;
        double relative = 1;  // refractive index
        for (std::size_t at = layer_;; at = up_ ? at - 1 : at + 1) {
            const SlabWalk::Layer& layer = walk_.layers[at];
            const double leg_sine = std::min(sine / relative, 1.0);
            const double cosine = std::sqrt((1 - leg_sine) * (1 + leg_sine));
            if (cosine == 0) return {0, 0, 0};
            if (at != layer_) {
                way.tau += layer.thickness_mm / layer.mfp_mm / cosine;
                way.lateral += layer.thickness_mm * leg_sine / cosine;
            }
            way.passes *= 1 - internalReflectance(eta(at), cosine);
            if (at == end()) return way;
            relative /= eta(at);
        }
    }

    double critical = 0;
    double index = 1;  // refractive index outside, in units of that of the layer

private:
    std::size_t end() const { return up_ ? 0 : walk_.layers.size() - 1; }
    double eta(std::size_t at) const { return up_ ? walk_.layers[at].eta_up : walk_.layers[at].eta_down; }

    const SlabWalk& walk_;
    std::size_t layer_;
    bool up_;
};

// What leaves along one direction, from so near to the side where it leaves: of light of the beam that came from there,
// and of light that came towards it.
struct Straight {
    double sine, lateral, towards, towards_rate, with, with_rate;

    double within(double h) const {
        const auto collide = [h](double rate) { return decayed(rate, std::exp(-rate * h), h); };
        return towards * collide(towards_rate) + (with > 0 ? with * collide(with_rate) : 0);
    }
};

}  // namespace

double SlabUnscattered::collides(const SlabWalk::Layer& layer, std::size_t index, double from_mm, double to_mm) const {
    const double rate = 1 / (layer.mfp_mm * cosine[index]);
    const auto between = [&](double near, double far) {
        return std::exp(-rate * near) * -std::expm1(-rate * (far - near));
    };
    const double falls = down[index] > 0 ? down[index] * between(from_mm, to_mm) : 0;
    if (!(up[index] > 0)) return falls;
    return falls + up[index] * between(layer.thickness_mm - to_mm, layer.thickness_mm - from_mm);
}

SlabUnscattered slabUnscattered(const SlabWalk& walk) {
    const std::vector<SlabWalk::Layer>& layers = walk.layers;
    const std::size_t count = layers.size(), first = static_cast<std::size_t>(walk.first);
    SlabUnscattered beam{std::vector<double>(count), std::vector<double>(count), std::vector<double>(count, 1)};
    const auto cosineOf = [&](double index) {  // in units of that of the first layer
        const double sine = std::min(walk.sin_beam / index, 1.0);
        return std::sqrt((1 - sine) * (1 + sine));
    };
    double index = 1;
    for (std::size_t i = first; i < count; ++i) {
        beam.cosine[i] = cosineOf(index);
        index /= layers[i].eta_down;
    }
    index = 1;
    for (std::size_t i = first; i-- > 0;) {
        index /= layers[i + 1].eta_up;
        beam.cosine[i] = cosineOf(index);
    }
    const auto passes = [&](std::size_t i) {
        return beam.cosine[i] > 0 ? std::exp(-layers[i].thickness_mm / (layers[i].mfp_mm * beam.cosine[i])) : 0.0;
    };
    const auto reflects = [&](double eta, std::size_t i) {
        return beam.cosine[i] > 0 ? internalReflectance(eta, beam.cosine[i]) : 1.0;
    };
    std::vector<double> falls(count), rises(count);  // what has still to be followed
    falls[first] = 1;
    constexpr double nothing = 1e-14;
    constexpr int rounds = 10'000;  // glass that reflects nearly all of it keeps what is left
    double rest = 1;
    for (int round = 0; rest > nothing && round < rounds; ++round) {
        double light = 0;
        for (std::size_t i = 0; i < count; ++i) {
            light += std::exchange(falls[i], 0.0);
            beam.down[i] += light;
            light *= passes(i);
            const double back = reflects(layers[i].eta_down, i) * light;
            rises[i] += back;
            light -= back;
        }
        beam.T += light;
        light = rest = 0;
        for (std::size_t i = count; i-- > 0;) {
            light += std::exchange(rises[i], 0.0);
            beam.up[i] += light;
            light *= passes(i);
            const double back = reflects(layers[i].eta_up, i) * light;
            falls[i] += back;
            rest += back;
            light -= back;
        }
        beam.R += light;
    }
    return beam;
}

SlabSingle slabSingle(const SlabWalk& walk, std::span<const double> edges, const std::vector<char>& foresees,
                      std::size_t angles) {
    const SlabUnscattered beam = slabUnscattered(walk);
    SlabSingle single{std::vector<double>(edges.size() + 1), std::vector<double>(edges.size() + 1),
                      std::vector<double>(angles), std::vector<double>(angles)};
    for (std::size_t i = 0; i < walk.layers.size(); ++i) {
        if (!foresees[i]) continue;
        const SlabWalk::Layer& layer = walk.layers[i];
        const double thickness = layer.thickness_mm, g = layer.g, per_mm = 1 / layer.mfp_mm;
        const double through = std::exp(-thickness * per_mm);
        for (const bool up : {true, false}) {
            if (!up && std::isinf(walk.layers.back().thickness_mm)) continue;
            const WaysOut ways(walk, i, up);
            std::vector<double>& flux = up ? single.reflected : single.transmitted;
            std::vector<double>& flux_a = up ? single.reflected_a : single.transmitted_a;
            // At the distance h from the side where it leaves, light of the beam from that side has decayed by
            // exp(-h), of the beam towards it by exp(h - thickness).
            const double against = up ? beam.down[i] : beam.up[i], along = up ? beam.up[i] : beam.down[i];
            const auto at = [&](double mu, double one_minus_mu, double dmu) {
                const double sine = std::sqrt(one_minus_mu * (1 + mu));
                const Way way = ways.at(sine);
                const auto phase = [&](double cosine) {
                    const double q = 1 + g * g - 2 * g * cosine;
                    return 0.5 * (1 - g * g) / (q * std::sqrt(q));
                };
                const double weight = (1 - layer.absorbed) * per_mm * way.passes * std::exp(-way.tau) * dmu;
                const double towards = weight * against * phase(-mu), with = weight * along * through * phase(mu);
                const double towards_rate = per_mm * (1 / mu + 1), with_rate = per_mm * one_minus_mu / mu;
                return Straight{sine, way.lateral, towards, towards_rate, with, with_rate};
            };
            const auto add = [&](double mu, double one_minus_mu, double dmu) {
                const Straight ray = at(mu, one_minus_mu, dmu);
                double inner = 0;
                for (std::size_t k = 0; k <= edges.size(); ++k) {
                    double h = thickness;
                    if (k < edges.size() && ray.sine * thickness > (edges[k] - ray.lateral) * mu)
                        h = std::max(0.0, (edges[k] - ray.lateral) * mu / ray.sine);
                    const double outer = ray.within(h);
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
            // Outside, parts of equal width in the angle.
            const double part = 0.5 * std::numbers::pi / static_cast<double>(angles), index = ways.index;
            for (std::size_t a = 0; a < angles; ++a)
                integrateTowardsZero(part, 2, [&](double offset, double step) {
                    const double angle = part * static_cast<double>(a + 1) - offset;
                    const double sine = std::sin(angle) * index;
                    if (sine >= 1) return;
                    const double mu = std::sqrt((1 - sine) * (1 + sine));
                    const double one_minus_mu = sine * sine / (1 + mu);
                    flux_a[a] += at(mu, one_minus_mu, sine * std::cos(angle) * index / mu * step).within(thickness);
                });
        }
    }
    return single;
}

}  // namespace searchlight
