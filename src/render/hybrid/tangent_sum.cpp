#include "render/hybrid/tangent_sum.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "render/direct/probe_hits.h"

namespace searchlight {

namespace {

using Clock = std::chrono::steady_clock;

// Of a step, so that a picture comes in parts, and of a thread's task: some ten thousand lines.
constexpr std::size_t receivers_per_step = 8192, receivers_per_task = 32;

}  // namespace

void TangentSum::start(const RenderInput& input, const Profile& profile, int samples) {
    input_ = input;
    profile_ = &profile;
    samples_ = samples;
    next_ = 0;
    hits_ = 0;
    ms_ = 0;
    if (walk_of_ != input.versions.points) walk_.emplace(input.object->mesh);
    walk_of_ = input.versions.points;
    probes_.reset();
    if (!(profile.total() == Rgb{})) probes_.emplace(profile, *input.medium);
    if (probes_ && !probes_->usable()) probes_.reset();
}

bool TangentSum::step(std::span<Rgbf> exitance, Observer& observer) {
    if (!probes_ || next_ == exitance.size()) return true;
    const auto begin = Clock::now();
    const std::size_t last = std::min(next_ + receivers_per_step, exitance.size());
    std::vector<std::uint64_t> hits((last - next_ + receivers_per_task - 1) / receivers_per_task);
    parallelFor(hits.size(), input_.threads, [&](std::size_t task) {
        const std::size_t first = next_ + task * receivers_per_task;
        gather(first, std::min(first + receivers_per_task, last), exitance, observer, hits[task]);
    });
    hits_ = std::accumulate(hits.begin(), hits.end(), hits_);
    next_ = last;
    ms_ += std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    observer.progress("tangent planes", next_, exitance.size(), "receivers");
    return next_ == exitance.size();
}

void TangentSum::gather(std::size_t begin, std::size_t end, std::span<Rgbf> exitance, const Observer& observer,
                        std::uint64_t& hits) const {
    const ProbeHits found =
        findHits(*probes_, *input_.visible, begin, end, samples_, input_.light.seed, *input_.rays, *walk_, 1, observer);
    std::vector<Rgb> sums(end - begin);
    for (std::size_t k = 0; k < found.hits.size(); ++k) {
        const ProbeHit& hit = found.hits[k];
        const Rgb light = texture_->lightAt(found.places[k]);
        if (light == Rgb{}) continue;
        const double r =
            length(toDouble(found.points.positions[k]) - toDouble(input_.visible->positions[hit.receiver]));
        Rgb& sum = sums[hit.receiver - begin];
        sum = sum + hit.weight * (*profile_)(r)*light;
    }
    for (std::size_t i = begin; i < end; ++i) {
        const Rgb sum = toDouble(exitance[i]) + sums[i - begin];
        exitance[i] = toFloat(sum);
    }
    hits = found.hits.size();
}

void TangentSum::addTo(TechniqueReport& report) const {
    report.stage_ms["probes"] = ms_;
    report.interactions += hits_;
}

}  // namespace searchlight
