#include "render/hierarchical_gl.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "gl/context.h"
#include "model/plane.h"
#include "render/model_sum_gl.h"
#include "render/radial_sum_gl.h"

namespace searchlight {

namespace {

constexpr double slice_ms = 20;
// The pilot sees some receivers, so its own RMSE has to stay below what is promised for all.
constexpr double safety = 0.8;
constexpr int most_trials = 6;

// Root of the mean squared error over that of the mean squared exitance, in the worst channel.
double relativeRmse(std::span<const Rgb> exact, std::span<const Rgb> approximate) {
    Rgb error, total;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const Rgb difference = approximate[i] - exact[i];
        error = error + difference * difference;
        total = total + exact[i] * exact[i];
    }
    double worst = 0;
    for (int c = 0; c < Rgb::channels; ++c)
        if (total[c] > 0) worst = std::max(worst, std::sqrt(error[c] / total[c]));
    return worst;
}

class HierarchicalGl final : public Technique {
public:
    explicit HierarchicalGl(gl::Context& context) : context_(context) {}

    void start(const RenderInput& input, const ParamValues& options, Observer&) override {
        const double begin = context_.finish();
        const RenderInput::Versions& now = input.versions;
        const double error = std::get<double>(options.at("error"));
        // The one that is not used forgets everything, as it does not see what changes.
        const bool radial = input.profile != nullptr;
        const bool anew = !loaded_ || (radial ? !radial_ : !model_);
        loaded_ = false;  // until all of this has worked
        if (anew) {
            sum_ = nullptr;
            radial_.reset();
            model_.reset();
        }
        const bool points = anew || now.points != seen_.points;
        const bool light = points || now.light != seen_.light;
        const bool material = points || now.material != seen_.material;
        const bool view = anew || now.view != seen_.view;
        exitance_.assign(input.visible->positions.size(), {});
        if (radial)
            loadRadial(input, points, light, material, view);
        else
            loadModel(input, points, light, material, view);
        // What was found for these points and this light holds for another view, too.
        if (light || material || error != error_) error_bound_ = 0;
        seen_ = now;
        loaded_ = true;
        error_ = error;
        next_group_ = 0;
        groups_per_slice_ = 1;
        work_ = {};
        pilot_ms_ = sum_ms_ = 0;
        if (error_bound_ == 0 && !exitance_.empty()) choosePilot();
        tree_ms_ = context_.finish() - begin;
    }

    bool step(Observer& observer) override {
        if (observer.cancelled()) throw interruptedError();
        if (exitance_.empty()) return true;
        const double begin = context_.finish();
        if (error_bound_ == 0) {
            if (exact_.size() < pilot_.size())
                sumPilotDirectly();
            else
                tryOpening();
            pilot_ms_ += context_.finish() - begin;
            return false;
        }
        sumSlice(begin);
        observer.progress("hierarchical", static_cast<std::uint64_t>(next_group_),
                          static_cast<std::uint64_t>(sum_->groups(sum_->coarseLevel())), "groups");
        return next_group_ == sum_->groups(sum_->coarseLevel());
    }

    std::span<const Rgbf> exitance() const override { return exitance_; }

    TechniqueReport report() const override {
        return {.stage_ms = {{"tree", tree_ms_}, {"pilot", pilot_ms_}, {"sum", sum_ms_}},
                .interactions = work_.expanded + work_.summed,
                .error_bound = error_bound_,
                .approximates = radial_ ? "far points are summed as second-order expansions"
                                        : "far points are summed at four points that have their moments",
                .device = "gl " + context_.info().renderer};
    }

private:
    void loadRadial(const RenderInput& input, bool points, bool light, bool material, bool view) {
        if (!radial_) sum_ = &radial_.emplace(context_);
        if (points) radial_->setPoints(*input.points, input.threads);
        if (light) radial_->setTransmitted(input.irradiance->transmitted, input.threads);
        if (material) radial_->setProfile(*input.profile);
        if (view && !exitance_.empty()) radial_->setReceivers(input.visible->positions, input.threads);
    }

    void loadModel(const RenderInput& input, bool points, bool light, bool material, bool view) {
        if (!model_) sum_ = &model_.emplace(context_);
        if (points) model_->setPoints(*input.points, input.threads);
        if (material) {
            // Its shape decides which nodes are opened, so it need not be exact.
            constexpr double shape_error = 0.01;
            const Tabulation mean = tabulate(*input.evaluator, *input.model, *input.medium, shape_error);
            model_->setModel(*input.model, *input.medium, modelParameters(input), mean.profile);
        }
        if (light || material) model_->setLight(*input.irradiance, !input.model->file.no_wi, input.threads);
        if (view && !exitance_.empty()) model_->setReceivers(*input.visible, input.threads);
    }

    void choosePilot() {
        const SumGl::Pilot pilot = sum_->pilot();
        const int level = sum_->fineLevel(), groups = sum_->groups(level);
        const int count = std::min(groups, pilot.groups);
        pilot_chains_ = {level, 0, groups / count, count};
        pilot_.clear();
        exact_.clear();
        for (int i = 0; i < count; ++i) {
            const auto [first, last] = sum_->receiversOf(level, i * pilot_chains_.stride);
            const std::size_t chosen = std::min(static_cast<std::size_t>(pilot.receivers), last - first);
            for (std::size_t k = 0; k < chosen; ++k)
                pilot_.push_back(static_cast<std::uint32_t>(first + (last - first) * k / chosen));
        }
        opening_ = error_;
        trials_ = 0;
    }

    void sumPilotDirectly() {
        const std::size_t count =
            std::min(static_cast<std::size_t>(sum_->pilot().at_once), pilot_.size() - exact_.size());
        const std::vector<Rgb> sums = sum_->direct(std::span(pilot_).subspan(exact_.size(), count));
        exact_.insert(exact_.end(), sums.begin(), sums.end());
    }

    // The error is about proportional to the opening, so a few trials find it.
    void tryOpening() {
        sum_->run(pilot_chains_, opening_);
        std::vector<Rgb> found;
        for (const std::uint32_t place : pilot_) found.push_back(toDouble(sum_->exitance(place, place + 1).front()));
        const double rmse = relativeRmse(exact_, found);
        const bool good = rmse <= safety * error_;
        ++trials_;
        if (good && (rmse >= 0.5 * safety * error_ || trials_ >= 3 || rmse == 0)) {
            error_bound_ = std::max(rmse / safety, 1e-7);
            return;
        }
        if (trials_ == most_trials)
            throw deviceError("the error that is asked for was not reached on this device",
                              "its arithmetic has 24 bits: ask for a larger error, or use the CPU");
        opening_ *= std::clamp(0.8 * safety * error_ / rmse, 0.05, 8.0);
    }

    void sumSlice(double begin) {
        const int level = sum_->coarseLevel(), groups = sum_->groups(level);
        const int count = std::min(groups_per_slice_, groups - next_group_);
        const SumGl::Work work = sum_->run({level, next_group_, 1, count}, opening_);
        work_.expanded += work.expanded;
        work_.summed += work.summed;
        const std::size_t first = sum_->receiversOf(level, next_group_).first;
        const std::size_t last = sum_->receiversOf(level, next_group_ + count - 1).second;
        const std::vector<Rgbf> values = sum_->exitance(first, last);
        for (std::size_t i = first; i < last; ++i) exitance_[sum_->order()[i]] = values[i - first];
        next_group_ += count;
        const double ms = context_.finish() - begin;
        sum_ms_ += ms;
        // Slowly up, at once down: groups differ.
        const double fitting = count * slice_ms / std::max(ms, 1e-3);
        groups_per_slice_ = std::clamp(static_cast<int>(std::min(fitting, 2.0 * count)), 1, 16);
    }

    gl::Context& context_;
    std::optional<RadialSumGl> radial_;
    std::optional<ModelSumGl> model_;
    SumGl* sum_ = nullptr;  // one of the two
    RenderInput::Versions seen_;
    bool loaded_ = false;
    double error_ = 0;
    double opening_ = 0;      // that the pilot found
    double error_bound_ = 0;  // 0: not found yet
    SumGl::Chains pilot_chains_;
    std::vector<std::uint32_t> pilot_;  // places in the receivers' tree
    std::vector<Rgb> exact_;            // of the first of them
    int trials_ = 0;
    int next_group_ = 0, groups_per_slice_ = 1;
    SumGl::Work work_;
    double tree_ms_ = 0, pilot_ms_ = 0, sum_ms_ = 0;
    std::vector<Rgbf> exitance_;
};

}  // namespace

std::unique_ptr<Technique> makeHierarchicalGl(gl::Context* context) {
    assert(context);
    return std::make_unique<HierarchicalGl>(*context);
}

}  // namespace searchlight
