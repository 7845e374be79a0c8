// Speed of the walk inside a closed mesh on one core: collisions per CPU second with a ray for each flight,
// with the grid for each, with safe regions, and with large steps too, beside Embree's rate on the rays of the first.
// The mesh is the first argument's PLY or OBJ file, or the built-in statue without one; the second argument is its
// length, 50 mm without one:
//   build/release/bin/mesh_bench MESH [LENGTH]
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <memory>
#include <string>

#include "base/random.h"
#include "geometry/object.h"
#include "transport/mesh/reference_body.h"

namespace searchlight {
namespace {

std::string mesh_path = "statue";
double mesh_mm = 50;

const Mesh& mesh() {
    static const Object object = [] {
        Scene scene;
        scene.object = mesh_path;
        scene.scale = mesh_mm;
        return placeObject(scene);
    }();
    return object.mesh;
}

double cpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

enum class Tests { embree, grid, regions };

const MeshBody& body(Tests tests, double mfp) {
    static std::unique_ptr<MeshBody> kept;
    static Tests kept_tests = Tests::embree;
    static double kept_mfp = 0;
    if (!kept || kept_tests != tests || kept_mfp != mfp)
        kept = std::make_unique<MeshBody>(mesh(), MeshBodyOptions{.cell_area_mm2 = 1,
                                                                  .shortest_mfp = mfp,
                                                                  .regions = tests == Tests::regions,
                                                                  .grid_alone = tests == Tests::grid,
                                                                  .threads = 1});
    kept_tests = tests, kept_mfp = mfp;
    return *kept;
}

void walk(benchmark::State& state, const Medium& medium, double shortest_mfp, Tests tests, bool large_steps,
          double walks) {
    const MeshBody& in = body(tests, shortest_mfp);
    BodyOptions options{.walks = static_cast<std::uint64_t>(walks), .threads = 1, .large_steps = large_steps};
    Observer observer;
    double collisions = 0, flights = 0, rays = 0, entries = 0;
    const double begin = cpuSeconds();
    for (auto _ : state) {
        ++options.seed;
        const BodyResult result = walkBody(in, medium, 0, UniformLight{}, options, observer);
        collisions += static_cast<double>(result.collisions);
        flights += static_cast<double>(result.flights);
        rays += static_cast<double>(result.rays);
        entries += static_cast<double>(result.entries);
    }
    const double seconds = cpuSeconds() - begin;
    state.counters["collisions/s"] = collisions / seconds;
    state.counters["walks/s"] = entries / seconds;
    state.counters["rays/s"] = rays / seconds;
    state.counters["rays/flight"] = rays / flights;
    state.counters["build_s"] = in.build_seconds();
}

// Flights as 64 walks that do not absorb make them, in the order in which they ask: what Embree alone takes for them.
std::vector<Ray> flightsOf(const MeshBody& in, double mfp) {
    constexpr std::size_t lanes = 64;
    SplitMix64 random(1);
    std::vector<Ray> rays, flights(lanes);
    std::vector<RayHit> hits(lanes);
    double place = 0;
    const auto direction = [&] {
        const double w = 2 * random.uniform() - 1, ring = std::sqrt(1 - w * w), turn = 6.283185307 * random.uniform();
        return Vec3{ring * std::cos(turn), ring * std::sin(turn), w};
    };
    const auto fly = [&](Vec3f from, Vec3 to) {
        return Ray{from, toFloat((-mfp * std::log(random.uniform())) * to), 0, 1};
    };
    const auto start = [&] {
        place += 1e-4 - std::floor(place + 1e-4);
        const SurfacePoint point = in.pointAt(place, random.uniform(), random.uniform());
        Vec3 in_ward = direction();
        if (dot(in_ward, point.normal) > 0) in_ward = -1.0 * in_ward;
        return fly(in.below(point), in_ward);
    };
    for (Ray& flight : flights) flight = start();
    while (rays.size() < std::size_t{1} << 19) {
        rays.insert(rays.end(), flights.begin(), flights.end());
        in.rays().intersect(flights, hits, false);
        for (std::size_t i = 0; i < lanes; ++i) {
            const Vec3f from = flights[i].origin, along = flights[i].direction;
            flights[i] = std::isfinite(hits[i].t)
                             ? start()
                             : fly({from.x + along.x, from.y + along.y, from.z + along.z}, direction());
        }
    }
    return rays;
}

enum class Asked { one_at_a_time, packets, side_by_side };

void shortRays(benchmark::State& state, double mfp, Asked asked) {
    const MeshBody& in = body(Tests::embree, mfp);
    const std::vector<Ray> rays = flightsOf(in, mfp);
    std::vector<RayHit> hits(rays.size());
    // As walks ask: lists of 256, which the cache holds.
    std::vector<Flights> lists;
    std::vector<ListedHit> listed(Flights::kMost);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (i % Flights::kMost == 0) lists.emplace_back();
        Flights& to = lists.back();
        const auto [origin, direction, t_min, t_max] = rays[i];
        to.x[to.count] = origin.x, to.y[to.count] = origin.y, to.z[to.count] = origin.z;
        to.dx[to.count] = direction.x, to.dy[to.count] = direction.y, to.dz[to.count++] = direction.z;
    }
    double traced = 0;
    const double begin = cpuSeconds();
    for (auto _ : state) {
        if (asked == Asked::packets)
            in.rays().intersect(rays, hits, false);
        else if (asked == Asked::side_by_side)
            for (const Flights& f : lists)
                in.rays().intersect({f.x, f.y, f.z, f.dx, f.dy, f.dz, f.begin, f.count, 1}, listed);
        else
            for (const Ray& ray : rays) benchmark::DoNotOptimize(in.rays().intersect(ray));
        traced += static_cast<double>(rays.size());
    }
    state.counters["rays/s"] = traced / (cpuSeconds() - begin);
}

// Marble of [Jensen2001], red and blue: mean free paths of 0.46 and 0.33 mm.
const Medium marble_red = makeMedium({0.0021}, {2.19}, {0}, 1.5);
const Medium marble_blue = makeMedium({0.0071}, {3.00}, {0}, 1.5);
const Medium skin1_red = makeMedium({0.032}, {0.74}, {0}, 1.3);
const Medium milk_green = makeMedium({0.0024}, {3.21}, {0}, 1.3);
const Medium forward = makeMedium({0.0021}, {21.9}, {0.9}, 1.5);

BENCHMARK_CAPTURE(shortRays, one_at_a_time, 0.456, Asked::one_at_a_time)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(shortRays, packets, 0.456, Asked::packets)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(shortRays, side_by_side, 0.456, Asked::side_by_side)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(walk, marble_red_ray_each, marble_red, 0.33, Tests::embree, false, 1e6)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(walk, marble_red_grid_each, marble_red, 0.33, Tests::grid, false, 1e6)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(walk, marble_red_regions, marble_red, 0.33, Tests::regions, false, 2e6)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(walk, marble_red_large_steps, marble_red, 0.33, Tests::regions, true, 2e6)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(walk, marble_blue_large_steps, marble_blue, 0.33, Tests::regions, true, 1e6)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(walk, milk_green_regions, milk_green, 0.31, Tests::regions, false, 1e6)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(walk, milk_green_large_steps, milk_green, 0.31, Tests::regions, true, 1e6)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(walk, skin1_red_large_steps, skin1_red, 0.41, Tests::regions, true, 1e6)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(walk, forward_g_09_regions, forward, 0.046, Tests::regions, false, 1e5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(walk, forward_g_09_large_steps, forward, 0.046, Tests::regions, true, 1e5)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace searchlight

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (argc > 1) searchlight::mesh_path = argv[1];
    if (argc > 2) searchlight::mesh_mm = std::stod(argv[2]);
    benchmark::RunSpecifiedBenchmarks();
}
