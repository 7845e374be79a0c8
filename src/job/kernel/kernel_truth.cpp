#include "job/kernel/kernel_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "job/plot/curves.h"
#include "kernel/cells.h"
#include "model/plane.h"

namespace searchlight {

namespace {

KernelTruth walked(const Subject& subject, const KernelTruthOptions& options, double shortest, double longest,
                   Observer& observer) {
    const Medium& medium = subject.medium;
    ReferenceOptions walk;
    walk.walks = options.walks;
    walk.seed = options.seed;
    walk.threads = options.threads;
    walk.white = true;
    double reach = 32 * longest;
    for (int c = 0; c < medium.channels; ++c) {
        if (!medium.scatters(c)) continue;
        walk.white = walk.white && medium.sigma_s[c] <= kWhiteLargestAlbedo * (medium.sigma_a[c] + medium.sigma_s[c]);
        const double decay = std::sqrt(3 * medium.sigma_a[c] * medium.sigmaTp()[c]);
        // Ten diffuse mean free paths hold all but 1e-4 of the energy, as far as there is absorption.
        if (decay > 0) reach = std::max(reach, std::min(10 / decay, 200 * longest));
    }
    walk.edges_mm = {0};
    const double cell = shortest / 20;
    // 6 % apart, beginning where single scattering has long been a power of the radius.
    for (double r = options.bins_of_grid ? cell : 1e-3 * shortest; walk.edges_mm.back() < reach;) {
        walk.edges_mm.push_back(r);
        r = options.bins_of_grid ? r + cell * std::max(1.0, std::floor(0.06 * r / cell)) : 1.06 * r;
    }
    const ReferenceRun run = runReference(medium, walk, observer);
    const PencilReference curve = run.curve();
    std::vector<double> radii;
    std::vector<Rgb> values;
    for (std::size_t i = 0; i + 1 < curve.edges_mm.size(); ++i) {
        radii.push_back(0.5 * (curve.edges_mm[i] + curve.edges_mm[i + 1]));
        Rgb value = curve.Rd[i];
        for (int c = 0; c < Rgb::channels; ++c)
            if (!std::isfinite(value[c])) value[c] = 0;
        values.push_back((1 / pencilBeam(medium.eta, 0).transmittance) * value);
    }
    double tail = 0;
    for (const auto& channel : run.channels)
        if (channel && channel->all.total.mean > 0)
            tail = std::max(tail, channel->all.beyond.front() / channel->all.total.mean);
    return {GroundTruth(Profile(std::move(radii), std::move(values)), tail), curve.label, shortest, longest};
}

}  // namespace

KernelTruth kernelTruth(const Subject& subject, const KernelTruthOptions& options, Engine& engine, Observer& observer) {
    const Medium& medium = subject.medium;
    double shortest = 0, longest = 0;
    for (int c = 0; c < medium.channels; ++c) {
        if (!medium.scatters(c)) continue;
        const double path = 1 / medium.sigmaTp()[c];
        shortest = shortest == 0 ? path : std::min(shortest, path);
        longest = std::max(longest, path);
    }
    if (longest == 0) throw inputError(fmt::format("{} does not scatter in any channel", subject.name));
    if (options.model == "reference") return walked(subject, options, shortest, longest, observer);
    std::vector<std::string> settings;
    for (const std::string_view part : split(options.set, ','))
        if (!trim(part).empty()) settings.emplace_back(trim(part));
    LoadedModel loaded = engine.load(options.model, settings, options.backend, medium);
    Tabulation table = tabulate(*loaded.evaluator, loaded.model, medium);
    return {GroundTruth(std::move(table.profile), table.tail), modelLabel(loaded), shortest, longest};
}

}  // namespace searchlight
