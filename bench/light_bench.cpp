// Light on surface points, beside the rate of the rays that it is made of.
//   build/release/bin/light_bench [MESH]      without a mesh: the built-in statue
// `rays/...` trace the shadow rays of one direction, from the points that face it, and nothing else; the counter `rate`
// is in rays per second of CPU time. `directional` and `occluded` do so too, by the rays that they trace: what their
// rate lacks to that of `rays/parallel` is what light costs beside the rays.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iostream>
#include <random>

#include "base/error.h"
#include "base/parallel.h"
#include "geometry/object.h"
#include "geometry/rays.h"
#include "geometry/surface_points.h"
#include "io/image_file.h"
#include "light/environment.h"
#include "light/environment_irradiance.h"
#include "light/irradiance.h"

namespace searchlight {
namespace {

constexpr std::size_t block = 1024;

struct Place {
    Object object;
    RayScene rays;
    PointCloud points;
    LitPoints lit;
};

Place makePlace(const std::string& path) {
    Scene scene;
    scene.object = path;
    Observer observer;
    Object object = placeObject(scene);
    RayScene rays(object.mesh);
    PointCloud points = samplePoints(object.mesh, {.count = 200'000}, observer);
    LitPoints lit =
        prepareLitPoints({points.positions, points.normals}, object, &rays, LitNormals::shading, 0, observer);
    return {std::move(object), std::move(rays), std::move(points), std::move(lit)};
}

const Vec3 sun = normalize({1, 1, 1});

// Origins of the points that face the sun, along the curve.
std::vector<Vec3f> facing(const Place& place) {
    std::vector<Vec3f> origins;
    for (std::size_t i = 0; i < place.lit.size(); ++i)
        if (dot(toDouble(place.lit.normals[i]), sun) > 0) origins.push_back(place.lit.origins[i]);
    return origins;
}

double facingShare(const Place& place) {
    return static_cast<double>(facing(place).size()) / static_cast<double>(place.lit.size());
}

using Trace = std::function<void(const RayScene&, std::span<const Ray>, std::span<std::uint8_t>)>;

void traceRays(benchmark::State& state, const Place& place, const std::vector<Ray>& rays, const Trace& trace) {
    std::vector<std::uint8_t> blocked(rays.size());
    for (auto _ : state)
        parallelFor((rays.size() + block - 1) / block, 0, [&](std::size_t b) {
            const std::size_t first = b * block, count = std::min(block, rays.size() - first);
            trace(place.rays, std::span(rays).subspan(first, count), std::span(blocked).subspan(first, count));
        });
    state.counters["rate"] =
        benchmark::Counter(static_cast<double>(rays.size()), benchmark::Counter::kIsIterationInvariantRate);
}

std::vector<Ray> towardsSun(const Place& place) {
    std::vector<Ray> rays;
    for (const Vec3f& origin : facing(place)) rays.push_back({origin, toFloat(sun)});
    return rays;
}

std::vector<Ray> anywhere(const Place& place) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < place.lit.size(); ++i) {
        Vec3 direction = normalize({normal(random), normal(random), normal(random)});
        if (dot(direction, toDouble(place.lit.normals[i])) < 0) direction = -1.0 * direction;
        rays.push_back({place.lit.origins[i], toFloat(direction)});
    }
    return rays;
}

void traceParallel(benchmark::State& state, const Place& place) {
    const std::vector<Vec3f> origins = facing(place);
    std::vector<std::uint8_t> blocked(origins.size());
    for (auto _ : state)
        parallelFor((origins.size() + block - 1) / block, 0, [&](std::size_t b) {
            const std::size_t first = b * block, count = std::min(block, origins.size() - first);
            place.rays.occluded(std::span(origins).subspan(first, count), toFloat(sun),
                                std::span(blocked).subspan(first, count));
        });
    state.counters["rate"] =
        benchmark::Counter(static_cast<double>(origins.size()), benchmark::Counter::kIsIterationInvariantRate);
}

void prepare(benchmark::State& state, const Place& place) {
    Observer observer;
    for (auto _ : state)
        benchmark::DoNotOptimize(prepareLitPoints({place.points.positions, place.points.normals}, place.object,
                                                  &place.rays, LitNormals::shading, 0, observer));
}

void directional(benchmark::State& state, const Place& place, double angle_deg) {
    Scene scene;
    scene.lights = {DirectionalLight{.direction = sun, .angle_deg = angle_deg}};
    Observer observer;
    for (auto _ : state)
        benchmark::DoNotOptimize(computeIrradiance(place.lit, scene, place.object, &place.rays, {}, observer));
    if (angle_deg == 0)
        state.counters["rate"] = benchmark::Counter(facingShare(place) * static_cast<double>(place.lit.size()),
                                                    benchmark::Counter::kIsIterationInvariantRate);
}

// A sky with a sun, written where the operating system puts what is temporary.
EnvironmentLight sky() {
    ImageFile file;
    file.image = Image(1024, 512, {0.1f, 0.1f, 0.1f, 1});
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 1024; ++x) file.image.at(x, y) = {0.5f, 0.7f, 1, 1};
    for (int y = 100; y < 104; ++y)
        for (int x = 300; x < 304; ++x) file.image.at(x, y) = {6000, 5000, 4000, 1};
    const std::string path = (std::filesystem::temp_directory_path() / "light_bench_sky.pfm").string();
    writeImage(path, file);
    return {.path = path, .occlusion = true};
}

void occluded(benchmark::State& state, const Place& place) {
    Scene scene;
    scene.lights = {sky()};
    Observer observer;
    ProgressiveIrradiance irradiance(place.lit, scene, place.object, &place.rays, {}, observer);
    const int samples = static_cast<int>(state.range(0));
    for (auto _ : state) irradiance.step(samples, observer);
    // Over all directions half of the points face a sample, on average over a closed surface.
    state.counters["rate"] = benchmark::Counter(0.5 * samples * static_cast<double>(place.lit.size()),
                                                benchmark::Counter::kIsIterationInvariantRate);
}

void harmonics(benchmark::State& state) {
    const Environment environment(sky());
    for (auto _ : state) benchmark::DoNotOptimize(EnvironmentIrradiance(environment, 1.3));
}

void unoccluded(benchmark::State& state, const Place& place) {
    const EnvironmentIrradiance by_normal(Environment(sky()), 1.3);
    for (auto _ : state)
        for (const Vec3f& normal : place.points.normals) benchmark::DoNotOptimize(by_normal(normal));
}

void add(const char* name, const std::function<void(benchmark::State&)>& run, int argument = 0) {
    auto* entry = benchmark::RegisterBenchmark(name, run)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
    if (argument > 0) entry->Arg(argument);
}

}  // namespace
}  // namespace searchlight

int main(int argc, char** argv) {
    using namespace searchlight;
    benchmark::Initialize(&argc, argv);
    try {
        const Place place = makePlace(argc > 1 ? argv[1] : "statue");
        const Trace one_by_one = [](const RayScene& scene, std::span<const Ray> rays, std::span<std::uint8_t> blocked) {
            for (std::size_t i = 0; i < rays.size(); ++i) blocked[i] = scene.occluded(rays[i]);
        };
        const Trace coherent = [](const RayScene& scene, std::span<const Ray> rays, std::span<std::uint8_t> blocked) {
            scene.occluded(rays, blocked, true);
        };
        const Trace incoherent = [](const RayScene& scene, std::span<const Ray> rays, std::span<std::uint8_t> blocked) {
            scene.occluded(rays, blocked, false);
        };
        const std::vector<Ray> to_sun = towardsSun(place), random = anywhere(place);
        using State = benchmark::State;
        add("rays/parallel", [&](State& state) { traceParallel(state, place); });
        add("rays/stream", [&](State& state) { traceRays(state, place, to_sun, coherent); });
        add("rays/one_by_one", [&](State& state) { traceRays(state, place, to_sun, one_by_one); });
        add("rays/random_stream", [&](State& state) { traceRays(state, place, random, incoherent); });
        add("rays/random_one_by_one", [&](State& state) { traceRays(state, place, random, one_by_one); });
        add("prepare", [&](State& state) { prepare(state, place); });
        add("directional", [&](State& state) { directional(state, place, 0); });
        add("directional/sun", [&](State& state) { directional(state, place, 0.53); });
        add(
            "occluded", [&](State& state) { occluded(state, place); }, 256);
        add("harmonics", [&](State& state) { harmonics(state); });
        add("unoccluded", [&](State& state) { unoccluded(state, place); });
        benchmark::RunSpecifiedBenchmarks();
    } catch (const Error& error) {
        std::cerr << error.what() << "\n";
        return 3;
    }
    return 0;
}
