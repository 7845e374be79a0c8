#include "render/sphere/sphere_integral.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "model/physics.h"
#include "model/plane.h"
#include "render/sphere/directions.h"

namespace searchlight {

namespace {

constexpr std::size_t kSlice = 8192;     // cells at a time: some MiB of queries
constexpr std::size_t kChunk = 512;      // cells per piece of parallel work
constexpr double kSamplingError = 0.02;  // of the profile that only chooses places

std::vector<std::uint32_t> allCells(const Ball& ball) {
    std::vector<std::uint32_t> cells(ball.cellCount());
    std::iota(cells.begin(), cells.end(), 0u);
    return cells;
}

// As light leaves: density T21 cos / (pi 4 C_phi(1/eta)), by rejection from the cosine.
Vec3 leavingDirection(Vec3 normal, double eta, SplitMix64& random) {
    while (true) {
        const double u = random.uniform(), turn = 2 * std::numbers::pi * random.uniform(), chance = random.uniform();
        const double cosine = std::sqrt(1 - u);
        if (eta != 1 && chance >= 1 - Physics<double>::fresnelReflectance(cosine, 1 / eta)) continue;
        return directionAround(normal, cosine, turn);
    }
}

}  // namespace

SphereIntegral::SphereIntegral(const Ball& ball, const LightSampler& lights, const Model& model, Evaluator& evaluator,
                               const Medium& medium, SphereIntegralOptions options)
    : ball_(ball),
      lights_(lights),
      model_(model),
      evaluator_(evaluator),
      medium_(medium),
      options_(std::move(options)),
      light_(lights, ball.radius(), medium.eta),
      chords_(tabulate(evaluator, model, medium, kSamplingError).profile, medium, ball.radius()),
      transmitted_(medium.eta) {
    if (options_.cells.empty()) options_.cells = allCells(ball);
    sums_.resize(options_.cells.size());
}

// Two queries per cell from 2 * first on; a weight of 0 is an entry without light.
void SphereIntegral::addTo(std::size_t first, std::size_t count) {
    const double radius = ball_.radius();
    queries_.resize(2 * count);
    values_.resize(2 * count);
    weights_.resize(2 * count);
    parallelFor((count + kChunk - 1) / kChunk, options_.threads, [&](std::size_t chunk) {
        const std::size_t end = std::min(count, (chunk + 1) * kChunk);
        for (std::size_t i = chunk * kChunk; i < end; ++i) {
            const std::uint32_t cell = options_.cells[first + i];
            SplitMix64 random = streamOf(options_.seed, samples_ * ball_.cellCount() + cell);
            const double a = random.uniform(), b = random.uniform();
            const Vec3 no = directionInCell(ball_.cells(), cell, a, b);
            const Vec3 wo = model_.file.no_wo ? no : leavingDirection(no, medium_.eta, random);
            for (const bool by_light : {false, true}) {
                const std::size_t at = 2 * i + (by_light ? 1 : 0);
                weights_[at] = {};
                queries_[at] = {-radius * no, -1 * no, -1 * no,
                                radius * no,  wo,      no};  // counts for nothing, but is evaluated
                if (!by_light && !chords_.usable()) continue;
                const double u = random.uniform(), v = random.uniform(), w = random.uniform();
                const Vec3 ni = by_light ? light_.sample(u, v, w) : chords_.sample(no, u, v, w);
                const double choice = random.uniform(), x = random.uniform(), y = random.uniform();
                const LightSample light = lights_.sample(radius * ni, choice, x, y);
                const double cosine = dot(light.wi, ni);
                const double crossed = static_cast<double>(transmitted_(static_cast<float>(cosine)));
                const double r = radius * length(ni - no);
                if (!(crossed > 0) || !(r > 0)) continue;
                const double density = light_.density(ni) + chords_.density(r);
                weights_[at] = (crossed / density) * light.irradiance_over_pdf;
                queries_[at] = {radius * ni, light.wi, ni, radius * no, wo, no};
            }
        }
    });
    evaluator_.evaluate(queries_, values_);
    for (std::size_t i = 0; i < count; ++i)
        for (int c = 0; c < Rgb::channels; ++c) {
            if (!medium_.scatters(c)) continue;
            double value = 0;
            for (const std::size_t at : {2 * i, 2 * i + 1})
                if (weights_[at][c] > 0) value += weights_[at][c] * values_[at][c];
            if (!std::isfinite(value))
                throw inputError(fmt::format("the model {} is not finite somewhere on the sphere", model_.id))
                    .at(model_.file.path);
            sums_[first + i].value[c] += value;
            sums_[first + i].square[c] += value * value;
        }
}

void SphereIntegral::add(int samples, Observer& observer) {
    const std::size_t cells = options_.cells.size();
    const std::uint64_t total = static_cast<std::uint64_t>(samples) * cells;
    std::uint64_t added = 0;
    for (int i = 0; i < samples; ++i) {
        for (; done_ < cells; done_ += std::min(kSlice, cells - done_)) {
            if (observer.cancelled()) throw interruptedError();
            const std::size_t count = std::min(kSlice, cells - done_);
            addTo(done_, count);
            added += count;
            observer.progress("integrate", added, total, "samples");
        }
        done_ = 0;
        ++samples_;
    }
}

SphereExitance SphereIntegral::exitance() const {
    SphereExitance exitance;
    for (int c = 0; c < Rgb::channels; ++c) {
        if (!medium_.scatters(c)) continue;
        auto& mean = exitance.mean[static_cast<std::size_t>(c)];
        auto& error = exitance.standard_error[static_cast<std::size_t>(c)];
        mean.assign(ball_.cellCount(), 0.0);
        error.assign(ball_.cellCount(), 0.0);
        for (std::size_t i = 0; i < sums_.size(); ++i) {
            const Estimate estimate = estimateOf(i, c);
            mean[options_.cells[i]] = estimate.mean;
            error[options_.cells[i]] = estimate.standard_error;
        }
    }
    return exitance;
}

Estimate SphereIntegral::estimateOf(std::size_t i, int channel) const {
    // After an interruption the first cells have one sample more.
    const std::uint64_t count = samples_ + (i < done_ ? 1 : 0);
    if (count == 0) return {0, std::numeric_limits<double>::infinity(), 0};
    const double n = static_cast<double>(count), mean = sums_[i].value[channel] / n;
    const double variance = std::max(0.0, sums_[i].square[channel] / n - mean * mean);
    return {mean, count > 1 ? std::sqrt(variance / (n - 1)) : std::numeric_limits<double>::infinity(), count};
}

std::array<Estimate, Rgb::channels> SphereIntegral::left() const {
    std::array<Estimate, Rgb::channels> left;
    const double area = ball_.cells().area_mm2();
    for (int c = 0; c < Rgb::channels; ++c) {
        if (!medium_.scatters(c)) continue;
        double mean = 0, variance = 0;
        for (std::size_t i = 0; i < sums_.size(); ++i) {
            const Estimate estimate = estimateOf(i, c);
            mean += area * estimate.mean;
            variance += std::pow(area * estimate.standard_error, 2);
        }
        left[static_cast<std::size_t>(c)] = {mean, std::sqrt(variance), samples_ * sums_.size()};
    }
    return left;
}

}  // namespace searchlight
