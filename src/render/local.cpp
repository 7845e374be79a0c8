#include "render/local.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include "geometry/point_cache.h"
#include "geometry/surface_points.h"
#include "render/exitance_sum.h"
#include "render/screen/contours.h"
#include "render/screen/tangent_samples.h"

namespace searchlight {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds(Clock::time_point since) {
    return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

int whole(const ParamValues& options, std::string_view name) {
    return static_cast<int>(std::get<double>(options.find(name)->second));
}

// Of the sum over points that are not seen: below the noise of the samples.
constexpr double unseen_error = 0.005;

class Local final : public Technique {
public:
    void start(const RenderInput& input, const ParamValues& options, Observer& observer) override {
        const auto begin = Clock::now();
        const RenderInput::Versions& now = input.versions;
        const bool first = options_.empty();
        const auto changed = [&](const char* name) {
            return first || options_.find(name)->second != options.find(name)->second;
        };
        const bool object = first || now.points != seen_.points || changed("global_points");
        const bool view = first || now.view != seen_.view || changed("global_points"),
                   light = first || now.light != seen_.light;
        const bool material = first || now.material != seen_.material;
        input_ = input;
        if (view) {
            patches_ = screenPatches(*input.view, *input.visible, input.threads);
            // Where no points stand in, a poor patch is better than none.
            if (whole(options, "global_points") > 0) takeContours(patches_);
        }
        if (view || light) setLight(*input.visible, input.irradiance->transmitted, patches_);
        if (material || changed("samples")) makeSampler(whole(options, "samples"));
        patches_ms_ = milliseconds(begin);

        const auto unseen_begin = Clock::now();
        if (object) choosePoints(whole(options, "global_points"), observer);
        if (object || light) lightPoints(observer);
        if (object || light || view) keepUnseen();
        if (unseen_ && (object || light || view || material)) table_.emplace(*input.profile, unseen_->meanArea());
        // Also where nothing needs them now: the next start may, with the same view.
        if (view) receivers_.reset();
        if (unseen_ && !receivers_) receivers_.emplace(input.visible->positions, input.threads);
        unseen_ms_ = milliseconds(unseen_begin);
        seen_ = now;
        options_ = options;
    }

    bool step(Observer& observer) override {
        const auto begin = Clock::now();
        exitance_.assign(input_.visible->positions.size(), {});
        if (sampler_) sampler_->gather(patches_, input_.threads, observer, exitance_);
        local_ms_ = milliseconds(begin);
        const auto global_begin = Clock::now();
        if (unseen_) {
            const std::vector<Rgbf> more =
                sumExitance(*unseen_, *table_, *receivers_,
                            {.error = unseen_error, .threads = input_.threads, .observer = &observer}, &statistics_);
            for (std::size_t i = 0; i < more.size(); ++i) {
                Rgbf& m = exitance_[i];
                m = {m.r + more[i].r, m.g + more[i].g, m.b + more[i].b};
            }
        }
        global_ms_ = milliseconds(global_begin);
        return true;
    }

    std::span<const Rgbf> exitance() const override { return exitance_; }

    TechniqueReport report() const override {
        return {.stage_ms = {{"patches", patches_ms_},
                             {"unseen", unseen_ms_},
                             {"local", local_ms_},
                             {"global", global_ms_}},
                .interactions = samples_ * patches_.source.size() + statistics_.interactions + statistics_.expansions,
                .approximates =
                    "the surface that is seen is a patch of a plane per pixel; what is hidden counts by "
                    "points, and nothing is known at the border of both",
                .device = "cpu"};
    }

private:
    void makeSampler(int samples) {
        samples_ = static_cast<std::size_t>(samples);
        sampler_.reset();
        const Rgb total = input_.profile->total();
        if (total == Rgb{}) return;
        const int facing = samples / 4;
        sampler_.emplace(*input_.profile, samples - facing, facing, input_.light.seed);
    }

    void choosePoints(int count, Observer& observer) {
        points_ = {};
        if (count == 0) return;
        const Object& object = *input_.object;
        const PointOptions options{
            .count = static_cast<std::size_t>(count), .seed = input_.light.seed, .threads = input_.threads};
        points_ = input_.points_cache
                      ? cachedPoints(object.mesh, object.content_hash, options, *input_.points_cache, observer).cloud
                      : samplePoints(object.mesh, options, observer);
    }

    void lightPoints(Observer& observer) {
        flux_.clear();
        if (points_.positions.empty()) return;
        IrradianceOptions options = input_.light;
        options.beams = false;
        flux_ = computeIrradiance({points_.positions, points_.normals}, *input_.scene, *input_.object, input_.rays,
                                  options, observer)
                    .transmitted;
    }

    void keepUnseen() {
        const View& view = *input_.view;
        const auto inCamera = [&](Vec3 v) {
            return toFloat(Vec3{dot(v, view.right), -dot(v, view.up), dot(v, view.forward)});
        };
        PointCloud cloud;
        std::vector<Rgbf> flux;
        for (std::size_t i = 0; i < points_.positions.size(); ++i) {
            if (isSeen(patches_, inCamera(toDouble(points_.positions[i]) - view.eye),
                       inCamera(toDouble(points_.normals[i]))))
                continue;
            cloud.positions.push_back(points_.positions[i]);
            cloud.normals.push_back(points_.normals[i]);
            cloud.areas.push_back(points_.areas[i]);
            flux.push_back(flux_[i]);
        }
        unseen_.reset();
        if (cloud.positions.empty()) return;
        unseen_.emplace(cloud, input_.threads);
        unseen_->setTransmitted(flux, input_.threads);
    }

    RenderInput input_;
    RenderInput::Versions seen_;
    ParamValues options_;
    ScreenPatches patches_;
    std::optional<TangentSampler> sampler_;
    std::size_t samples_ = 0;
    PointCloud points_;
    std::vector<Rgbf> flux_;  // at points_
    std::optional<PointTree> unseen_;
    std::optional<RadialTable> table_;
    std::optional<ReceiverTree> receivers_;
    SumStatistics statistics_;
    double patches_ms_ = 0, unseen_ms_ = 0, local_ms_ = 0, global_ms_ = 0;
    std::vector<Rgbf> exitance_;
};

}  // namespace

std::vector<Param> localOptions() {
    return {{.name = "samples",
             .type = ParamType::integer,
             .min = 1,
             .max = 1e6,
             .value = 64.0,
             .doc = "of the light around each sample of the picture"},
            {.name = "global_points",
             .type = ParamType::integer,
             .min = 0,
             .max = 1e6,
             .value = 100'000.0,
             .doc = "points of the surface, those of which count that are not seen; 0: what is not seen is dark"}};
}

std::unique_ptr<Technique> makeLocal(gl::Context*) { return std::make_unique<Local>(); }

}  // namespace searchlight
