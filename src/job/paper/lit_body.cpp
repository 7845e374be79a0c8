#include "job/paper/lit_body.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "geometry/surface_points.h"
#include "light/irradiance.h"
#include "model/plane.h"
#include "render/cell_view.h"
#include "render/technique.h"
#include "transport/mesh/first_orders.h"
#include "transport/mesh/reference_body.h"

namespace searchlight {

namespace {

// Of a cell, by which models are averaged over it: the exitance is smooth over a few pixels.
constexpr int points_per_cell = 4;
// Of the hierarchical sum, far below the noise of any reference here.
constexpr double sum_error = 0.005;

// Closer than the default, which leaves room around the object: pictures on a sheet have room of their own.
View viewOf(const Scene& scene, const Object& object, const LitBodyOptions& options) {
    constexpr double closer = 0.78;
    Camera camera = framedCamera(scene.camera, object, options.width, options.height);
    if (scene.camera.distance == 0) camera.distance *= closer;
    return makeView(camera, object, options.width, options.height);
}

MeshBody bodyOf(const Object& object, const Medium& medium, const View& camera, const LitBodyOptions& options) {
    const double pixel = 2 * camera.tan_half / camera.height * length(camera.eye);
    const Rgb sigma_t = medium.sigmaT();
    return {object.mesh,
            {.cell_area_mm2 = options.cell_pixels * pixel * pixel,
             .shortest_mfp = 1 / std::max({sigma_t.r, sigma_t.g, sigma_t.b}),
             .threads = options.threads}};
}

LoadedModel load(const BodyModel& model, Engine& engine, const std::string& backend, const Medium& medium) {
    std::vector<std::string> settings;
    for (const auto& [name, value] : model.parameters) settings.push_back(name + "=" + valueText(value));
    return engine.load(model.id, settings, backend, medium);
}

SphereExitance emptyExitance(const Medium& medium, std::size_t cells) {
    SphereExitance exitance;
    for (int c = 0; c < Rgb::channels; ++c) {
        if (!medium.scatters(c)) continue;
        exitance.mean[static_cast<std::size_t>(c)].assign(cells, 0.0);
        exitance.standard_error[static_cast<std::size_t>(c)].assign(cells, 0.0);
    }
    return exitance;
}

}  // namespace

LitBody::LitBody(Scene scene, const Medium& medium, const LitBodyOptions& options, Observer& observer)
    : scene_(std::move(scene)),
      medium_(medium),
      options_(options),
      object_(placeObject(scene_)),
      lights_(scene_, object_),
      camera_(viewOf(scene_, object_, options)),
      rays_(object_.mesh),
      body_(bodyOf(object_, medium, camera_, options)),
      view_(cellView(camera_, body_, medium.eta, options.threads)) {
    if (lights_.dark()) throw usageError("a picture needs light", "such as --light dir:1,1,1");
    points_ = samplePoints(object_.mesh, {.count = options.points, .seed = options.seed, .threads = options.threads},
                           observer);
    std::vector<bool> is_seen(body_.cellCount(), false);
    for (const CellSample& sample : view_.samples) is_seen[sample.cell] = true;
    normals_.assign(body_.cellCount(), {});
    const CellPoints all = body_.cells().sample(body_.mesh(), points_per_cell, options.seed);
    for (std::size_t i = 0; i < all.cells.size(); ++i) {
        if (!is_seen[all.cells[i]]) continue;
        seen_.cells.push_back(all.cells[i]);
        seen_.triangles.push_back(all.triangles[i]);
        seen_.positions.push_back(all.positions[i]);
        seen_.normals.push_back(all.normals[i]);
        normals_[all.cells[i]] = normals_[all.cells[i]] + toDouble(all.normals[i]);
    }
    for (Vec3& normal : normals_)
        if (length(normal) > 0) normal = normalize(normal);
}

SphereExitance LitBody::walk(std::uint64_t walks, std::uint64_t seed, Observer& observer) const {
    SphereExitance exitance;
    for (int c = 0; c < Rgb::channels; ++c) {
        if (!medium_.scatters(c)) continue;
        BodyResult walked = walkBody(body_, medium_, c, &lights_,
                                     {.walks = walks, .seed = seed, .threads = options_.threads}, observer);
        exitance.mean[static_cast<std::size_t>(c)] = std::move(walked.exitance);
        exitance.standard_error[static_cast<std::size_t>(c)] = std::move(walked.standard_error);
    }
    return exitance;
}

FirstExitance LitBody::firstOrders(std::uint64_t walks, Observer& observer) const {
    FirstExitance first;
    Medium similar = medium_;
    similar.sigma_s = medium_.sigma_s * (Rgb{1, 1, 1} - medium_.g * medium_.g);
    const BodyOptions options{.walks = walks, .seed = options_.seed, .threads = options_.threads};
    for (int c = 0; c < Rgb::channels; ++c) {
        if (!medium_.scatters(c)) continue;
        const auto channel = static_cast<std::size_t>(c);
        FirstOrders own = walkFirstOrders(body_, medium_, c, &lights_, options, observer);
        first.single.mean[channel] = std::move(own.single);
        first.single.standard_error[channel] = std::move(own.single_error);
        first.unscattered.mean[channel] = std::move(own.unscattered);
        first.unscattered.standard_error[channel] = std::move(own.unscattered_error);
        FirstOrders other = walkFirstOrders(body_, similar, c, &lights_, options, observer, false);
        first.unscattered_similar.mean[channel] = std::move(other.unscattered);
        first.unscattered_similar.standard_error[channel] = std::move(other.unscattered_error);
    }
    return first;
}

SphereExitance LitBody::model(const BodyModel& model, Engine& engine, const std::string& backend,
                              Observer& observer) const {
    LoadedModel loaded = load(model, engine, backend, medium_);
    Scene scene = scene_;
    scene.model = {model.id, model.parameters};
    std::optional<Profile> profile;
    if (isRadial(loaded.model)) profile = tabulate(*loaded.evaluator, loaded.model, medium_).profile;
    const IrradianceOptions light{.eta = medium_.eta,
                                  .normals = LitNormals::geometric,
                                  .beams = !profile && !loaded.model.file.no_wi,
                                  .seed = options_.seed,
                                  .threads = options_.threads};
    const Irradiance irradiance =
        computeIrradiance({points_.positions, points_.normals}, scene, object_, &rays_, light, observer);
    VisibleSurface receivers{.width = camera_.width, .height = camera_.height, .eye = camera_.eye};
    receivers.positions = seen_.positions;
    receivers.normals = receivers.geometric_normals = seen_.normals;
    receivers.coverage.assign(seen_.cells.size(), 1.0f);
    receivers.pixels.assign(seen_.cells.size(), 0);
    const TechniqueEntry& entry = findTechnique("hierarchical");
    ParamValues options;
    for (const Param& param : entry.options) options[param.name] = valueOf(param, {});
    options["error"] = sum_error;
    const std::unique_ptr<Technique> technique = entry.make(nullptr);
    technique->start({.scene = &scene,
                      .object = &object_,
                      .rays = &rays_,
                      .points = &points_,
                      .irradiance = &irradiance,
                      .visible = &receivers,
                      .view = &camera_,
                      .model = &loaded.model,
                      .evaluator = loaded.evaluator.get(),
                      .medium = &medium_,
                      .profile = profile ? &*profile : nullptr,
                      .light = light,
                      .threads = options_.threads},
                     options, observer);
    while (!technique->step(observer)) {
    }
    const std::vector<Rgb> means = averageOverCells(seen_, technique->exitance(), body_.cellCount());
    SphereExitance exitance = emptyExitance(medium_, body_.cellCount());
    for (std::size_t c = 0; c < exitance.mean.size(); ++c)
        for (std::size_t cell = 0; cell < exitance.mean[c].size(); ++cell)
            exitance.mean[c][cell] = means[cell][static_cast<int>(c)];
    return exitance;
}

Image LitBody::picture(const SphereExitance& exitance) const {
    return pictureOfRadiance(view_, cellValues(exitance.mean));
}

Image LitBody::errorPicture(const SphereExitance& exitance) const {
    return pictureOfError(view_, cellValues(exitance.standard_error));
}

SphereExitance operator+(const SphereExitance& a, const SphereExitance& b) {
    SphereExitance sum = a;
    for (std::size_t c = 0; c < sum.mean.size(); ++c)
        for (std::size_t cell = 0; cell < sum.mean[c].size(); ++cell) {
            sum.mean[c][cell] += b.mean[c][cell];
            sum.standard_error[c][cell] = std::hypot(a.standard_error[c][cell], b.standard_error[c][cell]);
        }
    return sum;
}

SphereExitance meanOf(const SphereExitance& a, const SphereExitance& b) {
    SphereExitance mean = a + b;
    for (std::size_t c = 0; c < mean.mean.size(); ++c)
        for (std::size_t cell = 0; cell < mean.mean[c].size(); ++cell) {
            mean.mean[c][cell] *= 0.5;
            mean.standard_error[c][cell] *= 0.5;
        }
    return mean;
}

}  // namespace searchlight
