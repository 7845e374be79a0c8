#include "render/separable.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <utility>

#include "base/error.h"
#include "gl/context.h"
#include "kernel/cells.h"
#include "kernel/ground_truth.h"
#include "kernel/methods.h"
#include "render/screen/back_light.h"
#include "render/screen/back_light_gl.h"
#include "render/screen/screen_filter.h"
#include "render/screen/screen_filter_gl.h"
#include "render/screen/strength_map.h"

namespace searchlight {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::time_point since) {
    return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

// Choices of an option, by their words.
template <class Value, std::size_t size>
using Words = std::array<std::pair<std::string_view, Value>, size>;

constexpr Words<FilterAxes, 3> axes_words{
    {{"surface", FilterAxes::surface}, {"screen", FilterAxes::screen}, {"turned", FilterAxes::turned}}};
constexpr Words<FilterTrust, 3> trust_words{
    {{"distance", FilterTrust::distance}, {"depth", FilterTrust::depth}, {"all", FilterTrust::all}}};

template <class Value, std::size_t size>
std::vector<std::string> wordsOf(const Words<Value, size>& words) {
    std::vector<std::string> list;
    for (const auto& [word, value] : words) list.emplace_back(word);
    return list;
}

template <class Value, std::size_t size>
Value chosen(const Words<Value, size>& words, const ParamValues& options, std::string_view name) {
    const auto& given = std::get<std::string>(options.find(name)->second);
    return std::ranges::find(words, given, &std::pair<std::string_view, Value>::first)->second;
}

double number(const ParamValues& options, std::string_view name) {
    return std::get<double>(options.find(name)->second);
}

constexpr std::string_view methods_of_rank[] = {"svd", "gaussians", "optimised"};
constexpr std::string_view kernel_options[] = {"kernel", "rank", "taps", "placed", "k"};

std::vector<std::string> methodNames() {
    std::vector<std::string> names;
    for (const Method& method : methods()) names.emplace_back(method.name);
    return names;
}

// What is asked for again is kept.
class Separable final : public Technique {
public:
    explicit Separable(gl::Context* context) : context_(context) {
        if (!context) return;
        device_.emplace(*context);
        // A software rasteriser draws the layers of a map in twenty times the time that rays take.
        if (context->info().hardware) back_device_.emplace(*context);
    }

    void start(const RenderInput& input, const ParamValues& options, Observer& observer) override {
        const auto begin = Clock::now();
        const RenderInput::Versions& now = input.versions;
        const bool view = !samples_ || now.view != seen_.view;
        const bool light = view || now.light != seen_.light;
        const bool material = !taps_ || now.material != seen_.material;
        const auto changed = [&](std::string_view name) {
            const auto before = options_.find(name);
            return before == options_.end() || before->second != options.find(name)->second;
        };
        if (view) {
            samples_ = screenSamples(*input.view, *input.visible, input.threads);
            if (device_) device_->setSamples(*samples_);
        }
        if (material || std::ranges::any_of(kernel_options, changed)) makeTaps(*input.profile, options);
        const double samples_ms = milliseconds(begin);

        const auto back_begin = Clock::now();
        if (light || material || changed("thickness")) {
            const BackLightOptions through{
                .thickness = thicknessOf(options), .eta = input.medium->eta, .threads = input.threads};
            back_ = back_device_ ? (*back_device_)(*input.visible, *input.scene, *input.object, *input.profile, through,
                                                   observer)
                                 : backLight(*input.visible, *input.scene, *input.object, *input.rays, *input.profile,
                                             through, observer);
        }
        if (view || changed("strength")) {
            const auto& path = std::get<std::string>(options.find("strength")->second);
            strength_ = path == "none" ? std::vector<float>()
                                       : strengthAt(path, *input.visible, *input.object, *input.rays, input.threads);
        }
        stage_ms_ = {{"samples", samples_ms}, {"back_light", milliseconds(back_begin)}};
        seen_ = now;
        options_ = options;
        // Light that shines through is blurred as well: the filter's factor is taken out of it.
        const Rgb per_total = {total_.r > 0 ? 1 / total_.r : 0, total_.g > 0 ? 1 / total_.g : 0,
                               total_.b > 0 ? 1 / total_.b : 0};
        light_.resize(samples_->count);
        for (std::size_t i = 0; i < light_.size(); ++i)
            light_[i] = toFloat(toDouble(input.irradiance->transmitted[i]) + per_total * toDouble(back_[i]));
        filter_ = {.axes = chosen(axes_words, options, "axes"),
                   .trust = chosen(trust_words, options, "trust"),
                   .width = number(options, "kernel_width"),
                   .reach = number(options, "reach"),
                   .fallback = number(options, "fallback"),
                   .strength = strength_,
                   .threads = input.threads};
        frames_ = filter_.axes == FilterAxes::turned ? static_cast<int>(number(options, "frames")) : 1;
        exitance_.assign(light_.size(), {});
    }

    bool step(Observer& observer) override {
        const auto begin = Clock::now();
        filter_.observer = &observer;
        if (device_)
            frame_ = device_->filter(light_, *taps_, filter_);
        else
            lanes_.filter(*samples_, light_, *taps_, filter_, frame_);
        // The mean of the frames so far.
        const float share = 1 / static_cast<float>(++filter_.frame);
        const Rgbf total = toFloat(total_);
        exitance_.resize(frame_.size());
        for (std::size_t i = 0; i < frame_.size(); ++i) {
            Rgbf& m = exitance_[i];
            m.r += share * (total.r * frame_[i].r - m.r);
            m.g += share * (total.g * frame_[i].g - m.g);
            m.b += share * (total.b * frame_[i].b - m.b);
        }
        stage_ms_["filter"] += milliseconds(begin);
        return filter_.frame == frames_;
    }

    std::span<const Rgbf> exitance() const override { return exitance_; }

    TechniqueReport report() const override {
        std::uint64_t pairs = 0;
        for (const TapTerm& term : taps_->terms)
            pairs += 2 * term.offsets_mm.size() * samples_->count * static_cast<std::uint64_t>(filter_.frame);
        return {.stage_ms = stage_ms_,
                .interactions = pairs,
                .approximates =
                    "light is moved within the picture alone, by a separable kernel in the tangent plane; "
                    "what entered out of sight counts along the lines to the lights",
                .device = context_ ? "gl " + context_->info().renderer : "cpu"};
    }

private:
    void makeTaps(const Profile& profile, const ParamValues& options) {
        const GroundTruth truth(profile);
        MethodOptions wanted{.method = std::get<std::string>(options.find("kernel")->second),
                             .taps = static_cast<int>(number(options, "taps")),
                             .placed = std::get<bool>(options.find("placed")->second)};
        wanted.rank = wanted.count = static_cast<int>(number(options, "rank"));
        wanted.guided.k = number(options, "k");
        if (wanted.rank > 1 && std::ranges::find(methods_of_rank, wanted.method) == std::end(methods_of_rank))
            throw usageError(fmt::format("{} makes kernels of rank 1", wanted.method),
                             fmt::format("--rank is for --kernel {}", fmt::join(methods_of_rank, ", ")));
        taps_ = makeKernel(truth, cellKernel(truth, gridOf(truth)), wanted).taps;
        total_ = truth.total();
    }

    gl::Context* context_;
    std::optional<ScreenFilterGl> device_;  // where the passes run, if not on the CPU
    std::optional<BackLightGl> back_device_;
    ScreenFilter lanes_;
    std::optional<ScreenSamples> samples_;
    std::optional<Taps> taps_;
    Rgb total_;
    std::vector<Rgbf> back_, light_, frame_, exitance_;
    std::vector<float> strength_;
    RenderInput::Versions seen_;
    ParamValues options_;
    ScreenFilterOptions filter_;  // its frame: how many were filtered
    int frames_ = 1;
    std::map<std::string, double> stage_ms_;
};

}  // namespace

std::vector<Param> separableOptions() {
    const auto choice = [](std::string name, std::vector<std::string> words, std::string doc) {
        Param param{.name = std::move(name), .type = ParamType::choice, .choices = std::move(words)};
        param.value = param.choices.front();
        param.doc = std::move(doc);
        return param;
    };
    return {
        choice("kernel", methodNames(), "the separable kernel that stands for R_d"),
        {.name = "rank",
         .type = ParamType::integer,
         .min = 1,
         .max = 12,
         .value = 1.0,
         .doc = "terms of the kernel, two passes each: of svd, gaussians and optimised"},
        {.name = "taps",
         .type = ParamType::integer,
         .min = 3,
         .max = 101,
         .value = 17.0,
         .doc = "samples of the kernel per pass, an odd number"},
        {.name = "placed",
         .type = ParamType::toggle,
         .value = false,
         .doc = "samples stand where they serve best, instead of quadratically"},
        {.name = "k",
         .min = 0,
         .max = 4,
         .value = 1.0,
         .doc = "of guided kernels: 0 favours the middle, 2 the far field"},
        choice("axes", wordsOf(axes_words),
               "along what the filter steps: the tangent plane, the picture, or the tangent plane by axes that turn "
               "from pixel to pixel"),
        choice("trust", wordsOf(trust_words),
               "what makes a pixel that lies off the kernel's plane count less: its distance or its depth"),
        {.name = "reach", .min = 0.01, .max = 1000, .value = 6.0, .doc = "of that, in mean offsets of the kernel"},
        {.name = "fallback",
         .min = 0,
         .max = 1,
         .value = 0.9,
         .doc = "of the middle's light, what stands for a place that is not seen or not trusted"},
        {.name = "frames",
         .type = ParamType::integer,
         .min = 1,
         .max = 64,
         .value = 1.0,
         .doc = "of axes that turn: pictures with patterns of their own, averaged as engines do over time"},
        {.name = "kernel_width", .min = 0, .max = 100, .value = 1.0, .doc = "times the width of the kernel"},
        {.name = "strength",
         .type = ParamType::text,
         .value = std::string("none"),
         .doc = "a picture over the texture coordinates: times the width, place by place; or none"},
        thicknessOption()};
}

std::unique_ptr<Technique> makeSeparable(gl::Context* context) { return std::make_unique<Separable>(context); }

}  // namespace searchlight
