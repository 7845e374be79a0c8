#include "render/direct.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/random.h"
#include "model/plane.h"
#include "render/direct/block_sum.h"
#include "render/direct/chosen_light.h"
#include "render/direct/even_points.h"
#include "render/direct/model_sum.h"
#include "render/direct/probe_hits.h"
#include "render/direct/probes.h"
#include "render/direct/walked_single.h"
#include "render/exitance/fine_cell.h"
#include "render/exitance_sum.h"

namespace searchlight {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::time_point since) {
    return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

// Independent estimates whose scatter gives the standard error: that is then itself known to 1/sqrt(2 x 31), 13 %.
constexpr int most_steps = 32;
// Directions that an environment is drawn as, for a set of points.
constexpr int directions_per_draw = 16;
// Probe hits that are lit at once: some tens of MB.
constexpr std::size_t hits_at_once = 200'000;
constexpr std::size_t queries_per_batch = 65'536;

// Points of a pass that take about as long as its probes do: by the table, where rays go from each into surroundings,
// and where each is a query of the model.
constexpr std::size_t table_points = 16'384, surrounded_points = 4'096, model_points = 2'048;
// Of these, how many a block of receivers takes per pass where each is a query of the model.
constexpr std::size_t model_choice = 128;
// Walks of single scattering per channel and pass: about as long as a pass of points.
constexpr std::uint64_t walks_per_pass = 8'192;

int whole(const ParamValues& options, std::string_view name) {
    return static_cast<int>(std::get<double>(options.find(name)->second));
}

// How fast the slowest channel falls off: sigma_tr, under the exponential of every diffusion model.
double fallOff(const Medium& medium) {
    double slowest = INFINITY;
    for (int c = 0; c < Rgb::channels; ++c)
        if (medium.scatters(c)) slowest = std::min(slowest, std::sqrt(3 * medium.sigma_a[c] * medium.sigmaTp()[c]));
    return std::isfinite(slowest) ? slowest : 0;
}

// R_d is shared out between evenly spread points and probes by the distance alone: points take
//   w(r) = p_a / (p_a + p_p(r) / 2),
// p_a and p_p being the expected numbers of samples per mm^2, and probes the rest. On a plane that is the balance
// heuristic [Veach1995], as a half of the probes goes along its normal. Elsewhere it is as free of bias, as the
// two shares always add up to R_d, and the points' share is again a function of distance: their sum costs what it cost.
class Shares {
public:
    Shares() = default;
    /// Points per mm^2 for each probe of a receiver.
    Shares(const Probes& probes, double points_per_mm2) : probes_(&probes), points_(points_per_mm2) {}

    double ofPoints(double r_mm) const {
        if (!probes_) return 1;
        return points_ > 0 ? points_ / (points_ + 0.5 * probes_->disc(r_mm)) : 0;
    }

    /// The points' share of a profile.
    Profile ofPoints(const Profile& profile) const {
        std::vector<double> radii(profile.radii().begin(), profile.radii().end());
        std::vector<Rgb> values;
        for (const double r : radii) values.push_back(ofPoints(r) * profile(r));
        return {std::move(radii), std::move(values)};
    }

private:
    const Probes* probes_ = nullptr;  ///< null: there are none
    double points_ = 0;
};

class Direct final : public Technique {
public:
    void start(const RenderInput& input, const ParamValues& options, Observer&) override {
        input_ = input;
        const std::string& sampling = std::get<std::string>(options.find("sampling")->second);
        const int passes = whole(options, "spp");
        passes_ = (passes + most_steps - 1) / most_steps;
        steps_ = (passes + passes_ - 1) / passes_;
        points_per_pass_ = static_cast<std::size_t>(whole(options, "pass_points"));
        by_points_ = sampling != "probes";
        // Where R_d has no end towards r = 0 points alone have no finite variance; elsewhere they are faster alone.
        const bool by_probes = sampling == "auto" ? input.model->file.single_scattering : sampling != "area";
        if (sampling == "probes" && !input.profile)
            throw usageError("probes reach as far as a profile does, and this model reads directions",
                             "use --sampling both or area, or --normal-beam");
        const bool walked = std::get<std::string>(options.find("single_scattering")->second) == "walked";
        if (walked && input.model->file.single_scattering)
            throw usageError("the model has single scattering of its own", "use --single-scattering model");
        if (!walk_ || input.versions.points != seen_points_) {
            walk_.emplace(input.object->mesh);
            even_.emplace(input.object->mesh, *walk_);
        }
        seen_points_ = input.versions.points;
        light_.emplace(input);
        if (points_per_pass_ == 0)
            points_per_pass_ = !input.profile ? model_points : light_->draws() ? surrounded_points : table_points;
        profile_ = input.profile ? *input.profile
                                 : tabulate(*input.evaluator, *input.model, *input.medium, profile_error).profile;
        evaluators_.reset();
        if (!input.profile) evaluators_.emplace(input);
        probes_.reset();
        if (by_probes) probes_.emplace(profile_, *input.medium);
        if (probes_ && !probes_->usable()) probes_.reset();
        const double points_per_mm2 = static_cast<double>(points_per_pass_) / even_->area();
        shares_ = probes_ ? Shares(*probes_, by_points_ ? points_per_mm2 : 0) : Shares();
        if (by_points_) points_profile_ = shares_.ofPoints(profile_);
        table_.reset();
        if (input.profile && by_points_) table_.emplace(points_profile_, fineCellArea(profile_));
        single_.reset();
        if (walked && !input.visible->positions.empty()) single_.emplace(input);
        receivers_ = ReceiverBlocks(input.visible->positions);
        const std::size_t count = input.visible->positions.size();
        sums_.assign(count, {});
        squares_.assign(count, {});
        exitance_.assign(count, {});
        standard_error_.assign(count, {});
        done_ = 0;
        interactions_ = 0;
        points_ms_ = probes_ms_ = single_ms_ = 0;
    }

    bool step(Observer& observer) override {
        if (exitance_.empty()) return true;
        step_.assign(exitance_.size(), {});
        const std::uint64_t seed = streamOf(input_.light.seed, static_cast<std::uint64_t>(done_)).next();
        if (by_points_) addPoints(seed, observer);
        if (probes_) addProbes(seed + 1, observer);
        if (single_) addSingle(seed, observer);
        ++done_;
        finishStep();
        observer.progress("direct", static_cast<std::uint64_t>(done_), static_cast<std::uint64_t>(steps_), "steps");
        return done_ == steps_;
    }

    std::span<const Rgbf> exitance() const override { return exitance_; }
    std::span<const Rgbf> standardError() const override { return standard_error_; }

    TechniqueReport report() const override {
        TechniqueReport report{.stage_ms = {{"points", points_ms_}, {"probes", probes_ms_}},
                               .interactions = interactions_,
                               .standard_error = relativeError(),
                               .approximates = "nothing: its error is noise, and known",
                               .device = input_.profile ? "cpu" : input_.evaluator->backend()};
        if (single_) {
            report.stage_ms["single_scattering"] = single_ms_;
            report.approximates = "single scattering is a mean over cells of about four pixels; else nothing";
        }
        return report;
    }

private:
    // How well probes follow a model decides their noise, not their mean.
    static constexpr double profile_error = 1e-3;

    void addPoints(std::uint64_t seed, Observer& observer) {
        const auto begin = Clock::now();
        const std::size_t count = points_per_pass_ * static_cast<std::size_t>(passes_);
        const ChosenPoints points = even_->draw(count, seed);
        const Irradiance light =
            light_->at({points.positions, points.normals}, directions_per_draw * passes_, seed, observer);
        const double area = even_->area() / static_cast<double>(count);
        if (input_.profile)
            sumTable(points, light.transmitted, area, seed, observer);
        else
            sumModel(points, light, area, seed, observer);
        points_ms_ += milliseconds(begin);
    }

    void sumTable(const ChosenPoints& points, std::span<const Rgbf> transmitted, double area, std::uint64_t seed,
                  Observer& observer) {
        BlockSources sources;
        for (std::size_t i = 0; i < points.positions.size(); ++i) {
            if (transmitted[i] == Rgbf{}) continue;
            const Vec3f& p = points.positions[i];
            sources.x.push_back(p.x);
            sources.y.push_back(p.y);
            sources.z.push_back(p.z);
            for (int c = 0; c < Rgb::channels; ++c)
                sources.flux[static_cast<std::size_t>(c)].push_back(
                    static_cast<float>(area * toDouble(transmitted[i])[c]));
        }
        // 1.1: where a RadialTable ends.
        interactions_ +=
            sumBlocks(receivers_, sources, *table_,
                      {.rate = fallOff(*input_.medium), .reach_mm = 1.1 * profile_.radii().back(), .seed = seed},
                      input_.threads, observer, block_sums_);
        for (std::size_t i = 0; i < step_.size(); ++i)
            step_[i] = step_[i] + Rgb{block_sums_[0][i], block_sums_[1][i], block_sums_[2][i]};
    }

    // A model's values, gathered into batches.
    class Batch {
    public:
        Batch(const RenderInput& input, std::vector<Rgb>& sums) : input_(input), sums_(sums) {}

        void add(std::size_t receiver, Vec3 position, Vec3 normal, Vec3 wi, Rgb factor) {
            const Vec3 xo = toDouble(input_.visible->positions[receiver]);
            const Vec3 wo = normalize(input_.visible->eye - xo);
            queries_.push_back({position, wi, normal, xo, wo, toDouble(input_.visible->normals[receiver])});
            receivers_.push_back(receiver);
            factors_.push_back(factor);
            if (queries_.size() == queries_per_batch) flush();
        }

        void flush() {
            values_.resize(queries_.size());
            if (!queries_.empty()) input_.evaluator->evaluate(queries_, values_);
            for (std::size_t i = 0; i < queries_.size(); ++i)
                for (int c = 0; c < Rgb::channels; ++c)
                    if (input_.medium->scatters(c)) sums_[receivers_[i]][c] += factors_[i][c] * values_[i][c];
            queries_.clear();
            receivers_.clear();
            factors_.clear();
        }

    private:
        const RenderInput& input_;
        std::vector<Rgb>& sums_;
        std::vector<Query> queries_;
        std::vector<std::size_t> receivers_;
        std::vector<Rgb> factors_;
        std::vector<Rgb> values_;
    };

    // Where light of one point comes from: along beams, or as a whole for a model that does not read directions.
    template <class Visit>
    void forEachBeam(const ChosenPoints& points, const Irradiance& light, std::size_t i, const Visit& visit) const {
        if (input_.model->file.no_wi) {
            if (light.transmitted[i] != Rgbf{}) visit(toDouble(points.normals[i]), toDouble(light.transmitted[i]));
            return;
        }
        for (const Beam& beam : light.beams)
            if (beam.flux[i] != Rgbf{}) visit(toDouble(beam.wi[beam.wi.size() == 1 ? 0 : i]), toDouble(beam.flux[i]));
    }

    void sumModel(const ChosenPoints& points, const Irradiance& light, double area, std::uint64_t seed,
                  Observer& observer) {
        std::vector<ModelSource> sources;
        for (std::size_t i = 0; i < points.positions.size(); ++i)
            forEachBeam(points, light, i, [&](Vec3 wi, Rgb flux) {
                sources.push_back({points.positions[i], points.normals[i], toFloat(wi), toFloat(area * flux)});
            });
        interactions_ += sumModelBlocks(
            input_, *evaluators_, sources, profile_, [&](double r) { return shares_.ofPoints(r); },
            {.sources = model_choice * static_cast<std::size_t>(passes_), .seed = ~seed}, observer, step_);
    }

    void addProbes(std::uint64_t seed, Observer& observer) {
        const auto begin = Clock::now();
        const std::size_t chunk = std::max<std::size_t>(1, hits_at_once / static_cast<std::size_t>(passes_));
        for (std::size_t first = 0; first < step_.size(); first += chunk) {
            const std::size_t last = std::min(first + chunk, step_.size());
            const ProbeHits found = findHits(*probes_, *input_.visible, first, last, passes_, seed, *input_.rays,
                                             *walk_, input_.threads, observer);
            const Irradiance light = light_->at({found.points.positions, found.points.normals}, directions_per_draw,
                                                streamOf(seed, first).next(), observer);
            if (input_.profile)
                addHits(found, light);
            else
                addModelHits(found, light);
        }
        probes_ms_ += milliseconds(begin);
    }

    void addHits(const ProbeHits& found, const Irradiance& light) {
        for (std::size_t k = 0; k < found.hits.size(); ++k) {
            const ProbeHit& hit = found.hits[k];
            const double r =
                length(toDouble(found.points.positions[k]) - toDouble(input_.visible->positions[hit.receiver]));
            // What the points' table leaves: by difference, so that nothing is lost between the two curves.
            const Rgb Rd = by_points_ ? profile_(r) - points_profile_(r) : profile_(r);
            Rgb& sum = step_[hit.receiver];
            sum = sum + hit.weight * Rd * toDouble(light.transmitted[k]);
        }
        interactions_ += found.hits.size();
    }

    void addModelHits(const ProbeHits& found, const Irradiance& light) {
        Batch batch(input_, step_);
        for (std::size_t k = 0; k < found.hits.size(); ++k) {
            const ProbeHit& hit = found.hits[k];
            const Vec3 xi = toDouble(found.points.positions[k]);
            const double r = length(xi - toDouble(input_.visible->positions[hit.receiver]));
            forEachBeam(found.points, light, k, [&](Vec3 wi, Rgb flux) {
                batch.add(hit.receiver, xi, toDouble(found.points.normals[k]), wi,
                          hit.weight * (1 - shares_.ofPoints(r)) * flux);
                ++interactions_;
            });
        }
        batch.flush();
    }

    void addSingle(std::uint64_t seed, Observer& observer) {
        const auto begin = Clock::now();
        single_->addTo(step_, walks_per_pass * static_cast<std::uint64_t>(passes_), seed, observer);
        single_ms_ += milliseconds(begin);
    }

    void finishStep() {
        const double n = done_;
        for (std::size_t i = 0; i < step_.size(); ++i) {
            sums_[i] = sums_[i] + step_[i];
            squares_[i] = squares_[i] + step_[i] * step_[i];
            const Rgb mean = (1 / n) * sums_[i];
            exitance_[i] = toFloat(mean);
            if (done_ < 2) continue;
            Rgb error;
            for (int c = 0; c < Rgb::channels; ++c)
                error[c] = std::sqrt(std::max(0.0, squares_[i][c] / n - mean[c] * mean[c]) / (n - 1));
            standard_error_[i] = toFloat(error);
        }
    }

    // The worst channel's, as a RMS over the receivers.
    double relativeError() const {
        double worst = 0;
        for (int c = 0; c < Rgb::channels; ++c) {
            double error = 0, norm = 0;
            for (std::size_t i = 0; i < exitance_.size(); ++i) {
                error += std::pow(toDouble(standard_error_[i])[c], 2);
                norm += std::pow(toDouble(exitance_[i])[c], 2);
            }
            if (norm > 0) worst = std::max(worst, std::sqrt(error / norm));
        }
        return worst;
    }

    RenderInput input_;
    std::uint64_t seen_points_ = 0;
    std::optional<SurfaceWalk> walk_;
    std::optional<EvenPoints> even_;
    std::optional<ChosenLight> light_;
    Profile profile_, points_profile_;
    std::optional<Probes> probes_;
    Shares shares_;
    std::optional<RadialTable> table_;
    std::optional<ModelEvaluators> evaluators_;  // of a model that is no table
    std::optional<WalkedSingle> single_;
    ReceiverBlocks receivers_{{}};
    std::array<std::vector<float>, 3> block_sums_;
    bool by_points_ = true;
    int passes_ = 0;  // per step
    int steps_ = 0, done_ = 0;
    std::size_t points_per_pass_ = 0;
    std::uint64_t interactions_ = 0;
    double points_ms_ = 0, probes_ms_ = 0, single_ms_ = 0;
    std::vector<Rgb> step_, sums_, squares_;
    std::vector<Rgbf> exitance_, standard_error_;
};

}  // namespace

std::vector<Param> directOptions() {
    return {
        {.name = "spp",
         .type = ParamType::integer,
         .min = 1,
         .max = 1e6,
         .value = 64.0,
         .doc = "passes: in each, new points are drawn on the surface, and a probe per sample of the picture"},
        {.name = "sampling",
         .type = ParamType::choice,
         .value = std::string("auto"),
         .choices = {"auto", "both", "area", "probes"},
         .doc =
             "of the surface: evenly, around each sample by the profile, or both, each where it is better; auto: both "
             "for models with single scattering, else evenly"},
        {.name = "pass_points",
         .type = ParamType::integer,
         .min = 0,
         .max = 1e6,
         .value = 0.0,
         .doc =
             "points that are drawn evenly over the surface in a pass; 0: 16384, 4096 for shadowed surroundings, 2048 "
             "for a model that reads directions"},
        {.name = "single_scattering",
         .type = ParamType::choice,
         .value = std::string("model"),
         .choices = {"model", "walked"},
         .doc = "as the model has it, or walked through a closed mesh and added to a model that has none"}};
}

std::unique_ptr<Technique> makeDirect(gl::Context*) { return std::make_unique<Direct>(); }

}  // namespace searchlight
