#include "job/plot/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/text.h"
#include "model/plane.h"
#include "transport/exact/exact_half_space.h"
#include "transport/exact/ordinate_half_space.h"
#include "transport/walk/radial_edges.h"

namespace searchlight {

namespace {

constexpr double not_applicable = std::numeric_limits<double>::quiet_NaN();

// Channels must not share random numbers: their errors are drawn as independent. Odd constant of [Steele2014].
std::uint64_t channelSeed(std::uint64_t seed, int channel) {
    return seed + static_cast<std::uint64_t>(channel) * 0x9e3779b97f4a7c15u;
}

// Channels of one g share a table, and with it their errors: one seed for all.
CachedWhiteTable whiteTableOf(const HalfSpaceProblem& problem, const ReferenceOptions& options, const ReferenceRun& run,
                              Observer& observer) {
    const WhiteKey key{problem.g, problem.eta, problem.angle_deg, options.walks, options.seed};
    for (const std::optional<CachedWhiteTable>& known : run.white)
        if (known && known->table->key == key) return *known;
    return cachedWhiteTable(key, userWhiteCache(), options.threads, observer);
}

}  // namespace

std::uint64_t ReferenceRun::walks() const {
    std::uint64_t sum = 0;
    for (const auto& channel : channels)
        if (channel) sum += channel->walks;
    return sum;
}

double ReferenceRun::seconds() const {
    double sum = 0;
    for (const auto& channel : channels)
        if (channel) sum += channel->seconds;
    return sum;
}

PencilReference ReferenceRun::curve() const {
    PencilReference curve;
    std::uint64_t per_channel = 0;
    const std::size_t bins = edges_mm.size() - 1;
    curve.edges_mm = edges_mm;
    curve.Rd.assign(bins, {not_applicable, not_applicable, not_applicable});
    curve.standard_error = curve.Rd;
    for (int c = 0; c < Rgb::channels; ++c) {
        // A medium of one channel shows the same curve in all three.
        const auto& walked = channels[medium.channels == 1 ? 0 : static_cast<std::size_t>(c)];
        if (!walked) continue;
        per_channel = walked->walks;
        for (std::size_t i = 0; i < bins; ++i) {
            curve.Rd[i][c] = walked->all.Rd[i];
            curve.standard_error[i][c] = walked->all.standard_error[i];
        }
    }
    curve.label = fmt::format("Monte Carlo, {} walks", countText(static_cast<double>(per_channel)));
    return curve;
}

ReferenceRun runReference(const Medium& medium, const ReferenceOptions& options, Observer& observer) {
    ReferenceRun run;
    run.medium = medium;
    run.angle_deg = options.angle_deg;
    run.edges_mm = options.edges_mm;
    // What is solved begins at 0.02 mean free paths from the beam.
    if (run.edges_mm.empty())
        run.edges_mm = options.exact ? linearEdges(50, plotEdges(medium, 0, 1).back()) : plotEdges(medium, 0, 100);
    for (int c = 0; c < medium.channels; ++c) {
        if (!medium.scatters(c) || (medium.channels > 1 && !options.only[c])) continue;
        HalfSpaceProblem problem = halfSpaceProblem(medium, c, options.angle_deg);
        problem.beam = options.beam;
        if (options.white) {
            run.white[static_cast<std::size_t>(c)] = whiteTableOf(problem, options, run, observer);
            run.channels[static_cast<std::size_t>(c)] = evaluateWhite(*run.white[static_cast<std::size_t>(c)]->table,
                                                                      problem.sigma_a, problem.sigma_s, run.edges_mm);
            continue;
        }
        if (options.exact) {
            run.channels[static_cast<std::size_t>(c)] =
                solveAnyHalfSpace(problem, run.edges_mm, options.threads, observer);
            continue;
        }
        HalfSpaceOptions walk;
        walk.walks = options.walks;
        walk.seed = channelSeed(options.seed, c);
        walk.edges_mm = run.edges_mm;
        walk.grid = options.grid;
        walk.grid_extent_mm = options.grid_extent_mm;
        walk.strip_edges_mm = options.strip_edges_mm;
        walk.strip_half_width_mm = options.strip_half_width_mm;
        walk.threads = options.threads;
        walk.estimator = options.estimator;
        walk.gl = options.gl;
        if (options.control) walk.control = options.control(c);
        HalfSpaceResult walked = walkHalfSpace(problem, walk, observer);
        run.interrupted = walked.interrupted;
        if (walked.walks > 0 || !walked.interrupted) run.channels[static_cast<std::size_t>(c)] = std::move(walked);
        if (run.interrupted) break;
    }
    return run;
}

std::vector<LoadedModel> loadModels(const std::vector<std::string>& names, std::string_view backend,
                                    const Subject& subject, Engine& engine) {
    std::vector<std::string> all = names;
    if (all == std::vector<std::string>{"all"}) {
        all.clear();
        for (const Model& model : shippedModels())
            if (!ownLength(model)) all.push_back(model.id);
    }
    if (all.empty()) throw usageError("no model was named", "--models dipole,better_dipole, or all");
    std::vector<LoadedModel> loaded;
    for (const std::string& name : all) loaded.push_back(engine.load(name, {}, backend, subject.medium));
    return loaded;
}

std::string modelLabel(const LoadedModel& loaded) {
    std::string label = loaded.model.file.title;
    for (const auto& [name, value] : loaded.parameters) label += fmt::format(", {} {}", name, valueText(value));
    return label;
}

PencilCurve modelCurve(LoadedModel& loaded, double angle_deg, const std::vector<double>& radii_mm,
                       const std::vector<double>& edges_mm) {
    const double entry = pencilBeam(loaded.medium.eta, angle_deg).transmittance;
    PencilCurve curve;
    curve.label = modelLabel(loaded);
    curve.x_mm = radii_mm;
    curve.Rd = radialRd(*loaded.evaluator, loaded.model, loaded.medium, angle_deg, radii_mm);
    if (!edges_mm.empty())
        curve.bin_means = annulusMeans(*loaded.evaluator, loaded.model, loaded.medium, angle_deg, edges_mm);
    for (auto* values : {&curve.Rd, &curve.bin_means})
        for (Rgb& value : *values)
            for (int c = 0; c < Rgb::channels; ++c)
                value[c] = loaded.medium.scatters(c) ? entry * value[c] : not_applicable;
    return curve;
}

std::vector<double> plotEdges(const Medium& medium, double r_max_mm, int bins) {
    double r_max = r_max_mm;
    if (r_max <= 0) {
        // Five diffuse mean free paths hold what can be seen; weakly absorbing media are cut at forty mean free paths.
        for (int c = 0; c < medium.channels; ++c) {
            if (!medium.scatters(c)) continue;
            const double sigma_tp = medium.sigmaTp()[c];
            const double sigma_tr = std::sqrt(3 * medium.sigma_a[c] * sigma_tp);
            r_max = std::max(r_max, std::min(5 / std::max(sigma_tr, 1e-30), 40 / sigma_tp));
        }
    }
    std::vector<double> edges;
    for (int i = 0; i <= bins; ++i) edges.push_back(r_max * i * i / (static_cast<double>(bins) * bins));
    return edges;
}

std::vector<double> curveRadii(double r_max_mm, int count) {
    std::vector<double> radii;
    for (int i = 0; i < count; ++i) radii.push_back(r_max_mm * std::pow(10.0, 4.5 * i / (count - 1) - 4.5));
    return radii;
}

AlbedoData albedoData(double eta, double g, const std::vector<std::string>& models, std::uint64_t walks,
                      std::uint64_t seed, std::string_view backend, Engine& engine, Observer& observer) {
    const auto mediumAt = [&](double a, double b, double c) {
        // Unit reduced extinction: totals do not depend on the scale.
        Medium medium;
        const Rgb alpha{a, b, c};
        medium.sigma_a = Rgb{1, 1, 1} - alpha;
        medium.sigma_s = 1 / (1 - g) * alpha;
        medium.g = {g, g, g};
        medium.eta = eta;
        return medium;
    };
    AlbedoData data;
    const double entry = pencilBeam(eta, 0).transmittance;
    Subject subject;
    subject.medium = mediumAt(.5, .5, .5);
    for (LoadedModel& loaded : loadModels(models, backend, subject, engine)) {
        AlbedoCurve curve;
        curve.label = loaded.model.file.title;
        // Three albedos at a time, one per channel; denser towards 1, where the curve bends.
        constexpr int count = 60;
        const auto albedoAt = [](int i) { return 1 - std::pow(1 - i / (count + 0.5), 2); };
        for (int i = 1; i <= count; i += 3) {
            const Medium medium = mediumAt(albedoAt(i), albedoAt(i + 1), albedoAt(i + 2));
            loaded.evaluator->set(medium, loaded.parameters);
            const Rgb total = totalRd(*loaded.evaluator, loaded.model, medium);
            for (int c = 0; c < Rgb::channels; ++c) {
                curve.albedo.push_back(albedoAt(i + c));
                curve.total.push_back(entry * total[c]);
            }
        }
        data.models.push_back(std::move(curve));
    }
    if (eta == 1 && g == 0) {
        AlbedoReference reference;
        reference.label = "exact (H-function)";
        for (int i = 1; i < 50; ++i) {
            // Denser towards 1, where the curve bends.
            const double root = 1 - i / 50.0;
            reference.albedo.push_back(1 - root * root);
            reference.total.push_back({exactTotal(root * root, 1 - root * root, 1).all.mean});
        }
        data.reference = std::move(reference);
    } else if (walks > 0) {
        AlbedoReference reference;
        reference.label = fmt::format("Monte Carlo, {} walks a point", countText(static_cast<double>(walks)));
        for (const double albedo : {.1, .2, .3, .4, .5, .6, .7, .8, .9, .95, .98, .99}) {
            Medium medium = mediumAt(albedo, albedo, albedo);
            medium.channels = 1;
            ReferenceOptions options;
            options.walks = walks;
            options.seed = seed;
            options.edges_mm = {0, 1};
            const ReferenceRun run = runReference(medium, options, observer);
            reference.albedo.push_back(albedo);
            reference.total.push_back(run.channels[0]->all.total);
        }
        data.reference = std::move(reference);
    }
    return data;
}

}  // namespace searchlight
