#include "render/light_view/light_view_sum.h"

#include <fmt/format.h>

#include <chrono>

#include "light/single_lights.h"

namespace searchlight {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::time_point since) {
    return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

// Of the sum over grazed places, which bring some per cent at most.
constexpr double grazed_error = 0.01;

}  // namespace

void LightViewSum::start(const RenderInput& input, const Profile& profile, std::uint64_t profile_version, int samples,
                         int resolution, Observer& observer) {
    const auto begin = Clock::now();
    input_ = input;
    samples_ = samples;
    next_ = 0;
    filter_ms_ = 0;
    const std::string maps = fmt::format("{} {} {}", input.versions.points, input.versions.light, resolution);
    if (maps != maps_from_) {
        maps_from_.clear();
        filter_from_.clear();
        maps_ = lightMaps(input, resolution, observer);
        grazed_.reset();
        if (!maps_.grazed_light.empty()) {
            grazed_.emplace(maps_.grazed, input.threads);
            grazed_->setTransmitted(maps_.grazed_light, input.threads);
        }
        maps_from_ = maps;
    }
    const double reach = 2 * boundingRadius(*input.object);
    const std::string filter = fmt::format("{} {} {} {}", profile_version, samples, reach, input.light.seed);
    if (filter != filter_from_) {
        filter_from_.clear();
        filter_.reset();
        if (!(profile.total() == Rgb{})) filter_.emplace(profile, samples, reach, input.light.seed);
        if (grazed_) grazed_table_.emplace(profile, grazed_->meanArea());
        filter_from_ = filter;
    }
    if (receivers_of_ != input.versions.view) {
        receivers_ = RingReceivers(*input.visible);
        grazed_receivers_.reset();
    }
    if (grazed_ && filter_ && !grazed_receivers_) grazed_receivers_.emplace(input.visible->positions, input.threads);
    receivers_of_ = input.versions.view;
    maps_ms_ = milliseconds(begin);
}

bool LightViewSum::step(std::span<Rgbf> exitance, Observer& observer) {
    if (!filter_) return true;
    const auto begin = Clock::now();
    if (next_ == maps_.maps.size()) {
        if (grazed_) addGrazed(exitance, observer);
        filter_ms_ += milliseconds(begin);
        return true;
    }
    filter_->gather(maps_.maps[next_], receivers_, input_.threads, observer, exitance);
    ++next_;
    filter_ms_ += milliseconds(begin);
    observer.progress("light views", next_, maps_.maps.size(), "maps");
    return next_ == maps_.maps.size() && !grazed_;
}

void LightViewSum::addGrazed(std::span<Rgbf> exitance, Observer& observer) const {
    const std::vector<Rgbf> more =
        sumExitance(*grazed_, *grazed_table_, *grazed_receivers_,
                    {.error = grazed_error, .threads = input_.threads, .observer = &observer});
    for (std::size_t i = 0; i < more.size(); ++i) {
        Rgbf& m = exitance[i];
        m = {m.r + more[i].r, m.g + more[i].g, m.b + more[i].b};
    }
}

void LightViewSum::addTo(TechniqueReport& report) const {
    report.stage_ms["maps"] = maps_ms_;
    report.stage_ms["filter"] = filter_ms_;
    report.interactions += static_cast<std::uint64_t>(next_) * static_cast<std::uint64_t>(samples_) * receivers_.count;
    report.numbers["light_views"] = maps_.views;
    report.numbers["light_texels"] = static_cast<double>(maps_.texels);
    if (filter_) {
        report.numbers["rings"] = filter_->rings();
        report.numbers["spokes"] = filter_->spokes();
    }
    if (maps_.spread_lights > 0)
        report.notes.emplace_back(
            "A light without a view of its own (a disc, an environment, a point close to the object) is read in maps "
            "from 14 directions: what none of them sees is dark, and the filter costs as many times more.");
}

}  // namespace searchlight
