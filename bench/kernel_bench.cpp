// What kernels cost: each method on one material, a pass per pixel, and every method on every material.
//   kernel_bench [--benchmark_filter=...]; the last line is of all methods and materials, in CPU seconds.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <ctime>

#include "kernel/judge.h"
#include "kernel/methods.h"
#include "kernel/preintegrated.h"
#include "kernel/taps.h"
#include "model/plane.h"
#include "scene/materials.h"

namespace searchlight {
namespace {

GroundTruth truthOf(const Medium& medium) {
    const Model model = loadModel("better_dipole");
    const auto evaluator = makeNativeEvaluator(model);
    evaluator->set(medium, {});
    Tabulation table = tabulate(*evaluator, model, medium);
    return GroundTruth(std::move(table.profile), table.tail);
}

const GroundTruth& skin() {
    static const GroundTruth truth = truthOf(findMaterial("skin1").medium);
    return truth;
}

std::vector<MethodOptions> everyMethod() {
    return {{},
            {.placed = true},
            {.method = "svd"},
            {.method = "svd", .rank = 6},
            {.method = "guided", .guided = {.k = 0}},
            {.method = "guided", .guided = {.k = 1}},
            {.method = "guided", .guided = {.k = 2}},
            {.method = "gaussians", .count = 4},
            {.method = "gaussians", .count = 6},
            {.method = "manual"},
            {.method = "skin"},
            {.method = "optimised"},
            {.method = "optimised", .rank = 2},
            {.method = "turned"}};
}

void make(benchmark::State& state) {
    const MethodOptions options = everyMethod()[static_cast<std::size_t>(state.range(0))];
    const CellKernel cells = cellKernel(skin(), gridOf(skin()));
    std::string name;
    for (auto _ : state) name = makeKernel(skin(), cells, options).name;
    state.SetLabel(name + (options.placed ? ", placed" : ""));
}
BENCHMARK(make)->DenseRange(0, 13)->Unit(benchmark::kMillisecond);

void judge(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(Judge(skin()));
}
BENCHMARK(judge)->Unit(benchmark::kMillisecond);

void pass(benchmark::State& state) {
    const SeparableKernel kernel = preintegrated(skin());
    const Taps taps = quadraticTaps(kernel, static_cast<int>(state.range(0)));
    const Image image(512, 512, {0.5, 0.5, 0.5, 1});
    for (auto _ : state) benchmark::DoNotOptimize(tapsFilter(image, taps, {.pixel_mm = 0.05}));
    state.counters["ns per pixel and pass"] = benchmark::Counter(
        2.0 * 512 * 512, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(pass)->Arg(11)->Arg(17)->Arg(25)->Unit(benchmark::kMillisecond);

void everything() {
    const std::clock_t start = std::clock();
    int count = 0, kernels = 0;
    for (const Material& material : materials()) {
        bool scatters = false;
        for (int c = 0; c < material.medium.channels; ++c) scatters = scatters || material.medium.scatters(c);
        if (!scatters) continue;
        const GroundTruth truth = truthOf(material.medium);
        const CellKernel cells = cellKernel(truth, gridOf(truth));
        for (const MethodOptions& options : everyMethod()) {
            benchmark::DoNotOptimize(makeKernel(truth, cells, options));
            ++kernels;
        }
        ++count;
    }
    std::printf("%d kernels of %d materials: %.1f CPU s\n", kernels, count,
                static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
}

}  // namespace
}  // namespace searchlight

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    searchlight::everything();
}
