#include "job/rank/ranking.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "job/plot/curves.h"
#include "model/plane.h"
#include "validate/model_shift.h"

namespace searchlight {

namespace {

// One evaluation among 4,096 about the beam, under the oblique one; the fastest of some batches, since other work on
// the machine only slows it down.
double costOf(LoadedModel& loaded, double angle_deg) {
    constexpr int batch = 4096, batches = 5;
    const Vec3 up{0, 0, 1};
    const Vec3 wi = pencilBeam(loaded.medium.eta, angle_deg).wi;
    std::vector<Query> queries;
    for (int i = 0; i < batch; ++i) {
        const double r = 10.0 * (i + 1) / batch;
        queries.push_back({{}, wi, up, {r * std::cos(i), r * std::sin(i), 0}, up, up});
    }
    std::vector<Rgb> values(batch);
    double best = INFINITY;
    for (int k = 0; k < batches; ++k) {
        const auto start = std::chrono::steady_clock::now();
        loaded.evaluator->evaluate(queries, values);
        best =
            std::min(best, std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count());
    }
    return best / batch;
}

// What the model answers to each reference, per incident flux.
std::vector<RankAnswer> answersOf(LoadedModel& loaded, const Medium& medium,
                                  const std::vector<RankReference>& references, double angle_deg) {
    loaded.medium = medium;
    loaded.evaluator->set(medium, loaded.parameters);
    const double entered = pencilBeam(medium.eta, 0).transmittance;
    const double entered_oblique = pencilBeam(medium.eta, angle_deg).transmittance;
    const Rgb total = totalRd(*loaded.evaluator, loaded.model, medium);
    const Rgb mean_x = modelMeanX(*loaded.evaluator, loaded.model, medium, angle_deg);
    std::vector<RankAnswer> channels;
    for (const RankReference& reference : references) {
        RankAnswer answer{.bin_means = annulusMeans(*loaded.evaluator, loaded.model, medium, 0, reference.edges_mm),
                          .total = entered * total[reference.channel],
                          .mean_x_mm = mean_x[reference.channel]};
        for (Rgb& mean : answer.bin_means) mean = entered * mean;
        if (!reference.plane.empty())
            answer.plane = modelPlane(*loaded.evaluator, loaded.model, medium, angle_deg, reference.channel,
                                      reference.cells, reference.cell_mm);
        for (double& mean : answer.plane) mean *= entered_oblique;
        channels.push_back(std::move(answer));
    }
    return channels;
}

// A model of single scattering, to be added to those that leave it out.
constexpr std::string_view single_id = "single";

bool canTakeSingle(const Model& model) {
    const auto ships = [](const Model& other) { return other.id == single_id; };
    return !model.file.single_scattering && std::ranges::any_of(shippedModels(), ships);
}

}  // namespace

std::string whyNotRanked(const Model& model, bool many_materials) {
    if (!readsMedium(model)) return "it does not read the medium";
    if (many_materials && !model.file.no_wo)
        return "it reads the direction of exit, over which each value is a mean: name it with --models if there is "
               "time";
    if (const Param* param = ownLength(model))
        return fmt::format("its {} ({}) is not of the medium, so it is about more than a half-space", param->name,
                           param->unit);
    return {};
}

std::string Ranking::sentence(const RankedModel& model) const {
    const std::size_t worst = model.worst_channel;
    const std::string text = failureText(reference[worst], model.channels[worst], effort.angle_deg);
    return channels.size() > 1 ? fmt::format("in {} {}", channelName(subject.medium, channels[worst]), text) : text;
}

std::vector<RankEntry> rankEntries(const std::vector<std::string>& names, bool many_materials, std::string_view backend,
                                   Engine& engine) {
    std::vector<std::string> all = names;
    if (all == std::vector<std::string>{"all"}) {
        all.clear();
        for (const Model& model : shippedModels()) {
            if (!whyNotRanked(model, many_materials).empty()) continue;
            all.push_back(model.id);
            if (canTakeSingle(model)) all.push_back(model.id + "+" + std::string(single_id));
        }
    }
    if (all.empty()) throw usageError("no model was named", "--models dipole,better_dipole, or all");
    // Any medium will do until the material's is set.
    Medium medium;
    medium.sigma_a = medium.sigma_s = {1, 1, 1};
    std::vector<RankEntry> entries;
    for (const std::string& name : all) {
        RankEntry entry{name, {}, engine.load(name, {}, backend, medium)};
        entry.label = entry.loaded.model.file.title;
        for (const auto& [parameter, value] : entry.loaded.parameters)
            entry.label += fmt::format(", {} {}", parameter, valueText(value));
        entries.push_back(std::move(entry));
    }
    return entries;
}

Ranking rankOn(const Subject& subject, std::vector<RankEntry>& entries, const RankEffort& effort, Observer& observer) {
    const Medium& medium = subject.medium;
    Ranking ranking{.subject = subject, .effort = effort};
    for (int c = 0; c < medium.channels; ++c)
        if (medium.scatters(c)) ranking.channels.push_back(c);
    if (ranking.channels.empty()) throw inputError(fmt::format("{} does not scatter in any channel", subject.name));
    for (const int c : ranking.channels) {
        ranking.walks.push_back(walkForRank(medium, c, effort, observer));
        ranking.reference.push_back(ranking.walks.back().reference);
    }
    // Models of one OpenGL context take turns.
    const auto native = [](const RankEntry& entry) { return entry.loaded.evaluator->backend().starts_with("cpu"); };
    const int threads = std::ranges::all_of(entries, native) ? effort.threads : 1;
    std::vector<std::vector<RankAnswer>> answers(entries.size());
    parallelFor(entries.size(), threads, [&](std::size_t i) {
        if (observer.cancelled()) throw interruptedError();
        answers[i] = answersOf(entries[i].loaded, medium, ranking.reference, effort.angle_deg);
    });
    for (RankEntry& entry : entries) ranking.cost_ns.push_back(costOf(entry.loaded, effort.angle_deg));
    ranking.ranked = rankModels(ranking.reference, answers);
    return ranking;
}

PencilReference rankedReference(const Ranking& ranking, std::size_t channel) {
    const RankWalks& walks = ranking.walks[channel];
    return {.label = walks.exact
                         ? std::string("exact")
                         : fmt::format("Monte Carlo, {} walks", countText(static_cast<double>(walks.normal.walks))),
            .edges_mm = walks.reference.edges_mm,
            .Rd = walks.reference.Rd,
            .standard_error = walks.reference.standard_error};
}

std::vector<PencilCurve> rankedCurves(const Ranking& ranking, std::size_t channel, std::vector<RankEntry>& entries) {
    const std::vector<double>& edges = ranking.reference[channel].edges_mm;
    std::vector<PencilCurve> curves;
    for (RankEntry& entry : entries) {
        entry.loaded.medium = ranking.subject.medium;
        entry.loaded.evaluator->set(entry.loaded.medium, entry.loaded.parameters);
        curves.push_back(modelCurve(entry.loaded, 0, curveRadii(edges.back()), edges));
    }
    return curves;
}

}  // namespace searchlight
