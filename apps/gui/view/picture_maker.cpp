#include "gui/view/picture_maker.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "base/error.h"
#include "geometry/point_cache.h"
#include "model/sum_model.h"
#include "render/light_picture.h"

namespace searchlight::gui {

namespace {

constexpr double longest_moving_ms = 250, between_steps_ms = 400;

/// The renderer owns its evaluator, and this one outlives the renderer's.
class BorrowedEvaluator : public Evaluator {
public:
    explicit BorrowedEvaluator(std::shared_ptr<Evaluator> lender) : lender_(std::move(lender)) {}

    void set(const Medium& medium, const ParamValues& parameters) override { lender_->set(medium, parameters); }
    void evaluate(std::span<const Query> queries, std::span<Rgb> values) override {
        lender_->evaluate(queries, values);
    }
    Rgb diffuseReflectance(Rgb alpha_prime) override { return lender_->diffuseReflectance(alpha_prime); }
    std::string backend() const override { return lender_->backend(); }

private:
    std::shared_ptr<Evaluator> lender_;
};

std::optional<CacheFolder> pointCache() {
    try {
        return userPointCache();
    } catch (const Error&) {
        return std::nullopt;  // no home, no cache
    }
}

RenderSettings settingsOf(const PictureRequest& request, std::size_t points) {
    RenderSettings settings;
    settings.width = request.width;
    settings.height = request.height;
    settings.preview = request.preview;
    settings.technique = request.technique;
    settings.technique_options = request.technique_options;
    settings.edge_samples = request.moving ? 2 : 8;
    settings.light_samples = request.moving ? 64 : 256;
    settings.seed = request.seed;
    settings.points_cache = pointCache();
    if (request.moving) settings.points = points;
    // Pictures of the light need points of irradiance, which not every technique has.
    if (request.layer != "picture" && findTechnique(request.technique).light_at != LightPlace::points) {
        settings.technique = "brute_force";
        settings.technique_options.clear();
    }
    return settings;
}

bool hasSurroundings(const Scene& scene) {
    return scene.ground || scene.backdrop || std::ranges::any_of(scene.lights, [](const Light& light) {
               return std::holds_alternative<EnvironmentLight>(light);
           });
}

std::shared_ptr<const std::vector<float>> coverageOf(const VisibleSurface& visible) {
    auto coverage = std::make_shared<std::vector<float>>(static_cast<std::size_t>(visible.width) *
                                                         static_cast<std::size_t>(visible.height));
    for (std::size_t i = 0; i < visible.pixels.size(); ++i) (*coverage)[visible.pixels[i]] += visible.coverage[i];
    return coverage;
}

}  // namespace

Picture PictureMaker::make(const std::string& side, const PictureRequest& request, TaskContext& context,
                           const std::function<void(const Picture&)>& so_far) {
    try {
        return makeOnce(side, request, context, so_far);
    } catch (const Error& error) {
        if (error.kind != ErrorKind::device || !context.engine().contextLost()) throw;
    }
    // A context that was lost is built again once; what is lost in the same picture twice is the model's fault.
    clear();
    context.engine().dropContext();
    return makeOnce(side, request, context, so_far);
}

Picture PictureMaker::makeOnce(const std::string& name, const PictureRequest& request, TaskContext& context,
                               const std::function<void(const Picture&)>& so_far) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    const auto msSince = [](Clock::time_point time) {
        return std::chrono::duration<double, std::milli>(Clock::now() - time).count();
    };
    Side& side = sides_[name];
    const bool needs_context = request.scene.coat && !request.scene.coat->brdf.empty();
    if (!side.renderer || (needs_context && !side.has_context)) {
        side.has_context = needs_context;
        Engine& engine = context.engine();
        side.renderer = std::make_unique<Renderer>(
            [this, &side, &engine](const Scene& scene) { return materialOf(scene, engine, side); },
            needs_context ? &engine.context() : nullptr);
    }
    Renderer& renderer = *side.renderer;
    const auto same = [](const SceneModel& x, const SceneModel& y) {
        return x.id == y.id && x.parameters == y.parameters;
    };
    if (side.inverted_by.has_value() != request.inverted_by.has_value() ||
        (side.inverted_by && !same(*side.inverted_by, *request.inverted_by))) {
        side.inverted_by = request.inverted_by;
        renderer.forgetMaterial();
    }
    renderer.setScene(request.scene);
    renderer.setSettings(settingsOf(request, side.points));
    Picture picture;
    renderer.start(context);
    if (hasSurroundings(request.scene)) picture.coverage = coverageOf(*renderer.stages().visible);
    if (request.layer == "picture") {
        auto told = Clock::now();
        while (!renderer.step(context)) {
            if (context.cancelled()) throw interruptedError();
            if (request.moving && msSince(begin) > longest_moving_ms) break;
            if (request.moving || msSince(told) < between_steps_ms) continue;
            picture.image = std::make_shared<const Image>(renderer.image(context));
            picture.report = renderer.report();
            picture.subject = side.subject;
            picture.ms = msSince(begin);
            so_far(picture);
            told = Clock::now();
        }
        picture.image = std::make_shared<const Image>(renderer.image(context));
    } else {
        picture.image = std::make_shared<const Image>(request.layer == "points" ? pointsPicture(renderer.stages())
                                                                                : irradiancePicture(renderer.stages()));
    }
    picture.report = renderer.report();
    picture.subject = side.subject;
    if (!request.moving && !renderer.stages().object->isMesh()) side.points = 0;
    if (!request.moving && renderer.stages().object->isMesh()) side.points = picture.report.points;
    picture.ms = msSince(begin);
    return picture;
}

RenderMaterial PictureMaker::materialOf(const Scene& scene, Engine& engine, Side& side) {
    Job job;
    job.scene = scene;
    if (side.inverted_by) job.scene.model = *side.inverted_by;
    Subject& subject = side.subject;
    subject = subjectOf(job, engine);
    if (!subject.comparable)
        subject.notes.emplace_back("The material's table does not state its unit: it was taken as 1/mm.");
    const std::string& id = scene.model.id;
    auto known = files_.find(id);
    if (known == files_.end()) {
        Model model = loadModel(id);
        std::shared_ptr<Evaluator> evaluator = engine.makeEvaluator(model, "auto");
        known = files_.emplace(id, LoadedFile{std::move(model), std::move(evaluator)}).first;
    }
    const auto& [model, evaluator] = known->second;
    std::vector<std::string> settings;
    for (const auto& [name, value] : scene.model.parameters)
        settings.push_back(fmt::format("{}={}", name, valueText(value)));
    evaluator->set(subject.medium, parseSettings(model, settings));
    return {model, subject.medium, std::make_unique<BorrowedEvaluator>(evaluator)};
}

void PictureMaker::modelFileChanged(const std::string& id) {
    std::erase_if(files_, [&](const auto& each) {
        const std::vector<std::string> parts = partNames(each.first);
        return std::ranges::find(parts, id) != parts.end();
    });
    for (auto& [name, side] : sides_)
        if (side.renderer) side.renderer->forgetMaterial();
}

void PictureMaker::clear() {
    sides_.clear();
    files_.clear();
}

}  // namespace searchlight::gui
