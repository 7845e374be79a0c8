#include "render/texture_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <numeric>
#include <optional>

#include "base/error.h"
#include "gl/context.h"
#include "render/exitance_sum.h"
#include "render/hierarchical.h"
#include "render/texture/lit_texture.h"

namespace searchlight {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::time_point since) {
    return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

// Of the sums over samples by trees: small beside what the samples leave.
constexpr double tree_error = 0.001;

constexpr const char* uvs_words[] = {"automatic", "own", "file", "conformal"};

// Of a texel, times the mean, from which on a user should know: it blurs light like an atlas with a quarter of the
// side.
constexpr double much_surface = 16;

// Pairs of a receiver and a sample in one slice of a device's work.
constexpr std::size_t slice_pairs = 20'000'000;

class TextureSpace final : public Technique {
public:
    TextureSpace(gl::Context* context, std::shared_ptr<LitTexture> texture)
        : context_(context), texture_(std::move(texture)) {
        if (context) device_.emplace(*context);
    }

    void start(const RenderInput& input, const ParamValues& options, Observer& observer) override {
        stage_ms_.clear();
        const std::uint64_t light = texture_->refresh(input, options, stage_ms_, observer);
        if (light != light_ || now(input, options) != drawn_from_) draw(input, options, observer);
        light_ = light;
        input_ = input;
        exitance_.assign(input.visible->positions.size(), {});
        next_ = 0;
        if (samples_.dark || exitance_.empty()) return;
        if (!input.profile)
            prepareDirectional(observer);
        else if (device_)
            prepareDevice(options);
        else
            prepareRadial(options);
    }

    bool step(Observer& observer) override {
        if (samples_.dark || exitance_.empty()) return true;
        if (!input_.profile) {
            const bool done = directional_->step(observer);
            std::ranges::copy(directional_->exitance(), exitance_.begin());
            return done;
        }
        const auto begin = Clock::now();
        if (device_) return sumSlice(observer);
        sum_options_.observer = &observer;
        sumExitance(*points_, *table_, *receivers_, sum_options_, exitance_, &statistics_);
        stage_ms_["sum"] += milliseconds(begin);
        return true;
    }

    std::span<const Rgbf> exitance() const override { return exitance_; }

    TechniqueReport report() const override {
        TechniqueReport report{
            .stage_ms = stage_ms_,
            .interactions = statistics_.interactions + statistics_.expansions,
            .approximates = "the light of the whole surface stands in samples that all receivers share",
            .device = context_ ? "gl " + context_->info().renderer : "cpu"};
        if (device_) report.interactions = static_cast<std::uint64_t>(next_) * samples_.points.positions.size();
        if (directional_ && !samples_.dark && !input_.profile) {
            const TechniqueReport sum = directional_->report();
            for (const auto& [name, ms] : sum.stage_ms) report.stage_ms[name] += ms;
            report.interactions = sum.interactions;
            report.device = sum.device;
        }
        const AtlasReport& atlas = texture_->atlas().report;
        report.numbers = {{"charts", static_cast<double>(atlas.charts)},
                          {"atlas_fill", atlas.fill},
                          {"texels", static_cast<double>(texture_->map().size())},
                          {"stretch_l2", atlas.stretch.l2},
                          {"stretch_worst", atlas.stretch.worst},
                          {"area_distortion", atlas.stretch.area_rms},
                          {"largest_area", atlas.stretch.largest_area},
                          {"lit_area_mm2", samples_.lit_area_mm2}};
        if (!atlas.fault.empty())
            report.notes.push_back(
                fmt::format("The object's uvs are not used, but an atlas made for it: {}.", atlas.fault));
        if (atlas.from_file && atlas.stretch.largest_area > much_surface)
            report.notes.push_back(fmt::format(
                "The object's uvs are uneven: a texel stands for up to {:.0f} times the mean area; --uvs own is even.",
                atlas.stretch.largest_area));
        return report;
    }

private:
    static std::string now(const RenderInput& input, const ParamValues& options) {
        return fmt::format("{} {} {} {}", valueText(options.at("samples")), valueText(options.at("own_light")),
                           input.light.beams, input.light.seed);
    }

    void draw(const RenderInput& input, const ParamValues& options, Observer& observer) {
        const auto begin = Clock::now();
        drawn_from_.clear();
        samples_ = texture_->lit().draw(input,
                                        {.count = static_cast<std::size_t>(std::get<double>(options.at("samples"))),
                                         .own_light = std::get<bool>(options.at("own_light")),
                                         .beams = input.light.beams,
                                         .seed = input.light.seed},
                                        device_ ? &*device_ : nullptr, observer);
        ++draws_;
        drawn_from_ = now(input, options);
        points_.reset();
        stage_ms_["draw"] = milliseconds(begin);
    }

    // The area of the disc over which R_d is averaged.
    double cellArea(const ParamValues& options) const {
        const double texel = area() / static_cast<double>(texture_->map().size());
        const double sample = samples_.lit_area_mm2 / static_cast<double>(samples_.points.positions.size());
        return std::max(texel, std::get<double>(options.at("footprint")) * sample);
    }

    double area() const {
        const std::vector<float>& areas = texture_->map().cells.areas;
        return std::accumulate(areas.begin(), areas.end(), 0.0);
    }

    void prepareRadial(const ParamValues& options) {
        const auto begin = Clock::now();
        if (!points_) {
            points_.emplace(samples_.points, input_.threads);
            points_->setTransmitted(samples_.irradiance.transmitted, input_.threads);
        }
        const double cell = cellArea(options);
        const std::string table = fmt::format("{} {}", input_.versions.material, cell);
        if (table != table_from_) table_.emplace(*input_.profile, cell);
        table_from_ = table;
        if (receivers_of_ != input_.versions.view) receivers_.emplace(input_.visible->positions, input_.threads);
        receivers_of_ = input_.versions.view;
        sum_options_ = {.error = tree_error,
                        .one_by_one = std::get<std::string>(options.at("sum")) == "loop",
                        .threads = input_.threads,
                        .calibration = &calibration_,
                        .memory = &memory_};
        stage_ms_["tree"] = milliseconds(begin);
    }

    void prepareDevice(const ParamValues& options) {
        const auto begin = Clock::now();
        device_->setSamples(samples_.points, samples_.irradiance.transmitted);
        const double cell = cellArea(options);
        const std::string table = fmt::format("{} {}", input_.versions.material, cell);
        if (table != table_from_) device_->setProfile(*input_.profile, cell, area());
        table_from_ = table;
        if (receivers_of_ != input_.versions.view) device_->setReceivers(input_.visible->positions);
        receivers_of_ = input_.versions.view;
        stage_ms_["upload"] = milliseconds(begin);
    }

    bool sumSlice(Observer& observer) {
        if (observer.cancelled()) throw interruptedError();
        const auto begin = Clock::now();
        const std::size_t most = std::max<std::size_t>(1, slice_pairs / samples_.points.positions.size());
        const std::size_t count = std::min(most, exitance_.size() - next_);
        device_->sum(next_, std::span(exitance_).subspan(next_, count));
        next_ += count;
        stage_ms_["sum"] += milliseconds(begin);
        observer.progress("texture-space", next_, exitance_.size(), "receivers");
        return next_ == exitance_.size();
    }

    void prepareDirectional(Observer& observer) {
        if (!directional_) directional_ = makeHierarchical(context_);
        RenderInput inner = input_;
        inner.points = &samples_.points;
        inner.irradiance = &samples_.irradiance;
        inner.versions.points = inner.versions.light = draws_;
        directional_->start(inner, {{"error", 5 * tree_error}}, observer);
    }

    gl::Context* context_;
    std::optional<TextureGl> device_;  // where cells are chosen and radial models summed, if not on the CPU
    std::shared_ptr<LitTexture> texture_;
    std::string drawn_from_, table_from_;
    std::uint64_t light_ = 0;  // that samples were drawn from
    TextureSamples samples_;
    std::uint64_t draws_ = 0;
    std::optional<std::uint64_t> receivers_of_;  // the view that they are of
    std::size_t next_ = 0;                       // receiver of the device's next slice

    std::optional<PointTree> points_;
    std::optional<ReceiverTree> receivers_;
    std::optional<RadialTable> table_;
    SumOptions sum_options_;
    SumCalibration calibration_;
    SumMemory memory_;
    SumStatistics statistics_;
    std::unique_ptr<Technique> directional_;

    RenderInput input_;
    std::map<std::string, double> stage_ms_;
    std::vector<Rgbf> exitance_;
};

}  // namespace

std::vector<Param> textureSpaceOptions() {
    return {
        {.name = "samples",
         .type = ParamType::integer,
         .min = 1,
         .max = 1e6,
         .value = 1600.0,
         .doc = "of the light, drawn where it is bright"},
        {.name = "atlas",
         .type = ParamType::integer,
         .min = 16,
         .max = 4096,
         .value = 256.0,
         .doc = "texels along a side of the texture that the surface is spread out on"},
        {.name = "uvs",
         .type = ParamType::choice,
         .value = std::string(uvs_words[0]),
         .choices = {std::begin(uvs_words), std::end(uvs_words)},
         .doc = "of the atlas: the object's where they are sound, always own charts, always the object's, or few "
                "charts that keep angles and not areas"},
        {.name = "footprint",
         .min = 0,
         .max = 64,
         .value = 1.0,
         .doc = "R_d is averaged over a disc of so many times the area of a sample; 0: of a texel"},
        {.name = "own_light",
         .type = ParamType::toggle,
         .value = false,
         .doc = "each sample has the light at its own place instead of that at the middle of its texel: no error of "
                "texels is left, and more noise"},
        {.name = "sum",
         .type = ParamType::choice,
         .value = std::string("tree"),
         .choices = {"tree", "loop"},
         .doc = "over the samples: by trees to 0.1 %, or one by one, as OpenGL always does"}};
}

std::unique_ptr<Technique> makeTextureSpace(gl::Context* context) {
    return makeTextureSpace(context, std::make_shared<LitTexture>());
}

std::unique_ptr<Technique> makeTextureSpace(gl::Context* context, std::shared_ptr<LitTexture> texture) {
    return std::make_unique<TextureSpace>(context, std::move(texture));
}

}  // namespace searchlight
