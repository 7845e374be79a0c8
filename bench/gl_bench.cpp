// The hierarchical sum and irradiance on OpenGL beside the CPU's: 200,000 points, 65,536 receivers.
//
//     gl_bench --benchmark_min_time=0.1
//
// Time is that of the process on all its cores: on llvmpipe both columns are then the same work on the same cores. With
// a GPU look at the wall clock instead.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "geometry/surface_points.h"
#include "gl/context.h"
#include "light/irradiance_gl.h"
#include "model/plane.h"
#include "render/hierarchical.h"
#include "scene/materials.h"

namespace searchlight {
namespace {

// Evenly spread over a sphere by the golden angle; the first half of `count` points has z > 0.
PointCloud sphere(std::size_t count, double radius_mm) {
    PointCloud cloud;
    for (std::size_t i = 0; i < count; ++i) {
        const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
        const double ring = std::sqrt(1 - z * z);
        const double angle = std::numbers::pi * (3 - std::sqrt(5.0)) * static_cast<double>(i);
        const Vec3 n{ring * std::cos(angle), ring * std::sin(angle), z};
        cloud.positions.push_back(toFloat(radius_mm * n));
        cloud.normals.push_back(toFloat(n));
        cloud.areas.push_back(
            static_cast<float>(4 * std::numbers::pi * radius_mm * radius_mm / static_cast<double>(count)));
    }
    return cloud;
}

gl::Context& context() {
    static gl::Context shared;
    return shared;
}

struct Case {
    Scene scene;
    Model model;
    Medium medium;
    std::unique_ptr<Evaluator> evaluator;
    Profile profile;
    PointCloud points = sphere(200'000, 10);
    Irradiance irradiance;
    VisibleSurface visible;

    Case(const char* model_id, const char* material)
        : model(loadModel(model_id)), medium(findMaterial(material).medium) {
        evaluator = makeNativeEvaluator(model);
        evaluator->set(medium, {});
        if (isRadial(model)) profile = tabulate(*evaluator, model, medium).profile;
        const PointCloud receivers = sphere(131'072, 10);
        visible.positions.assign(receivers.positions.begin(), receivers.positions.begin() + 65'536);
        visible.normals.assign(receivers.normals.begin(), receivers.normals.begin() + 65'536);
        visible.eye = {0, 0, 50};
        Beam beam{{{0.6f, 0, 0.8f}}, {}};
        for (const Vec3f& n : points.normals) {
            const float lit = std::max(0.0f, 0.6f * n.x + 0.8f * n.z);
            beam.flux.push_back({lit, lit, lit});
        }
        irradiance.transmitted = beam.flux;
        irradiance.beams = {std::move(beam)};
    }
};

// What a camera that moves costs: trees of the points, tables and the opening are kept.
void hierarchical(benchmark::State& state, const char* model, const char* material, double error, bool gl) {
    const Case problem(model, material);
    const auto technique = makeHierarchical(gl ? &context() : nullptr);
    Observer observer;
    RenderInput input;
    input.scene = &problem.scene;
    input.points = &problem.points;
    input.irradiance = &problem.irradiance;
    input.visible = &problem.visible;
    input.model = &problem.model;
    input.evaluator = problem.evaluator.get();
    input.medium = &problem.medium;
    input.profile = problem.profile.empty() ? nullptr : &problem.profile;
    const auto run = [&] {
        technique->start(input, {{"error", error}}, observer);
        while (!technique->step(observer)) {
        }
        ++input.versions.view;
    };
    run();
    for (auto _ : state) run();
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) *
                            static_cast<std::int64_t>(problem.visible.positions.size()));
    state.counters["error_bound"] = technique->report().error_bound;
}

void irradiance(benchmark::State& state, const Light& light, bool gl) {
    Observer observer;
    const Scene scene{.object = "statue", .lights = {light}};
    const Object object = placeObject(scene);
    const RayScene rays(object.mesh);
    const PointCloud cloud = samplePoints(object.mesh, {}, observer);
    const LitPoints points =
        prepareLitPoints({cloud.positions, cloud.normals}, object, &rays, LitNormals::shading, 0, observer);
    for (auto _ : state)
        benchmark::DoNotOptimize(gl ? computeIrradianceGl(context(), points, scene, object, true, {}, observer)
                                    : computeIrradiance(points, scene, object, &rays, {}, observer));
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(points.size()));
}

#define ON_BOTH(function, name, ...)                            \
    BENCHMARK_CAPTURE(function, name / cpu, __VA_ARGS__, false) \
        ->MeasureProcessCPUTime()                               \
        ->Unit(benchmark::kMillisecond);                        \
    BENCHMARK_CAPTURE(function, name / gl, __VA_ARGS__, true)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond)

ON_BOTH(hierarchical, dipole / skin1 / 0.01, "dipole", "skin1", 0.01);
ON_BOTH(hierarchical, dipole / skin1 / 0.005, "dipole", "skin1", 0.005);
ON_BOTH(hierarchical, dipole / marble / 0.005, "dipole", "marble", 0.005);
BENCHMARK_CAPTURE(hierarchical, directional_dipole / skin1 / 0.01 / gl, "directional_dipole", "skin1", 0.01, true)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
ON_BOTH(irradiance, directional, DirectionalLight{});
ON_BOTH(irradiance, point, PointLight{});

}  // namespace
}  // namespace searchlight

BENCHMARK_MAIN();
