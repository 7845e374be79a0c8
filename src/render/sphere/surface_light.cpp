#include "render/sphere/surface_light.h"

#include <algorithm>

#include "base/random.h"
#include "light/transmitted_cosine.h"
#include "render/sphere/directions.h"

namespace searchlight {

namespace {

constexpr int kRows = 48, kColumns = 96;  // cells of 3.75 degrees: the density only has to be near
constexpr int kPoints = 16;               // per cell
constexpr double kEverywhere = 0.1;

double probabilityOf(const std::vector<double>& cumulative, std::size_t cell) {
    return cumulative[cell] - (cell > 0 ? cumulative[cell - 1] : 0);
}

}  // namespace

SurfaceLight::SurfaceLight(const LightSampler& lights, double radius_mm, double eta)
    : cells_{radius_mm, kRows, kColumns} {
    const TransmittedCosine transmitted(eta);
    std::vector<double> brightness(cells_.size());
    double sum = 0;
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
        SplitMix64 random = streamOf(0, cell);
        for (int i = 0; i < kPoints; ++i) {
            const double u = random.uniform(), v = random.uniform();
            const Vec3 normal = directionInCell(cells_, cell, u, v);
            const double light = random.uniform(), a = random.uniform(), b = random.uniform();
            const LightSample sample = lights.sample(radius_mm * normal, light, a, b);
            brightness[cell] += luminance(sample.irradiance_over_pdf) *
                                static_cast<double>(transmitted(static_cast<float>(dot(sample.wi, normal))));
        }
        sum += brightness[cell];
    }
    double total = 0;
    for (const double value : brightness) {
        const double even = 1.0 / static_cast<double>(cells_.size());
        total += sum > 0 ? (1 - kEverywhere) * value / sum + kEverywhere * even : even;
        cumulative_.push_back(total);
    }
    for (double& value : cumulative_) value /= total;
}

Vec3 SurfaceLight::sample(double u, double v, double w) const {
    const auto found = std::ranges::upper_bound(cumulative_, u) - cumulative_.begin();
    return directionInCell(cells_, std::min(static_cast<std::size_t>(found), cells_.size() - 1), v, w);
}

double SurfaceLight::density(Vec3 direction) const {
    return probabilityOf(cumulative_, cells_.at(direction)) / cells_.area_mm2();
}

}  // namespace searchlight
