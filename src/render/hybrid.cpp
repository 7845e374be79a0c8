#include "render/hybrid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>

#include "render/hybrid/split.h"
#include "render/hybrid/tangent_sum.h"
#include "render/light_view/light_view_sum.h"
#include "render/texture_space.h"
#include "render/tsm.h"

namespace searchlight {

namespace {

// Shared with texture-space, with its own numbers of samples.
constexpr std::array global_options{"samples", "atlas", "uvs", "footprint", "own_light", "sum"};

constexpr const char* local_words[] = {"light", "tangent"};

double meshArea(const Mesh& mesh) {
    double area = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 p = toDouble(mesh.positions[a]);
        area += 0.5 * length(cross(toDouble(mesh.positions[b]) - p, toDouble(mesh.positions[c]) - p));
    }
    return area;
}

class Hybrid final : public Technique {
public:
    Hybrid()
        : texture_(std::make_shared<LitTexture>()), global_(makeTextureSpace(nullptr, texture_)), planes_(texture_) {}

    void start(const RenderInput& input, const ParamValues& options, Observer& observer) override {
        const auto number = [&](const char* name) { return std::get<double>(options.at(name)); };
        if (area_of_ != input.versions.points) area_mm2_ = meshArea(input.object->mesh);
        area_of_ = input.versions.points;
        const double spacing = std::sqrt(area_mm2_ / number("samples"));
        const std::string from = fmt::format("{} {} {}", input.versions.material, spacing, number("split"));
        if (from != split_from_) {
            split_ = splitProfile(*input.profile, spacing, number("split"));
            ++splits_;
        }
        split_from_ = from;
        exitance_.assign(input.visible->positions.size(), {});
        by_planes_ = std::get<std::string>(options.at("local")) == local_words[1];
        const int samples = static_cast<int>(number("local_samples"));
        if (by_planes_)
            planes_.start(input, split_.local, samples);
        else
            views_.start(input, split_.local, splits_, samples, static_cast<int>(number("light_map")), observer);
        local_done_ = false;
        RenderInput inner = input;
        inner.profile = &split_.global;
        inner.versions.material = splits_;
        ParamValues inner_options;
        for (const char* name : global_options) inner_options[name] = options.at(name);
        global_->start(inner, inner_options, observer);
    }

    bool step(Observer& observer) override {
        if (exitance_.empty()) return true;
        if (!local_done_) {
            local_done_ = by_planes_ ? planes_.step(exitance_, observer) : views_.step(exitance_, observer);
            return false;
        }
        if (!global_->step(observer)) return false;
        const std::span<const Rgbf> far = global_->exitance();
        for (std::size_t i = 0; i < exitance_.size(); ++i) {
            Rgbf& m = exitance_[i];
            m = {m.r + far[i].r, m.g + far[i].g, m.b + far[i].b};
        }
        return true;
    }

    std::span<const Rgbf> exitance() const override { return exitance_; }

    TechniqueReport report() const override {
        TechniqueReport report = global_->report();
        report.approximates =
            by_planes_
                ? "the near part of R_d is gathered around each receiver, with the light of texels; the far part "
                  "is that of samples that all receivers share"
                : "the near part of R_d is gathered from what the lights see; the far part is that of samples "
                  "that all receivers share";
        for (int c = 0; c < Rgb::channels; ++c) {
            report.numbers[fmt::format("split_mm_{}", "rgb"[c])] = split_.border_mm[c];
            report.numbers[fmt::format("local_share_{}", "rgb"[c])] = split_.local_share[c];
        }
        if (by_planes_)
            planes_.addTo(report);
        else
            views_.addTo(report);
        return report;
    }

private:
    std::shared_ptr<LitTexture> texture_;
    std::unique_ptr<Technique> global_;
    LightViewSum views_;
    TangentSum planes_;
    bool by_planes_ = false, local_done_ = false;
    double area_mm2_ = 0;
    std::optional<std::uint64_t> area_of_;  // the object that it is of
    std::string split_from_;
    Split split_;
    std::uint64_t splits_ = 0;
    std::vector<Rgbf> exitance_;
};

}  // namespace

std::vector<Param> hybridOptions() {
    std::vector<Param> options;
    for (Param param : textureSpaceOptions()) {
        if (std::ranges::find(global_options, param.name) == global_options.end()) continue;
        if (param.name == "samples") param.value = 900.0;
        options.push_back(std::move(param));
    }
    options.push_back({.name = "local",
                       .type = ParamType::choice,
                       .value = std::string(local_words[0]),
                       .choices = {std::begin(local_words), std::end(local_words)},
                       .doc = "what comes from near: rings in what the lights see, or lines through the tangent plane "
                              "onto the surface, whose light is the atlas'"});
    for (Param& param : lightViewOptions()) options.push_back(std::move(param));
    options.push_back({.name = "split",
                       .min = 1e-4,
                       .max = 1,
                       .value = 0.1,
                       .doc = "where the near part ends: from there on less than this part of the light arrives per "
                              "distance between samples"});
    return options;
}

std::unique_ptr<Technique> makeHybrid(gl::Context*) { return std::make_unique<Hybrid>(); }

}  // namespace searchlight
