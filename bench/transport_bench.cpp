// Speed of the half-space walk on one core: walks and collisions per CPU second, and the figure of merit of bins
// [r, r + 0.1) at r = 0.5, 1, 2, 5 reduced mean free paths: 1 / (relative variance x CPU seconds).
#include <benchmark/benchmark.h>

#include <ctime>

#include "transport/half_space.h"

namespace searchlight {
namespace {

void walk(benchmark::State& state, const HalfSpaceProblem& problem, double walks) {
    const double mfp = 1 / (problem.sigma_a + (1 - problem.g) * problem.sigma_s);
    HalfSpaceOptions options;
    options.walks = static_cast<std::uint64_t>(walks);
    options.threads = 1;
    options.edges_mm = {0, 0.5 * mfp, 0.6 * mfp, 1 * mfp, 1.1 * mfp, 2 * mfp, 2.1 * mfp, 5 * mfp, 5.1 * mfp};
    Observer observer;
    double total_walks = 0, collisions = 0;
    HalfSpaceResult result;
    const std::clock_t begin = std::clock();
    for (auto _ : state) {
        ++options.seed;
        result = walkHalfSpace(problem, options, observer);
        total_walks += static_cast<double>(result.walks);
        collisions += static_cast<double>(result.collisions);
    }
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    state.counters["walks/s"] = total_walks / seconds;
    state.counters["collisions/s"] = collisions / seconds;
    constexpr const char* names[] = {"merit_0.5", "merit_1", "merit_2", "merit_5"};
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t bin = 2 * i + 1;
        const double relative = result.all.standard_error[bin] / result.all.Rd[bin];
        state.counters[names[i]] = 1 / (relative * relative * seconds / static_cast<double>(state.iterations()));
    }
    state.SetLabel(result.instruction_set);
}

// Jensen 2001: published reduced coefficients, taken with g = 0. The last row is a forward scattering medium.
BENCHMARK_CAPTURE(walk, marble_red, {.sigma_a = 0.0021, .sigma_s = 2.19, .eta = 1.5}, 1e7)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(walk, skin1_red, {.sigma_a = 0.032, .sigma_s = 0.74, .eta = 1.3}, 5e7)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(walk, ketchup_blue, {.sigma_a = 1.45, .sigma_s = 0.03, .eta = 1.3}, 5e8)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(walk, whole_milk_green, {.sigma_a = 0.0024, .sigma_s = 3.21, .eta = 1.3}, 1e7)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(walk, forward_g_09, {.sigma_a = 0.01, .sigma_s = 10, .g = 0.9, .eta = 1.4}, 3e6)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace searchlight
