#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "geometry/point_cache.h"
#include "model/plane.h"
#include "model/sum_model.h"
#include "render/background.h"
#include "render/coat.h"
#include "render/shade.h"
#include "render/stages_gl.h"
#include "render/visible_raster.h"

namespace searchlight {

namespace {

double milliseconds(std::chrono::steady_clock::time_point since) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - since).count();
}

double meshArea(const Mesh& mesh) {
    double area = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 origin = toDouble(mesh.positions[a]);
        area += 0.5 * length(cross(toDouble(mesh.positions[b]) - origin, toDouble(mesh.positions[c]) - origin));
    }
    return area;
}

// A scene with these parts alone, as text: equal texts make equal stages.
template <class... Members>
std::string keyOf(const Scene& scene, Members... members) {
    Scene part;
    ((part.*members = scene.*members), ...);
    return sceneJson(part);
}

constexpr std::size_t most_default_points = 800'000;

// A transport mean free path of the densest channel apart.
double wantedPointCount(double area_mm2, const Medium& medium) {
    double densest = 0;
    for (int c = 0; c < Rgb::channels; ++c) densest = std::max(densest, medium.sigmaTp()[c]);
    return area_mm2 * densest * densest;
}

}  // namespace

std::string_view stageName(Stage stage) {
    constexpr std::string_view names[stage_count] = {"object",     "rays",     "material",   "points", "visible",
                                                     "irradiance", "exitance", "background", "coat",   "shade"};
    return names[static_cast<std::size_t>(stage)];
}

std::size_t defaultPointCount(double area_mm2, const Medium& medium) {
    std::size_t count = 100'000;
    while (count < most_default_points && static_cast<double>(count) < wantedPointCount(area_mm2, medium)) count *= 2;
    return count;
}

std::optional<std::string> noteOfFewPoints(double area_mm2, const Medium& medium) {
    const double wanted = wantedPointCount(area_mm2, medium);
    if (wanted <= most_default_points) return std::nullopt;
    return fmt::format(
        "There are {} points, the most that are chosen without asking: as close together as light travels there would "
        "be {:.2g} million.",
        most_default_points, 1e-6 * wanted);
}

struct Renderer::Impl {
    MaterialSource materials;
    gl::Context* context = nullptr;
    std::optional<StagesGl> stages_gl;  // made when needed
    Scene scene;
    RenderSettings settings;
    RenderReport report;
    std::array<std::string, stage_count> keys;

    Object object;
    double area_mm2 = 0;
    std::optional<RayScene> rays;
    RenderMaterial material;
    std::optional<Profile> profile;
    PointCloud sampled;  // of a mesh; a cloud is its own points
    LitPoints lit;       // the points as shadow rays see them, for every light
    std::string lit_from, spacing_from;
    std::uint64_t lit_version = 0;  // of the points that lit_from names
    Irradiance irradiance;
    View view;
    VisibleRaster raster;
    VisibleSurface visible;
    const TechniqueEntry* entry = nullptr;
    bool on_gl = false;
    std::unique_ptr<Technique> technique;
    bool final = false;
    std::uint64_t slices = 0;  // of the exitance: each makes a new picture
    Image background, picture;
    std::vector<Rgbf> radiance;
    std::vector<Rgbf> coat;  // radiance per sample; empty without a coat

    StageReport& stage(Stage which) { return report.stages[static_cast<std::size_t>(which)]; }
    std::uint64_t runs(Stage which) { return stage(which).runs; }

    StagesGl& onGl() {
        if (!stages_gl) stages_gl.emplace(*context);
        return *stages_gl;
    }

    /// Runs `body` unless the stage was made from the same key. `gl`: where it runs.
    template <class Body>
    void refresh(Stage which, const std::string& key, const Body& body, bool gl = false) {
        std::string& made_from = keys[static_cast<std::size_t>(which)];
        if (made_from == key) return;
        made_from.clear();
        const auto begin = std::chrono::steady_clock::now();
        body();
        stage(which).ms += milliseconds(begin);
        ++stage(which).runs;
        stage(which).gl = gl;
        made_from = key;
    }

    const TechniqueEntry& wanted() const { return findTechnique(settings.technique); }

    const PointCloud& points() const { return object.isMesh() ? sampled : object.cloud; }

    void refreshObject() {
        refresh(Stage::object, keyOf(scene, &Scene::object, &Scene::scale), [&] {
            object = placeObject(scene);
            area_mm2 = meshArea(object.mesh);
        });
        refresh(Stage::rays, fmt::format("{}", runs(Stage::object)), [&] { rays.emplace(object.mesh); });
    }

    bool underNormalBeam() const {
        const auto given = settings.technique_options.find(normal_beam_option);
        return given != settings.technique_options.end() && std::get<bool>(given->second);
    }

    void refreshMaterial() {
        const std::string key = fmt::format("{} {}", keyOf(scene, &Scene::material, &Scene::model), underNormalBeam());
        refresh(Stage::material, key, [&] {
            material = materials(scene);
            profile.reset();
            if (isRadial(material.model) || underNormalBeam())
                profile = tabulate(*material.evaluator, material.model, material.medium).profile;
        });
    }

    void refreshPoints(Observer& observer) {
        if (!object.isMesh() || wanted().light_at != LightPlace::points) return;
        PointOptions options{.count = settings.points, .seed = settings.seed, .threads = settings.threads};
        if (options.count == 0) options.count = defaultPointCount(area_mm2, material.medium);
        refresh(Stage::points, fmt::format("{} {} {}", runs(Stage::rays), options.count, options.seed), [&] {
            sampled =
                settings.points_cache
                    ? cachedPoints(object.mesh, object.content_hash, options, *settings.points_cache, observer).cloud
                    : samplePoints(object.mesh, options, observer);
        });
    }

    IrradianceOptions lightOptions() const {
        return {.eta = material.medium.eta,
                .beams = !profile && !material.model.file.no_wi,
                .light_samples = settings.light_samples,
                .seed = settings.seed,
                .threads = settings.threads};
    }

    std::string lightPlaces() {
        switch (wanted().light_at) {
            case LightPlace::points: return fmt::format("points {}", runs(Stage::points));
            case LightPlace::visible: return fmt::format("seen {}", runs(Stage::visible));
            case LightPlace::own: break;
        }
        return "own";
    }

    void refreshIrradiance(Observer& observer) {
        const IrradianceOptions options = lightOptions();
        const LightPlace light_at = wanted().light_at;
        const std::string places = lightPlaces();
        const std::string key =
            fmt::format("{} {} {} {} {} {} {} {}", settings.gl, runs(Stage::rays), places, options.eta, options.beams,
                        options.light_samples, options.seed, keyOf(scene, &Scene::lights));
        const auto compute = [&] {
            if (light_at == LightPlace::own) {
                irradiance = {};
                return;
            }
            const SurfacePoints at = light_at == LightPlace::visible
                                         ? SurfacePoints{visible.positions, visible.normals}
                                         : SurfacePoints{points().positions, points().normals};
            const std::string of = fmt::format("{} {} {}", settings.gl, runs(Stage::rays), places);
            if (lit_from != of) {
                lit_from.clear();
                ++lit_version;
                if (!settings.gl)
                    lit = prepareLitPoints(at, object, &*rays, options.normals, options.threads, observer);
                lit_from = of;
            }
            irradiance = settings.gl ? onGl().irradiance(at, lit_version, scene, object, *rays, options, observer)
                                     : computeIrradiance(lit, scene, object, &*rays, options, observer);
        };
        refresh(Stage::irradiance, key, compute, settings.gl && light_at != LightPlace::own);
    }

    void refreshVisible(Observer& observer) {
        const int width = std::max(1, static_cast<int>(std::lround(settings.width * settings.preview)));
        const int height = std::max(1, static_cast<int>(std::lround(settings.height * settings.preview)));
        const std::string key = fmt::format("{} {} {} {} {} {}", settings.gl, runs(Stage::rays), width, height,
                                            settings.edge_samples, keyOf(scene, &Scene::camera));
        const auto compute = [&] {
            report.camera = framedCamera(scene.camera, object, width, height);
            view = makeView(report.camera, object, width, height);
            const TraceOptions options{.edge_samples = settings.edge_samples, .threads = settings.threads};
            // Drawing takes as long as there are triangles, rays as long as there are pixels.
            const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
            if (settings.gl)
                visible = onGl().visible(view, object, runs(Stage::object), options, observer);
            else if (object.mesh.triangles.size() <= pixels)
                raster.find(view, object, options, observer, visible);
            else
                visible = traceVisible(view, object, *rays, options, observer);
        };
        refresh(Stage::visible, key, compute, settings.gl);
    }

    void startExitance(Observer& observer) {
        const TechniqueEntry& wanted = findTechnique(settings.technique);
        if (!profile && !wanted.directional)
            throw usageError(fmt::format("{} takes radial models, and {} is none", wanted.id, material.model.id),
                             "--technique brute_force takes any model");
        ParamValues options;
        std::string key = fmt::format("{} {} {} {} {} {}", wanted.id, settings.gl, runs(Stage::points),
                                      runs(Stage::irradiance), runs(Stage::visible), runs(Stage::material));
        for (const Param& param : wanted.options) {
            options[param.name] = valueOf(param, settings.technique_options);
            checkValue(param, options[param.name]);
            key += fmt::format(" {}", valueText(options[param.name]));
        }
        const auto begin = [&] {
            if (entry != &wanted || on_gl != settings.gl) technique = wanted.make(settings.gl ? context : nullptr);
            entry = &wanted;
            on_gl = settings.gl;
            final = false;
            const RenderInput input{.scene = &scene,
                                    .object = &object,
                                    .rays = &*rays,
                                    .points = wanted.light_at == LightPlace::points ? &points() : nullptr,
                                    .irradiance = wanted.light_at == LightPlace::own ? nullptr : &irradiance,
                                    .visible = &visible,
                                    .view = &view,
                                    .model = &material.model,
                                    .evaluator = material.evaluator.get(),
                                    .medium = &material.medium,
                                    .profile = profile ? &*profile : nullptr,
                                    .light = lightOptions(),
                                    .points_cache = settings.points_cache ? &*settings.points_cache : nullptr,
                                    .threads = settings.threads,
                                    .versions = {.points = runs(Stage::points) + runs(Stage::object),
                                                 .light = runs(Stage::irradiance),
                                                 .view = runs(Stage::visible),
                                                 .material = runs(Stage::material)}};
            technique->start(input, options, observer);
        };
        refresh(Stage::exitance, key, begin, settings.gl && wanted.gl);
    }

    void start(Observer& observer) {
        if (settings.gl && !context)
            throw deviceError("OpenGL is asked for, and this renderer was made without a context");
        for (StageReport& each : report.stages) each.ms = 0;
        refreshObject();
        refreshMaterial();
        refreshPoints(observer);
        refreshVisible(observer);
        refreshIrradiance(observer);
        startExitance(observer);
        refreshBackground(observer);
        refreshCoat(observer);
        describe();
    }

    bool step(Observer& observer) {
        if (final) return true;
        if (observer.cancelled()) throw interruptedError();
        const auto begin = std::chrono::steady_clock::now();
        final = technique->step(observer);
        ++slices;
        stage(Stage::exitance).ms += milliseconds(begin);
        report.technique = technique->report();
        return final;
    }

    void refreshBackground(Observer& observer) {
        const std::string key = fmt::format("{} {} {}", runs(Stage::visible), settings.seed,
                                            keyOf(scene, &Scene::lights, &Scene::ground, &Scene::backdrop));
        refresh(Stage::background, key, [&] {
            background = paintBackground(view, scene, object, &*rays, visible,
                                         {.seed = settings.seed, .threads = settings.threads}, observer);
        });
    }

    void refreshCoat(Observer& observer) {
        std::string key = "none";
        if (scene.coat)
            key = fmt::format("{} {} {} {}", runs(Stage::visible), settings.seed, material.medium.eta,
                              keyOf(scene, &Scene::lights, &Scene::coat));
        const auto compute = [&] {
            coat.clear();
            if (!scene.coat) return;
            std::vector<Vec3f> wo;
            for (const Vec3f& position : visible.positions)
                wo.push_back(toFloat(normalize(visible.eye - toDouble(position))));
            coat = coatRadiance(
                {visible.positions, visible.normals, visible.geometric_normals, wo}, scene, object, &*rays,
                {.eta = material.medium.eta, .seed = settings.seed, .threads = settings.threads, .context = context},
                observer);
        };
        // Lights are gathered by rays in any case; a .brdf file is evaluated on OpenGL.
        refresh(Stage::coat, key, compute, scene.coat && !scene.coat->brdf.empty());
    }

    const Image& image() {
        refresh(Stage::shade,
                fmt::format("{} {} {} {}", runs(Stage::exitance), slices, runs(Stage::background), runs(Stage::coat)),
                [&] {
                    exitRadiance(visible, technique->exitance(), material.medium.eta, settings.threads, radiance);
                    report.exposure = displayExposure(visible, radiance, settings.threads);
                    composite(visible, radiance, coat, background, settings.threads, picture);
                });
        return picture;
    }

    Image standardError() const {
        if (technique->standardError().empty()) return {};
        std::vector<Rgbf> errors;
        Image errors_picture;
        exitRadiance(visible, technique->standardError(), material.medium.eta, settings.threads, errors);
        composite(visible, errors, {}, {}, settings.threads, errors_picture);
        return errors_picture;
    }

    void describe() {
        const bool has_points = wanted().light_at == LightPlace::points;
        report.points = !has_points ? 0 : points().positions.size();
        report.receivers = visible.positions.size();
        if (const std::string of = fmt::format("{} {}", runs(Stage::points), runs(Stage::object)); !has_points) {
            report.point_spacing_mm = 0;
            spacing_from.clear();
        } else if (spacing_from != of) {
            const double area = std::accumulate(points().areas.begin(), points().areas.end(), 0.0);
            report.point_spacing_mm = std::sqrt(area / static_cast<double>(report.points));
            spacing_from = of;
        }
        report.notes = object.notes;
        for (std::string& note : technique->report().notes) report.notes.push_back(std::move(note));
        if (profile && !isRadial(material.model))
            report.notes.emplace_back("At every angle the model stands with its profile under a normal beam.");
        if (std::string twice = countedTwice(material.model); !twice.empty()) report.notes.push_back(std::move(twice));
        const Medium& medium = material.medium;
        if (object.isMesh() && settings.points == 0 && has_points)
            if (const auto note = noteOfFewPoints(area_mm2, medium)) report.notes.push_back(*note);
        for (int c = 0; c < medium.channels; ++c) {
            if (!medium.scatters(c))
                report.notes.push_back(fmt::format("Channel {} does not scatter: it is black.", "RGB"[c]));
            else if (report.point_spacing_mm > 1 / medium.sigmaTp()[c])
                report.notes.push_back(fmt::format(
                    "Points stand {:.3g} mm apart, further than light of channel {} travels ({:.3g} mm): details of "
                    "the lighting are blurred by their spacing.",
                    report.point_spacing_mm, "RGB"[c], 1 / medium.sigmaTp()[c]));
        }
    }
};

Renderer::Renderer(MaterialSource materials, gl::Context* context) : impl_(std::make_unique<Impl>()) {
    impl_->materials = std::move(materials);
    impl_->context = context;
}
Renderer::~Renderer() = default;

void Renderer::setScene(Scene scene) { impl_->scene = std::move(scene); }
void Renderer::setSettings(RenderSettings settings) { impl_->settings = std::move(settings); }

const Image& Renderer::render(Observer& observer) {
    start(observer);
    while (!step(observer)) {
    }
    return image(observer);
}

void Renderer::start(Observer& observer) { impl_->start(observer); }
bool Renderer::step(Observer& observer) { return impl_->step(observer); }
const Image& Renderer::image(Observer&) { return impl_->image(); }
Image Renderer::standardError() const { return impl_->standardError(); }
const RenderReport& Renderer::report() const { return impl_->report; }

RenderStages Renderer::stages() const {
    return {&impl_->object, &impl_->points(), &impl_->irradiance, &impl_->visible};
}

void Renderer::forgetMaterial() { impl_->keys[static_cast<std::size_t>(Stage::material)].clear(); }

}  // namespace searchlight
