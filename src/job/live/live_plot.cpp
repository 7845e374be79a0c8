#include "job/live/live_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/text.h"
#include "job/model_stamp.h"
#include "job/plot/curves.h"
#include "job/plot/plane_views.h"
#include "model/plane.h"
#include "plot/oblique.h"
#include "plot/slice.h"

namespace searchlight {

namespace {

constexpr double kFewWalks = 1e5;        // a reference in a tenth of a second
constexpr std::size_t kMostTables = 12;  // of some 20 MiB: three channels at a few angles
constexpr int kStripCells = 96, kSliceCells = 48, kCoarseSliceCells = 24;

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

// What walks depend on besides sigma_a and sigma_s of the medium.
std::string walkKey(const LiveRequest& request, const Medium& medium, const std::vector<double>& edges) {
    std::string key = fmt::format("{} {} {} {} {} {} ", static_cast<int>(request.view), request.angle_deg, medium.eta,
                                  request.bins, request.seed, edges.empty() ? 0.0 : edges.back());
    for (int c = 0; c < Rgb::channels; ++c)
        key += fmt::format("{} {} {} ", medium.sigma_a[c], medium.sigma_s[c], medium.g[c]);
    return key;
}

bool isPlane(const LiveRequest& request) {
    return request.view == LiveRequest::View::plane || request.view == LiveRequest::View::slice;
}

WhiteKey whiteKey(const LiveRequest& request, const Medium& medium, int channel, double walks) {
    return {medium.g[channel], medium.eta, request.angle_deg, static_cast<std::uint64_t>(walks), request.seed};
}

bool sameProblem(const WhiteKey& a, const WhiteKey& b) {
    return a.g == b.g && a.eta == b.eta && a.angle_deg == b.angle_deg && a.seed == b.seed;
}

// Figures number models from 0; slots have colours of their own.
void recolor(std::vector<Series>& series, const std::vector<int>& colors) {
    for (Series& each : series)
        if (each.color >= 0 && static_cast<std::size_t>(each.color) < colors.size())
            each.color = colors[static_cast<std::size_t>(each.color)];
}

}  // namespace

struct LivePlot::Impl {
    explicit Impl(Engine& engine) : engine_(engine) {}

    LivePlotResult draw(const LiveRequest& request, LiveDetail detail);
    bool isSlow(const LiveRequest& request) const;
    bool improve(const LiveRequest& request, Observer& observer);

    struct Kept {
        LoadedModel loaded;
        std::string stamp;  ///< of its files; empty: it ships
    };
    /// Reference walks of one medium that no table answers for.
    struct Walked {
        std::string key;
        ReferenceRun run;
        double walks = 0;
    };

    LoadedModel& model(const LiveModel& slot, std::size_t place, const Medium& shared);
    Medium mediumOf(const SceneMaterial& material, const SceneModel& model);
    std::vector<double> edgesOf(const LiveRequest& request, const Medium& medium) const;
    std::optional<ReferenceRun> whiteRun(const LiveRequest& request, const Medium& medium);
    std::optional<ReferenceRun> knownRun(const LiveRequest& request, const Medium& medium);
    bool improveWhite(const LiveRequest& request, const Medium& medium, Observer& observer);
    void drawProfile(const LiveRequest& request, const Medium& medium, LiveDetail detail, LivePlotResult& result);
    void drawPlane(const LiveRequest& request, const Medium& medium, LiveDetail detail, LivePlotResult& result);

    Engine& engine_;
    std::map<std::string, Kept> models_;                     ///< by place and id
    std::vector<std::shared_ptr<const WhiteTable>> tables_;  ///< the last used comes last
    std::optional<Walked> walked_;
};

Medium LivePlot::Impl::mediumOf(const SceneMaterial& material, const SceneModel& model) {
    if (!material.inverted()) return resolveMaterial(material).medium;
    Job job;
    job.scene.material = material;
    job.scene.model = model;
    return subjectOf(job, engine_).medium;
}

LoadedModel& LivePlot::Impl::model(const LiveModel& slot, std::size_t place, const Medium& shared) {
    const std::string key = fmt::format("{} {}", place, slot.model.id), stamp = modelStamp(slot.model.id);
    auto found = models_.find(key);
    if (found != models_.end() && found->second.stamp != stamp) {
        models_.erase(found);
        found = models_.end();
    }
    if (found == models_.end()) {
        // Models that left the plot go with the first that comes.
        if (models_.size() > 32) models_.clear();
        Kept kept{.stamp = stamp};
        kept.loaded.model = loadModel(slot.model.id);
        kept.loaded.evaluator = engine_.makeEvaluator(kept.loaded.model, "auto");
        found = models_.emplace(key, std::move(kept)).first;
    }
    LoadedModel& loaded = found->second.loaded;
    std::vector<std::string> settings;
    for (const auto& [name, value] : slot.model.parameters)
        settings.push_back(fmt::format("{}={}", name, valueText(value)));
    loaded.parameters = parseSettings(loaded.model, settings);
    loaded.medium = slot.material ? mediumOf(*slot.material, slot.model) : shared;
    loaded.evaluator->set(loaded.medium, loaded.parameters);
    return loaded;
}

std::vector<double> LivePlot::Impl::edgesOf(const LiveRequest& request, const Medium& medium) const {
    return plotEdges(medium, request.radii_max_mm, request.bins);
}

std::optional<ReferenceRun> LivePlot::Impl::whiteRun(const LiveRequest& request, const Medium& medium) {
    ReferenceRun run;
    run.medium = medium;
    run.angle_deg = request.angle_deg;
    run.edges_mm = edgesOf(request, medium);
    for (int c = 0; c < medium.channels; ++c) {
        if (!medium.scatters(c)) continue;
        const WhiteKey key = whiteKey(request, medium, c, 0);
        const WhiteTable* best = nullptr;
        for (const auto& table : tables_)
            if (sameProblem(table->key, key) && (!best || table->key.walks > best->key.walks)) best = table.get();
        if (!best) return {};
        try {
            run.channels[static_cast<std::size_t>(c)] =
                evaluateWhite(*best, medium.sigma_a[c], medium.sigma_s[c], run.edges_mm);
        } catch (const Error&) {
            return {};  // too near to albedo 1, or too far out: walked instead
        }
    }
    return run;
}

std::optional<ReferenceRun> LivePlot::Impl::knownRun(const LiveRequest& request, const Medium& medium) {
    if (request.walks <= 0) return {};
    if (!isPlane(request))
        if (auto run = whiteRun(request, medium)) return run;
    if (walked_ && walked_->key == walkKey(request, medium, edgesOf(request, medium))) return walked_->run;
    return {};
}

bool LivePlot::Impl::improveWhite(const LiveRequest& request, const Medium& medium, Observer& observer) {
    for (int c = 0; c < medium.channels; ++c)
        if (medium.sigma_s[c] > kWhiteLargestAlbedo * medium.sigmaT()[c]) return false;
    for (const double walks : {std::min(kFewWalks, request.walks), request.walks})
        for (int c = 0; c < medium.channels; ++c) {
            if (!medium.scatters(c)) continue;
            const WhiteKey key = whiteKey(request, medium, c, walks);
            if (std::ranges::any_of(tables_, [&](const auto& table) {
                    return sameProblem(table->key, key) && table->key.walks >= key.walks;
                }))
                continue;
            if (tables_.size() >= kMostTables) tables_.erase(tables_.begin());
            std::optional<WhiteCache> cache;
            try {
                cache = userWhiteCache();
            } catch (const Error&) {  // no home: walked each time
            }
            tables_.push_back(cache ? cachedWhiteTable(key, *cache, 0, observer).table
                                    : std::make_shared<const WhiteTable>(buildWhiteTable(key, 0, observer)));
            return true;
        }
    return false;
}

bool LivePlot::Impl::improve(const LiveRequest& request, Observer& observer) {
    if (request.walks <= 0) return false;
    const Medium medium = mediumOf(request.material, request.inverted_by);
    if (!isPlane(request)) {
        if (improveWhite(request, medium, observer)) return true;
        if (whiteRun(request, medium)) return false;
    }
    const std::string key = walkKey(request, medium, edgesOf(request, medium));
    const bool known = walked_ && walked_->key == key;
    if (known && walked_->walks >= request.walks) return false;
    ReferenceOptions options;
    options.walks = static_cast<std::uint64_t>(known ? request.walks : std::min(kFewWalks, request.walks));
    options.seed = request.seed;
    options.angle_deg = request.angle_deg;
    options.edges_mm = edgesOf(request, medium);
    if (request.view == LiveRequest::View::plane) {
        const Strip strip = stripOf(medium, request.radii_max_mm, 0, kStripCells);
        options.strip_edges_mm = strip.edges_mm;
        options.strip_half_width_mm = strip.half_width_mm;
    } else if (request.view == LiveRequest::View::slice) {
        options.grid = kSliceCells;
        options.grid_extent_mm = 0.5 * stripOf(medium, request.radii_max_mm, 0, 2).edges_mm.back();
    }
    ReferenceRun run = runReference(medium, options, observer);
    walked_ = Walked{key, std::move(run), static_cast<double>(options.walks)};
    return true;
}

bool LivePlot::Impl::isSlow(const LiveRequest& request) const {
    if (isPlane(request)) return true;
    return std::ranges::any_of(request.models, [&](const LiveModel& slot) {
        const auto found =
            std::ranges::find_if(models_, [&](const auto& kept) { return kept.first.ends_with(" " + slot.model.id); });
        if (found == models_.end()) return false;
        const Model& model = found->second.loaded.model;
        return !model.file.no_wo || (request.angle_deg > 0 && !model.file.radial) || !hasNativeEvaluator(model);
    });
}

void LivePlot::Impl::drawProfile(const LiveRequest& request, const Medium& medium, LiveDetail detail,
                                 LivePlotResult& result) {
    const auto begin = Clock::now();
    const std::vector<double> edges = edgesOf(request, medium);
    const auto run = knownRun(request, medium);
    std::optional<PencilReference> reference;
    if (run) {
        reference = run->curve();
        result.reference = reference->label;
        for (const auto& channel : run->channels)
            if (channel) result.reference_walks = static_cast<double>(channel->walks);
    }
    result.reference_ms = msSince(begin);

    const auto before_models = Clock::now();
    const bool error = request.view == LiveRequest::View::error;
    std::vector<PencilCurve> curves;
    std::vector<int> colors;
    std::string solo;
    for (std::size_t i = 0; i < request.models.size(); ++i) {
        if (request.solo >= 0 && static_cast<std::size_t>(request.solo) != i) continue;
        try {
            LoadedModel& loaded = model(request.models[i], i, medium);
            // A model that has to be summed over directions costs hundreds of evaluations a point.
            const bool summed = !loaded.model.file.no_wo, turned = request.angle_deg > 0 && !loaded.model.file.radial;
            const int count = detail == LiveDetail::coarse ? (summed ? 24 : 64) : summed && turned ? 96 : 256;
            curves.push_back(modelCurve(loaded, request.angle_deg, curveRadii(edges.back(), count),
                                        error && reference ? edges : std::vector<double>{}));
            // Two slots of one model are told apart by their place.
            const auto same = std::ranges::count(curves, curves.back().label, &PencilCurve::label);
            if (same > 1) curves.back().label += fmt::format(" ({})", same);
            colors.push_back(request.models[i].color);
            if (request.solo >= 0) solo = curves.back().label;
        } catch (const Error& problem) {
            if (problem.kind == ErrorKind::interrupted) throw;
            result.problems.push_back({i, problem});
        }
    }
    result.model_ms = msSince(before_models);
    if (curves.empty() && !reference) return;
    if (error && (!reference || curves.empty())) return;
    const PencilOptions options{.channel = request.channel,
                                .x_scale = request.x_scale,
                                .y_scale = request.y_scale,
                                .radius_power = request.radius_power,
                                .angle_deg = request.angle_deg,
                                .solo = solo};
    result.figure = error ? relativeErrorFigure(curves, *reference, options)
                          : pencilFigure(curves, reference ? &*reference : nullptr, options);
    if (solo.empty()) recolor(result.figure.series, colors);
}

void LivePlot::Impl::drawPlane(const LiveRequest& request, const Medium& medium, LiveDetail detail,
                               LivePlotResult& result) {
    const bool slice = request.view == LiveRequest::View::slice, coarse = detail == LiveDetail::coarse;
    const auto begin = Clock::now();
    const auto run = knownRun(request, medium);
    if (run) {
        result.reference = walksLabel(*run);
        for (const auto& channel : run->channels)
            if (channel) result.reference_walks = static_cast<double>(channel->walks);
    }
    result.reference_ms = msSince(begin);
    const auto before_models = Clock::now();
    const double extent = 0.5 * stripOf(medium, request.radii_max_mm, 0, 2).edges_mm.back();
    const Strip strip = stripOf(medium, request.radii_max_mm, 0, coarse && !run ? kStripCells / 4 : kStripCells);
    const int cells = coarse && !run ? kCoarseSliceCells : kSliceCells;
    StripPanel panel{.heading = fmt::format("{}°", prettyNumber(request.angle_deg)),
                     .edges_mm = strip.edges_mm,
                     .half_width_mm = strip.half_width_mm};
    std::vector<SlicePanel> panels;
    std::vector<int> colors;
    for (std::size_t i = 0; i < request.models.size(); ++i) {
        if (request.solo >= 0 && static_cast<std::size_t>(request.solo) != i) continue;
        try {
            LoadedModel& loaded = model(request.models[i], i, medium);
            if (slice)
                panels.push_back({.heading = modelLabel(loaded),
                                  .means = incidentCellMeans(loaded, request.angle_deg, squareCells(extent, cells))});
            else
                panel.models.push_back(
                    {modelLabel(loaded), incidentCellMeans(loaded, request.angle_deg, strip.cells())});
            colors.push_back(request.models[i].color);
        } catch (const Error& problem) {
            if (problem.kind == ErrorKind::interrupted) throw;
            result.problems.push_back({i, problem});
        }
    }
    result.model_ms = msSince(before_models);
    if (slice) {
        if (run)
            panels.push_back({result.reference,
                              tallyValues(*run, &HalfSpaceResult::all, &HalfSpaceTally::grid),
                              tallyValues(*run, &HalfSpaceResult::all, &HalfSpaceTally::grid_standard_error),
                              {}});
        if (panels.empty()) return;
        const int columns = panels.size() == 4 ? 2 : std::min(static_cast<int>(panels.size()), 3);
        result.figure = sliceFigure(
            panels, {.channel = request.channel, .title = {}, .extent_mm = extent, .columns = columns, .decades = 4});
        return;
    }
    if (run) panel.reference.push_back(stripReference(*run));
    if (panel.models.empty() && panel.reference.empty()) return;
    result.figure =
        obliqueFigure(std::span(&panel, 1), {.channel = request.channel, .y_scale = request.y_scale, .title = {}});
    recolor(result.figure.series, colors);
}

LivePlotResult LivePlot::Impl::draw(const LiveRequest& request, LiveDetail detail) {
    LivePlotResult result;
    const Medium medium = mediumOf(request.material, request.inverted_by);
    if (isPlane(request))
        drawPlane(request, medium, detail, result);
    else
        drawProfile(request, medium, detail, result);
    if (request.walks > 0 && result.reference.empty()) result.reference_note = "The reference is being walked.";
    return result;
}

LivePlot::LivePlot(Engine& engine) : impl_(std::make_unique<Impl>(engine)) {}
LivePlot::~LivePlot() = default;

LivePlotResult LivePlot::draw(const LiveRequest& request, LiveDetail detail) { return impl_->draw(request, detail); }
bool LivePlot::isSlow(const LiveRequest& request) { return impl_->isSlow(request); }
bool LivePlot::improve(const LiveRequest& request, Observer& observer) { return impl_->improve(request, observer); }
void LivePlot::forgetModels() { impl_->models_.clear(); }

}  // namespace searchlight
