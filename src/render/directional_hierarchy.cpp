#include "render/directional_hierarchy.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>

#include "base/error.h"
#include "render/directional_sum.h"

namespace searchlight {

namespace {

using Clock = std::chrono::steady_clock;

// A slice of work: short enough for a picture that fills and a cancel that is heard.
constexpr double slice_ms = 100;
// Evaluations in a slice of the pilot.
constexpr std::size_t pilot_evaluations = 2'000'000;
// Receivers that are summed directly, and those among which they are drawn.
constexpr std::size_t draws = 48, candidates = 512;
// Opening by which the candidates' exitance is known to some 10 %.
constexpr double rough_opening = 1;
// Standard errors that the bound lies above what the sample has, and what it is multiplied by for the rare errors that
// a sample of this size misses.
constexpr double confidence = 3, missed = 1.1;
constexpr int most_trials = 8;
// Rare large errors are what a sample does not see: a term may be wrong by no more than 20 times the error. Beyond 1
// distance alone decides.
constexpr double ceiling = 20;
// Of the error that was asked for: so small a sample cannot promise less.
constexpr double least_bound = 0.5;
// Of the full sum, which rounding to floats leaves.
constexpr double rounding = 1e-7;

double milliseconds(Clock::time_point since) {
    return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

// A receiver of the pilot: its weight is one over the probability that it was drawn.
struct Drawn {
    DirectionalSum::Part part;
    double weight;
};

// Shares by which receivers are drawn: half of the probability evenly, half by exitance squared. With little light on a
// large object an even sample would miss what the error is relative to.
std::vector<double> sharesOf(std::span<const Rgb> exitance) {
    const double count = static_cast<double>(exitance.size());
    std::vector<double> shares(exitance.size(), 0);
    for (int c = 0; c < Rgb::channels; ++c) {
        const auto square = [&](const Rgb& value) { return std::isfinite(value[c]) ? value[c] * value[c] : 0; };
        double total = 0;
        for (const Rgb& value : exitance) total += square(value);
        for (std::size_t i = 0; i < shares.size(); ++i)
            shares[i] += (0.5 / count + (total > 0 ? 0.5 * square(exitance[i]) / total : 0.5 / count)) / Rgb::channels;
    }
    return shares;
}

// Upper confidence limit of the relative RMSE of the worst channel, by the ratio estimator [Cochran1977, Eq. 6.13].
double errorBound(std::span<const Drawn> drawn, std::span<const Rgb> exact, std::span<const Rgb> found) {
    const double n = static_cast<double>(drawn.size());
    double worst = 0;
    for (int c = 0; c < Rgb::channels; ++c) {
        double errors = 0, squares = 0;
        const auto error = [&](std::size_t i) { return drawn[i].weight * std::pow(found[i][c] - exact[i][c], 2); };
        const auto square = [&](std::size_t i) { return drawn[i].weight * exact[i][c] * exact[i][c]; };
        for (std::size_t i = 0; i < drawn.size(); ++i) {
            errors += error(i);
            squares += square(i);
        }
        if (squares == 0 && errors == 0) continue;
        const double ratio = errors / squares;
        double deviations = 0;
        for (std::size_t i = 0; i < drawn.size(); ++i) deviations += std::pow(error(i) - ratio * square(i), 2);
        const double standard_error = n > 1 ? std::sqrt(n / (n - 1) * deviations) / squares : 0;
        worst = std::max(worst, missed * std::sqrt(ratio + confidence * standard_error));
    }
    return worst;
}

class DirectionalHierarchy final : public Technique {
public:
    void start(const RenderInput& input, const ParamValues& options, Observer&) override {
        const auto begin = Clock::now();
        const RenderInput::Versions& now = input.versions;
        const double error = std::get<double>(options.at("error"));
        const bool anew = !sum_ || threads_ != input.threads;
        if (anew) sum_.emplace(input.threads);
        const bool points = anew || now.points != seen_.points;
        const bool light = points || now.light != seen_.light;
        const bool material = points || now.material != seen_.material;
        const bool view = anew || now.view != seen_.view;
        threads_ = input.threads;
        exitance_.assign(input.visible->positions.size(), {});
        if (points) sum_->setPoints(*input.points);
        if (material) sum_->setModel(*input.model, *input.medium, modelParameters(input), *input.evaluator);
        if (light || material) sum_->setLight(*input.irradiance, !input.model->file.no_wi);
        if (view && !exitance_.empty()) sum_->setReceivers(*input.visible);
        if (light || material || view || error != error_) error_bound_ = 0;
        seen_ = now;
        error_ = error;
        next_group_ = 0;
        groups_per_slice_ = 1;
        evaluations_ = 0;
        pilot_ms_ = sum_ms_ = 0;
        if (error_bound_ == 0) {
            drawn_.clear();
            opening_ = error_;
            trials_ = 0;
            best_opening_ = best_bound_ = 0;
        }
        tree_ms_ = milliseconds(begin);
    }

    bool step(Observer& observer) override {
        if (observer.cancelled()) throw interruptedError();
        if (exitance_.empty()) return true;
        const auto begin = Clock::now();
        if (error_bound_ == 0) {
            if (drawn_.empty())
                draw();
            else if (exact_.size() < drawn_.size())
                sumPilotDirectly();
            else
                tryOpening();
            pilot_ms_ += milliseconds(begin);
            return false;
        }
        sumSlice(begin);
        observer.progress("hierarchical", next_group_, sum_->groups(), "groups");
        return next_group_ == sum_->groups();
    }

    std::span<const Rgbf> exitance() const override { return exitance_; }

    TechniqueReport report() const override {
        return {.stage_ms = {{"tree", tree_ms_}, {"pilot", pilot_ms_}, {"sum", sum_ms_}},
                .interactions = evaluations_,
                .error_bound = error_bound_,
                .approximates = "far points are summed at four points that have their moments",
                .device = sum_ ? sum_->backend() : "cpu"};
    }

private:
    void draw() {
        const std::size_t groups = sum_->groups(), count = std::min(groups, candidates);
        std::vector<DirectionalSum::Part> parts;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t group = groups * i / count, first = sum_->firstOf(group), last = sum_->firstOf(group + 1);
            // Another one of the group each time: 11 has no factor in common with the sizes that groups have.
            const std::size_t place = first + 11 * i % (last - first);
            parts.push_back({group, place, place + 1});
        }
        exact_.clear();
        if (count <= draws) {
            for (const DirectionalSum::Part& part : parts) drawn_.push_back({part, 1});
            return;
        }
        const std::vector<double> shares = sharesOf(sum_->sum(parts, rough_opening).exitance);
        double passed = 0;
        std::size_t at = 0;
        for (std::size_t k = 0; k < draws; ++k) {
            const double wanted = (static_cast<double>(k) + 0.5) / draws;
            while (at + 1 < count && passed + shares[at] <= wanted) passed += shares[at++];
            drawn_.push_back({parts[at], 1 / shares[at]});
        }
    }

    std::vector<DirectionalSum::Part> drawnParts(std::size_t first, std::size_t last) const {
        std::vector<DirectionalSum::Part> parts;
        for (std::size_t i = first; i < last; ++i) parts.push_back(drawn_[i].part);
        return parts;
    }

    void sumPilotDirectly() {
        const std::size_t done = exact_.size(), most = std::max<std::size_t>(1, pilot_evaluations / sum_->terms());
        const std::vector<DirectionalSum::Part> parts = drawnParts(done, std::min(drawn_.size(), done + most));
        const std::vector<Rgb> sums = sum_->sum(parts, 0).exitance;
        exact_.insert(exact_.end(), sums.begin(), sums.end());
    }

    // The error is about proportional to the opening, so a few trials find it.
    void tryOpening() {
        const std::vector<Rgb> found = sum_->sum(drawnParts(0, drawn_.size()), opening_).exitance;
        const double found_bound = errorBound(drawn_, exact_, found);
        const double bound = std::max(found_bound, least_bound * error_);
        const double most_opening = std::min(1.0, ceiling * error_);
        const bool keeps = bound <= error_;
        if (keeps && opening_ > best_opening_) {
            best_opening_ = opening_;
            best_bound_ = bound;
        }
        ++trials_;
        const bool close = keeps && (bound > 0.75 * error_ || opening_ == most_opening);
        if (close || trials_ == most_trials || (trials_ >= 4 && best_opening_ > 0)) {
            opening_ = best_opening_;
            error_bound_ = best_opening_ > 0 ? best_bound_ : rounding;
            return;
        }
        opening_ = std::min(most_opening,
                            opening_ * std::clamp(0.87 * error_ / std::max(found_bound, rounding), 1.0 / 64, 8.0));
    }

    void sumSlice(Clock::time_point begin) {
        const std::size_t last = std::min(next_group_ + groups_per_slice_, sum_->groups());
        std::vector<DirectionalSum::Part> parts;
        for (std::size_t group = next_group_; group < last; ++group)
            parts.push_back({group, sum_->firstOf(group), sum_->firstOf(group + 1)});
        const DirectionalSum::Result result = sum_->sum(parts, opening_);
        evaluations_ += result.evaluations;
        const std::size_t first = sum_->firstOf(next_group_);
        for (std::size_t i = 0; i < result.exitance.size(); ++i)
            exitance_[sum_->order()[first + i]] = toFloat(result.exitance[i]);
        const double ms = milliseconds(begin);
        sum_ms_ += ms;
        // Slowly up, at once down: groups differ.
        const double count = static_cast<double>(last - next_group_);
        groups_per_slice_ =
            std::max<std::size_t>(1, static_cast<std::size_t>(count * std::min(2.0, slice_ms / std::max(ms, 1e-3))));
        next_group_ = last;
    }

    std::optional<DirectionalSum> sum_;
    RenderInput::Versions seen_;
    int threads_ = 0;
    double error_ = 0;
    double opening_ = 0;      // that the pilot found
    double error_bound_ = 0;  // 0: not found yet
    std::vector<Drawn> drawn_;
    std::vector<Rgb> exact_;  // of the first of them
    int trials_ = 0;
    double best_opening_ = 0, best_bound_ = 0;
    std::size_t next_group_ = 0, groups_per_slice_ = 1;
    std::uint64_t evaluations_ = 0;
    double tree_ms_ = 0, pilot_ms_ = 0, sum_ms_ = 0;
    std::vector<Rgbf> exitance_;
};

}  // namespace

std::unique_ptr<Technique> makeDirectionalHierarchy() { return std::make_unique<DirectionalHierarchy>(); }

}  // namespace searchlight
