// Points on a surface: time, and what they are worth as a quadrature.
//   build/release/bin/points_bench [MESH]      without a mesh: the built-in statue
// Counters, relative where a unit makes no sense:
//   radius        smallest distance of two points over that of the hexagonal lattice of the same density
//   area_std      standard deviation of the areas over their mean
//   area_error    of their sum
//   wave_rmse     of integrals of cos(k x), wavelength 8 spacings, over the area; independent points: 1/sqrt(2 n)
//   local_rmse    of integrals of a Gaussian of 2 spacings about places of the surface: what a picture sees as noise
//   local_equal   the same when every point has the same area
//   P0.2 ... P1.4 power spectrum on a square at so many cycles per spacing; independent points: 1
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <iostream>
#include <numbers>

#include "base/error.h"
#include "base/random.h"
#include "geometry/object.h"
#include "geometry/point_grid.h"
#include "geometry/point_start.h"
#include "geometry/surface_points.h"
#include "io/shape_file.h"

namespace searchlight {
namespace {

struct Quality {
    double radius = 0, area_std = 0, area_error = 0, wave_rmse = 0, local_rmse = 0, local_equal = 0;
};

// The same integrals by many more points, placed in equal strata.
constexpr std::size_t most_oversampling = 400, most_truth = 8'000'000;

double gaussianSum(const PointGrid& grid, Vec3f at, double sigma, const std::function<double(std::uint32_t)>& weight) {
    std::vector<PointGrid::Entry> near;
    const auto reach = static_cast<float>(6 * sigma);
    grid.gather({at.x - reach, at.y - reach, at.z - reach}, {at.x + reach, at.y + reach, at.z + reach}, near);
    double sum = 0;
    for (const PointGrid::Entry& entry : near) {
        const Vec3 way = toDouble(entry.position) - toDouble(at);
        sum += weight(entry.index) * std::exp(-dot(way, way) / (2 * sigma * sigma));
    }
    return sum;
}

Quality qualityOf(const Mesh& mesh, const PointCloud& cloud) {
    const auto n = static_cast<double>(cloud.positions.size());
    const double area = surfaceArea(mesh), part = area / n, spacing = std::sqrt(part);
    Quality quality;
    const PointGrid grid(cloud.positions, static_cast<float>(2 * spacing));
    double nearest = spacing * spacing * 4;
    std::vector<PointGrid::Cell> cells;
    std::vector<PointGrid::Entry> near;
    for (std::size_t b = 0; b < grid.blocks(); ++b) {
        grid.cellsOf(b, cells);
        for (const PointGrid::Cell& cell : cells) {
            near.clear();
            grid.gatherAround(cell, near);
            for (const PointGrid::Entry& own : cell.entries)
                for (const PointGrid::Entry& other : near) {
                    const Vec3 way = toDouble(own.position) - toDouble(other.position);
                    if (own.index != other.index) nearest = std::min(nearest, dot(way, way));
                }
        }
    }
    quality.radius = std::sqrt(nearest / (2 / std::sqrt(3.0) * part));
    double sum = 0, squares = 0;
    for (const float a : cloud.areas) sum += a, squares += (a - part) * (a - part);
    quality.area_std = std::sqrt(squares / n) / part;
    quality.area_error = sum / area - 1;

    const std::vector<SurfacePlace> truth =
        stratifiedPlaces(mesh, std::min(most_oversampling * cloud.positions.size(), most_truth), 99, 0);
    const SurfaceWalk walk(mesh);
    std::vector<Vec3f> dense(truth.size());
    for (std::size_t i = 0; i < dense.size(); ++i) dense[i] = toFloat(walk.position(truth[i]));
    const double dense_part = area / static_cast<double>(dense.size());
    SplitMix64 random = streamOf(7, 0);
    constexpr int waves = 12;
    for (int w = 0; w < waves; ++w) {
        const double z = 2 * random.uniform() - 1, turn = 2 * std::numbers::pi * random.uniform(),
                     s = std::sqrt(1 - z * z);
        const Vec3 k = (2 * std::numbers::pi / (8 * spacing)) * Vec3{s * std::cos(turn), s * std::sin(turn), z};
        double exact = 0, got = 0;
        for (const Vec3f p : dense) exact += dense_part * std::cos(dot(k, toDouble(p)));
        for (std::size_t i = 0; i < cloud.positions.size(); ++i)
            got += cloud.areas[i] * std::cos(dot(k, toDouble(cloud.positions[i])));
        quality.wave_rmse += (got - exact) * (got - exact) / (area * area) / waves;
    }
    quality.wave_rmse = std::sqrt(quality.wave_rmse);

    const double sigma = 2 * spacing;
    const PointGrid dense_grid(dense, static_cast<float>(2 * spacing));
    constexpr int places = 300;
    for (int i = 0; i < places; ++i) {
        const Vec3f at = dense[static_cast<std::size_t>(random.uniform() * static_cast<double>(dense.size()))];
        const double exact = gaussianSum(dense_grid, at, sigma, [&](std::uint32_t) { return dense_part; });
        const double got = gaussianSum(grid, at, sigma, [&](std::uint32_t p) { return cloud.areas[p]; });
        const double equal = gaussianSum(grid, at, sigma, [&](std::uint32_t) { return part; });
        quality.local_rmse += (got / exact - 1) * (got / exact - 1) / places;
        quality.local_equal += (equal / exact - 1) * (equal / exact - 1) / places;
    }
    quality.local_rmse = std::sqrt(quality.local_rmse);
    quality.local_equal = std::sqrt(quality.local_equal);
    return quality;
}

void sampleMesh(benchmark::State& state, const Mesh& mesh, PointMethod method) {
    Observer observer;
    const PointOptions options{.count = static_cast<std::size_t>(state.range(0)), .method = method};
    PointCloud cloud;
    for (auto _ : state) cloud = samplePoints(mesh, options, observer);
    const Quality quality = qualityOf(mesh, cloud);
    state.counters["radius"] = quality.radius;
    state.counters["area_std"] = quality.area_std;
    state.counters["area_error"] = quality.area_error;
    state.counters["wave_rmse"] = quality.wave_rmse;
    state.counters["local_rmse"] = quality.local_rmse;
    state.counters["local_equal"] = quality.local_equal;
}

// Mean power at wave numbers about `f` (in cycles per spacing) of points on the unit square, seen through a window that
// fades out before its edge; independent points have 1.
double power(const PointCloud& cloud, double f) {
    const double n = static_cast<double>(cloud.positions.size()), spacing = 1 / std::sqrt(n);
    constexpr int directions = 64;
    double sum = 0;
    for (int d = 0; d < directions; ++d) {
        const double turn = std::numbers::pi * (d + 0.5) / directions, k = 2 * std::numbers::pi * f / spacing;
        std::complex<double> wave;
        double squares = 0;
        for (const Vec3f p : cloud.positions) {
            const auto window = [](double x) { return std::pow(std::sin(std::numbers::pi * x), 2); };
            const double weight = window(p.x) * window(p.y);
            wave += std::polar(weight, k * (std::cos(turn) * p.x + std::sin(turn) * p.y));
            squares += weight * weight;
        }
        sum += std::norm(wave) / squares / directions;
    }
    return sum;
}

void spectrum(benchmark::State& state, PointMethod method) {
    Mesh square;
    square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    square.triangles = {{0, 1, 2}, {0, 2, 3}};
    Observer observer;
    PointCloud cloud;
    for (auto _ : state) cloud = samplePoints(square, {.count = 20'000, .method = method}, observer);
    // The first ring of the hexagonal lattice lies at 1.07 cycles per spacing.
    for (const auto& [name, f] : {std::pair{"P0.2", 0.2}, std::pair{"P0.4", 0.4}, std::pair{"P0.6", 0.6},
                                  std::pair{"P0.8", 0.8}, std::pair{"P1.1", 1.1}, std::pair{"P1.4", 1.4}})
        state.counters[name] = power(cloud, f);
}

}  // namespace
}  // namespace searchlight

int main(int argc, char** argv) {
    using namespace searchlight;
    benchmark::Initialize(&argc, argv);
    Mesh mesh;
    try {
        mesh = argc > 1 ? readMesh(argv[1]) : builtInObject("statue");
    } catch (const Error& error) {
        std::cerr << error.what() << "\n";
        return 3;
    }
    for (const auto& [name, method] : {std::pair{"fast", PointMethod::fast}, std::pair{"turk", PointMethod::turk}}) {
        benchmark::RegisterBenchmark(fmt::format("mesh/{}", name).c_str(),
                                     [&mesh, m = method](benchmark::State& state) { sampleMesh(state, mesh, m); })
            ->Arg(20'000)
            ->Arg(200'000)
            ->Iterations(1)
            ->UseRealTime()
            ->MeasureProcessCPUTime()
            ->Unit(benchmark::kMillisecond);
        benchmark::RegisterBenchmark(fmt::format("square/{}", name).c_str(),
                                     [m = method](benchmark::State& state) { spectrum(state, m); })
            ->Iterations(1)
            ->Unit(benchmark::kMillisecond);
    }
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
