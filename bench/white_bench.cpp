// White Monte Carlo: walks per second into a table, the size of the table, and the time of one curve of 100 bins from
// it.
#include <benchmark/benchmark.h>

#include "transport/walk/radial_edges.h"
#include "transport/white/white.h"

namespace searchlight {
namespace {

void build(benchmark::State& state, const WhiteKey& key) {
    Observer observer;
    double walks = 0, collisions = 0;
    std::size_t bytes = 0;
    for (auto _ : state) {
        const WhiteTable table = buildWhiteTable(key, 1, observer);
        walks += static_cast<double>(table.fine.walks + table.pilot.walks);
        collisions += static_cast<double>(table.collisions);
        bytes = table.bytes();
    }
    state.counters["walks/s"] = benchmark::Counter(walks, benchmark::Counter::kIsRate);
    state.counters["collisions/s"] = benchmark::Counter(collisions, benchmark::Counter::kIsRate);
    state.counters["collisions/walk"] = collisions / walks;
    state.counters["MB"] = static_cast<double>(bytes) * 1e-6;
}

void evaluate(benchmark::State& state, const HalfSpaceProblem& problem) {
    Observer observer;
    const WhiteTable table = buildWhiteTable({.g = problem.g, .eta = problem.eta, .walks = 1'000'000}, 0, observer);
    const std::vector<double> edges = defaultEdges(problem, 100);
    for (auto _ : state) benchmark::DoNotOptimize(evaluateWhite(table, problem.sigma_a, problem.sigma_s, edges));
}

BENCHMARK_CAPTURE(build, matched, {.walks = 1'000'000})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build, eta_1_3, {.eta = 1.3, .walks = 1'000'000})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build, eta_1_5, {.eta = 1.5, .walks = 1'000'000})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build, eta_1_4_g_09, {.g = 0.9, .eta = 1.4, .walks = 1'000'000})->Unit(benchmark::kMillisecond);

BENCHMARK_CAPTURE(evaluate, marble_red, {.sigma_a = 0.0021, .sigma_s = 2.19, .eta = 1.5})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(evaluate, ketchup_blue, {.sigma_a = 1.45, .sigma_s = 0.03, .eta = 1.3})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(evaluate, forward_g_09, {.sigma_a = 0.01, .sigma_s = 10, .g = 0.9, .eta = 1.4})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace searchlight
