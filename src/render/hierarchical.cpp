#include "render/hierarchical.h"

#include <chrono>
#include <optional>

#include "render/directional_hierarchy.h"
#include "render/exitance_sum.h"
#include "render/hierarchical_gl.h"

namespace searchlight {

namespace {

class RadialHierarchy final : public Technique {
public:
    void start(const RenderInput& input, const ParamValues& options, Observer&) override {
        const auto begin = std::chrono::steady_clock::now();
        const RenderInput::Versions& now = input.versions;
        const bool new_points = !points_ || now.points != seen_.points;
        if (new_points) points_.emplace(*input.points, input.threads);
        if (new_points || now.light != seen_.light)
            points_->setTransmitted(input.irradiance->transmitted, input.threads);
        if (new_points || now.material != seen_.material) table_.emplace(*input.profile, points_->meanArea());
        if (!receivers_ || now.view != seen_.view) receivers_.emplace(input.visible->positions, input.threads);
        seen_ = now;
        options_ = {.error = std::get<double>(options.at("error")),
                    .threads = input.threads,
                    .calibration = &calibration_,
                    .memory = &memory_};
        tree_ms_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    }

    bool step(Observer& observer) override {
        options_.observer = &observer;
        sumExitance(*points_, *table_, *receivers_, options_, exitance_, &statistics_);
        return true;
    }

    std::span<const Rgbf> exitance() const override { return exitance_; }

    TechniqueReport report() const override {
        return {.stage_ms = {{"tree", tree_ms_}, {"pilot", statistics_.pilot_ms}, {"sum", statistics_.sum_ms}},
                .interactions = statistics_.interactions + statistics_.expansions,
                .error_bound = statistics_.error_bound,
                .approximates = "far points are summed together, as expansions about the centres of their groups",
                .device = "cpu"};
    }

private:
    std::optional<PointTree> points_;
    std::optional<ReceiverTree> receivers_;
    std::optional<RadialTable> table_;
    RenderInput::Versions seen_;
    SumOptions options_;
    SumCalibration calibration_;
    SumMemory memory_;
    SumStatistics statistics_;
    double tree_ms_ = 0;
    std::vector<Rgbf> exitance_;
};

// The one that is not used forgets everything, as it does not see what changes.
class Hierarchical final : public Technique {
public:
    void start(const RenderInput& input, const ParamValues& options, Observer& observer) override {
        const bool radial = input.profile != nullptr;
        if (!chosen_ || radial != radial_)
            chosen_ = radial ? std::make_unique<RadialHierarchy>() : makeDirectionalHierarchy();
        radial_ = radial;
        chosen_->start(input, options, observer);
    }
    bool step(Observer& observer) override { return chosen_->step(observer); }
    std::span<const Rgbf> exitance() const override { return chosen_->exitance(); }
    TechniqueReport report() const override { return chosen_->report(); }

private:
    bool radial_ = false;
    std::unique_ptr<Technique> chosen_;
};

}  // namespace

std::unique_ptr<Technique> makeHierarchical(gl::Context* context) {
    if (context) return makeHierarchicalGl(context);
    return std::make_unique<Hierarchical>();
}

}  // namespace searchlight
