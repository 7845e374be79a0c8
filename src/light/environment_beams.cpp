#include "light/environment_beams.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <iterator>

#include "light/stratified.h"

namespace searchlight {

namespace {

struct Part {
    Vec3 wi;
    Rgb irradiance;
};

double coordinate(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

int longestAxis(std::span<const Part> parts) {
    std::array<double, 3> extent{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto [low, high] =
            std::ranges::minmax_element(parts, {}, [&](const Part& part) { return coordinate(part.wi, axis); });
        extent[axis] = coordinate(high->wi, axis) - coordinate(low->wi, axis);
    }
    return static_cast<int>(std::ranges::max_element(extent) - extent.begin());
}

// Samples by importance carry equal luminance, so equal numbers of them are regions of equal luminance.
void split(std::span<Part> parts, int count, std::vector<EnvironmentBeam>& beams) {
    if (count == 1) {
        EnvironmentBeam beam{};
        for (const Part& part : parts) {
            beam.wi = beam.wi + luminance(part.irradiance) * part.wi;
            beam.irradiance = beam.irradiance + part.irradiance;
        }
        // Opposite halves may cancel; any of their directions then stands for them as well as another.
        beam.wi = length(beam.wi) > 1e-3 * luminance(beam.irradiance) ? normalize(beam.wi) : parts.front().wi;
        beams.push_back(beam);
        return;
    }
    const int axis = longestAxis(parts);
    std::ranges::stable_sort(parts, {}, [&](const Part& part) { return coordinate(part.wi, axis); });
    const int left = count / 2;
    const std::size_t cut = parts.size() * static_cast<std::size_t>(left) / static_cast<std::size_t>(count);
    split(parts.first(cut), left, beams);
    split(parts.subspan(cut), count - left, beams);
}

}  // namespace

std::vector<EnvironmentBeam> environmentBeams(const Environment& environment, int count, std::uint64_t seed) {
    assert(count >= 1);
    const StratifiedSequence sequence(seed);
    // 64 samples or more a region hold its flux to a few per cent; result() of the irradiance makes up for the rest.
    const std::uint32_t samples = std::bit_ceil(64 * static_cast<std::uint32_t>(count));
    std::vector<Part> parts;
    for (std::uint32_t i = 0; i < samples; ++i) {
        const auto [u, v] = sequence(i);
        const EnvironmentSample sample = environment.sample(u, v);
        if (sample.pdf > 0) parts.push_back({sample.wi, (1 / (sample.pdf * samples)) * sample.radiance});
    }
    std::vector<EnvironmentBeam> beams;
    if (!parts.empty()) split(parts, count, beams);
    return beams;
}

void appendFitted(std::vector<Beam> beams, const LitPoints& points, std::span<const Rgbf> transmitted,
                  std::vector<Beam>& to) {
    if (beams.empty()) return;
    Beam rest{std::vector<Vec3f>(points.size()), std::vector<Rgbf>(points.size())};
    for (std::size_t i = 0; i < points.size(); ++i) rest.wi[points.order[i]] = points.normals[i];
    for (std::size_t i = 0; i < transmitted.size(); ++i) {
        const Rgb target = toDouble(transmitted[i]);
        Rgb sum;
        for (const Beam& beam : beams) sum = sum + toDouble(beam.flux[i]);
        Rgb scale, missing;
        for (int c = 0; c < Rgb::channels; ++c) {
            // Up to twice: a region's flux spread around its centre differs from a beam by less than that.
            scale[c] = sum[c] > 0 ? std::min(2.0, target[c] / sum[c]) : 0;
            missing[c] = std::max(0.0, target[c] - scale[c] * sum[c]);
        }
        for (Beam& beam : beams) beam.flux[i] = toFloat(scale * toDouble(beam.flux[i]));
        rest.flux[i] = toFloat(missing);
    }
    std::ranges::move(beams, std::back_inserter(to));
    to.push_back(std::move(rest));
}

}  // namespace searchlight
