#include "job/live/live_spheres.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/object.h"
#include "job/model_stamp.h"
#include "job/render/render_material.h"
#include "render/cell_view.h"
#include "render/sphere/sphere_reference.h"
#include "render/view.h"

namespace searchlight {

namespace {

constexpr std::uint64_t kFirstWalks = 65'536;  // a tenth of a second

Scene sphereScene(const SphereRequest& request) {
    Scene scene = request.scene;
    scene.object = "sphere";
    return scene;
}

// What the integrals depend on: not the camera.
std::string keyOf(const SphereRequest& request) {
    Scene scene = sphereScene(request);
    scene.camera = {};
    scene.ground.reset();
    scene.coat.reset();
    scene.backdrop.reset();
    return sceneJson(scene) + fmt::format("{} {} ", request.cells, request.seed) + modelStamp(scene.model.id);
}

}  // namespace

struct LiveSpheres::Stage {
    Scene scene;
    Object object;
    LightSampler lights;
    Medium medium;
    Ball ball;
    std::optional<RenderMaterial> material;
    std::optional<SphereIntegral> integral;
    SphereReference reference;
    std::optional<Error> error;
    CellView view;
    std::string view_key;

    Stage(const SphereRequest& request, const Medium& of)
        : scene(sphereScene(request)),
          object(placeObject(scene)),
          lights(scene, object),
          medium(of),
          ball(0.5 * scene.scale, std::numbers::pi * scene.scale * scene.scale / request.cells),
          reference(ball, lights, medium, request.seed) {}

    const CellView& seen(const SphereRequest& request) {
        Scene only;
        only.camera = request.scene.camera;
        const std::string key = sceneJson(only) + fmt::format("{} {}", request.width, request.height);
        if (key != view_key) {
            const View camera = makeView(request.scene.camera, object, request.width, request.height);
            view = cellView(camera, ball, medium.eta);
            view_key = key;
        }
        return view;
    }
};

void LiveSpheres::forgetModel() {
    key_.clear();
    stage_.reset();
}

void LiveSpheres::prepare(const SphereRequest& request) {
    const std::string key = keyOf(request);
    if (key == key_) return;
    key_.clear();
    stage_.reset();
    Job job;
    job.scene = request.scene;
    stage_ = std::make_shared<Stage>(request, subjectOf(job, engine_).medium);
    try {
        stage_->material.emplace(materialSource(engine_, "auto", nullptr)(stage_->scene));
        stage_->integral.emplace(stage_->ball, stage_->lights, stage_->material->model, *stage_->material->evaluator,
                                 stage_->medium, SphereIntegralOptions{.seed = request.seed});
    } catch (const Error& error) {
        stage_->integral.reset();
        stage_->error = error;
    }
    key_ = key;
}

bool LiveSpheres::improve(const SphereRequest& request, Observer& observer) {
    prepare(request);
    Stage& stage = *stage_;
    if (stage.lights.dark()) return false;
    bool more = false;
    if (stage.integral && static_cast<double>(stage.integral->samples()) < request.samples) {
        // Two, then as many as there are, up to 16 at a time.
        const auto have = static_cast<int>(stage.integral->samples());
        try {
            stage.integral->add(std::clamp(have, 2, 16), observer);
        } catch (const Error& error) {
            if (error.kind == ErrorKind::interrupted) throw;
            stage.integral.reset();
            stage.error = error;
        }
        more = true;
    }
    // Walks are drawn: a few less than were asked for are all.
    const auto walks = static_cast<double>(stage.reference.walks());
    const bool scatters = stage.medium.scatters(0) || stage.medium.scatters(1) || stage.medium.scatters(2);
    if (scatters && walks < 0.98 * request.walks) {
        const double next = std::min(request.walks, std::max<double>(kFirstWalks, 1.5 * walks));
        stage.reference.walkTo(static_cast<std::uint64_t>(next), observer);
        more = true;
    }
    return more;
}

SpherePictures LiveSpheres::pictures(const SphereRequest& request) {
    prepare(request);
    Stage& stage = *stage_;
    SpherePictures pictures;
    pictures.error = stage.error;
    if (stage.lights.dark()) return pictures;
    const CellView& view = stage.seen(request);
    const SphereExitance theirs = stage.reference.exitance();
    const bool walked = stage.reference.walks() > 0, summed = stage.integral && stage.integral->samples() > 0;
    pictures.walks = stage.reference.walks();
    if (walked) pictures.reference = pictureOfRadiance(view, cellValues(theirs.mean));
    if (summed) {
        const SphereExitance ours = stage.integral->exitance();
        pictures.samples = stage.integral->samples();
        pictures.model = pictureOfRadiance(view, cellValues(ours.mean));
        if (walked) pictures.errors = sphereErrors(view, ours, theirs);
    }
    pictures.exposure = suitedExposure(walked ? pictures.reference : pictures.model);
    pictures.done = static_cast<double>(pictures.walks) >= 0.98 * request.walks &&
                    (!stage.integral || static_cast<double>(pictures.samples) >= request.samples);
    return pictures;
}

}  // namespace searchlight
