#include "transport/slab/slab_control.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "transport/walk/diffusion.h"

namespace searchlight {

namespace {

constexpr std::size_t kMoments = 64;
using Moments = std::array<double, kMoments>;

// psi has a pole at w = -1 / kappa: nearer, few events would tell all.
constexpr double kLargestKappa = 0.98;
// Without absorption the two solutions are 1 and z; here they differ from those by less than floats can tell.
constexpr double kLeastKappa = 1e-6;
// q, 1 on average, is cut where a term is less than this; a layer where that takes too many has no control.
constexpr double kCut = 1e-7;
constexpr std::size_t kMostTerms = 24;

// Moments of the phase function, as walks sample it.
Moments phaseMoments(const SlabWalk& walk, const SlabWalk::Layer& layer) {
    Moments moments{};
    if (layer.phase.count == 0) {
        for (std::size_t l = 0; l < kMoments; ++l) moments[l] = std::pow(layer.g, static_cast<double>(l));
        return moments;
    }
    const PhaseTables& tables = walk.tables;
    const auto first = static_cast<std::size_t>(layer.phase.first), count = static_cast<std::size_t>(layer.phase.count);
    std::vector<double> part(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double stays = static_cast<double>(tables.stay[first + i]) / PhaseTables::kStays;
        part[i] += stays / static_cast<double>(count);
        part[static_cast<std::size_t>(tables.alias[first + i]) - first] += (1 - stays) / static_cast<double>(count);
    }
    // Gauss-Legendre on each half of a bin: exact to degree 9.
    constexpr double nodes[] = {0, 0.5384693101056831, 0.9061798459386640};
    constexpr double weights[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
    for (std::size_t i = 0; i < count; ++i) {
        const double begin = static_cast<double>(tables.begin[first + i]),
                     a = static_cast<double>(tables.density[first + i]);
        const double width = static_cast<double>(tables.width[first + i]);
        for (int k = -2; k <= 2; ++k)
            for (const double half : {0.25, 0.75}) {
                const auto node = static_cast<std::size_t>(std::abs(k));
                const double t = half + (k < 0 ? -0.25 : 0.25) * nodes[node];
                const double weight = 0.25 * weights[node] * part[i] * (a + 2 * (1 - a) * t),
                             w = 1 - (begin + width * t);
                double before = 0, legendre = 1;
                for (std::size_t l = 0; l < kMoments; ++l) {
                    moments[l] += weight * legendre;
                    const double n = static_cast<double>(l);
                    before = std::exchange(legendre, ((2 * n + 1) * w * legendre - n * before) / (n + 1));
                }
            }
    }
    return moments;
}

// Legendre moments psi_l / psi_0 of the light that dies out as exp(-kappa z), [Chandrasekhar1960] chapter III:
// (2 l + 1) (1 - c phase_l) psi_l + kappa [(l + 1) psi_(l + 1) + l psi_(l - 1)] = 0. Returns what is left of l = 0,
// positive below the root.
double residue(double albedo, const Moments& phase, double kappa, Moments& psi) {
    std::array<double, kMoments + 1> ratio{};
    for (std::size_t l = kMoments - 1; l > 0; --l) {
        const double n = static_cast<double>(l);
        const double pivot = (2 * n + 1) * (1 - albedo * phase[l]) + kappa * (n + 1) * ratio[l + 1];
        if (!(pivot > 0)) return -1;
        ratio[l] = -kappa * n / pivot;
    }
    psi[0] = 1;
    for (std::size_t l = 1; l < kMoments; ++l) psi[l] = psi[l - 1] * ratio[l];
    return 1 - albedo + kappa * ratio[1];
}

std::optional<SlabControl::Layer> solve(const SlabWalk& walk, std::size_t index) {
    const SlabWalk::Layer& of = walk.layers[index];
    const double albedo = 1 - of.absorbed;
    const Moments phase = phaseMoments(walk, of);
    Moments psi{};
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (residue(albedo, phase, middle, psi) > 0 ? low : high) = middle;
    }
    SlabControl::Layer layer;
    layer.index = static_cast<std::int32_t>(index);
    layer.kappa = std::max(low, kLeastKappa);
    if (layer.kappa > kLargestKappa || residue(albedo, phase, layer.kappa, psi) == -1) return {};
    std::size_t terms = 2;
    const auto term = [&](std::size_t l) { return (2 * static_cast<double>(l) + 1) * albedo * phase[l] * psi[l]; };
    for (std::size_t l = 2; l < kMoments; ++l)
        if (std::abs(term(l)) > kCut) terms = l / 2 * 2 + 2;
    if (terms > kMostTerms) return {};
    std::vector<double> series;
    for (std::size_t l = 0; l < terms; ++l) series.push_back(term(l));
    const std::vector<double> powers = powersOfLegendre(series);
    for (std::size_t i = 0; i < terms; i += 2) {
        layer.even.push_back(powers[i]);
        layer.odd.push_back(powers[i + 1] / -layer.kappa);
    }
    const double depth = layer.kappa * of.thickness_mm / of.mfp_mm;
    layer.near = layer.kappa / std::tanh(depth);
    layer.far = layer.kappa / std::sinh(depth);
    if (walk.first != layer.index) return layer;
    const double w = walk.cos_beam;
    double even = 0, odd = 0;
    for (std::size_t i = layer.even.size(); i-- > 0;) {
        even = even * w * w + layer.even[i];
        odd = odd * w * w + layer.odd[i];
    }
    const double kw = layer.kappa * w, per = 1 / ((1 - kw) * (1 + kw));
    layer.entry_near = per * (even + kw * kw * odd - layer.near * w * (even + odd));
    layer.entry_far = per * layer.far * w * (even + odd);
    return layer;
}

}  // namespace

SlabControl::SlabControl(const SlabWalk& walk) : unscattered(slabUnscattered(walk)) {
    // Walks leave in the outermost layers; what lies deep among many matters least.
    const std::size_t count = walk.layers.size();
    for (std::size_t i = 0; i < count && layers.size() < kMostLayers; ++i) {
        const std::size_t index = i % 2 == 0 ? i / 2 : count - 1 - i / 2;
        const SlabWalk::Layer& layer = walk.layers[index];
        if (layer.mfp_mm > 1e20 || layer.thickness_mm == 0) continue;  // clear, or not there
        if (std::optional<Layer> solved = solve(walk, index)) layers.push_back(std::move(*solved));
    }
}

std::vector<double> SlabControl::controls(std::span<const double> sums, double R_unscattered, double T_unscattered,
                                          double walks) const {
    std::vector<double> result;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const Layer& layer = layers[i];
        const std::span<const double> at = sums.subspan(kSums * i, kSums);
        // In thin layers both are large; those of all layers are to compare.
        const double scale = 1 / (1 + layer.near);
        result.push_back(scale * (walks * layer.entry_near + at[0] - layer.near * at[1] + layer.far * at[3]));
        result.push_back(scale * (walks * layer.entry_far + at[2] - layer.near * at[3] + layer.far * at[1]));
    }
    // What hardly ever happens would get its slope from a handful of walks.
    constexpr double rare = 0.02;
    const auto counted = [&](double found, double part) {
        return part > rare && part < 1 - rare ? found - walks * part : 0.0;
    };
    result.push_back(counted(R_unscattered, unscattered.R));
    result.push_back(counted(T_unscattered, unscattered.T));
    return result;
}

}  // namespace searchlight
