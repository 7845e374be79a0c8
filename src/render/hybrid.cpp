#include "render/hybrid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>

#include "render/hybrid/split.h"
#include "render/light_view/light_view_sum.h"
#include "render/texture_space.h"
#include "render/tsm.h"

namespace searchlight {

namespace {

// Shared with texture-space, with its own numbers of samples.
constexpr std::array global_options{"samples", "atlas", "uvs", "footprint", "own_light", "sum"};

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
    Hybrid() : global_(makeTextureSpace(nullptr)) {}

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
        local_.start(input, split_.local, splits_, static_cast<int>(number("local_samples")),
                     static_cast<int>(number("light_map")), observer);
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
            local_done_ = local_.step(exitance_, observer);
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
            "the near part of R_d is gathered from what the lights see, the far part from samples that all receivers "
            "share";
        for (int c = 0; c < Rgb::channels; ++c) {
            report.numbers[fmt::format("split_mm_{}", "rgb"[c])] = split_.border_mm[c];
            report.numbers[fmt::format("local_share_{}", "rgb"[c])] = split_.local_share[c];
        }
        local_.addTo(report);
        return report;
    }

private:
    std::unique_ptr<Technique> global_;
    LightViewSum local_;
    bool local_done_ = false;
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
    for (Param& param : lightViewOptions()) options.push_back(std::move(param));
    options.push_back({.name = "split",
                       .min = 0,
                       .max = 1,
                       .value = 0.1,
                       .doc = "where the local part ends: where light that arrives per mm of distance is so much of "
                              "all of it per distance between samples; 0: all is local"});
    return options;
}

std::unique_ptr<Technique> makeHybrid(gl::Context*) { return std::make_unique<Hybrid>(); }

}  // namespace searchlight
