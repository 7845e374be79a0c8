// Speed of the half-space walk on one core: walks and collisions per CPU second, and the figure of merit of bins
// [r, r + 0.1) at r = 0.5, 1, 2, 5, 10 reduced mean free paths: 1 / (relative variance x CPU seconds). Bins are 0.1
// wide all the way. The estimators take turns, so that their ratios come from one run.
#include <benchmark/benchmark.h>

#include <ctime>

#include "transport/half_space/half_space.h"

namespace searchlight {
namespace {

// Bins reach to `farthest` reduced mean free paths: the best estimator serves the bins that it is given.
void walk(benchmark::State& state, const HalfSpaceProblem& problem, Estimator estimator, double walks, int farthest) {
    const double mfp = 1 / (problem.sigma_a + (1 - problem.g) * problem.sigma_s);
    HalfSpaceOptions options;
    options.walks = static_cast<std::uint64_t>(walks);
    options.threads = 1;
    options.estimator = estimator;
    for (int i = 0; i <= 10 * farthest + 1; ++i) options.edges_mm.push_back(0.1 * i * mfp);
    struct Bin {
        const char* name;
        std::size_t index;
        double relative_variance = 0;  // summed over iterations
    } bins[] = {{"merit_0.5", 5}, {"merit_1", 10}, {"merit_2", 20}, {"merit_5", 50}, {"merit_10", 100}};
    Observer observer;
    double total_walks = 0, collisions = 0, total_variance = 0;
    HalfSpaceResult result;
    const std::clock_t begin = std::clock();
    for (auto _ : state) {
        ++options.seed;
        result = walkHalfSpace(problem, options, observer);
        total_walks += static_cast<double>(result.walks);
        collisions += static_cast<double>(result.collisions);
        const auto relativeVariance = [](double error, double mean) { return error * error / (mean * mean); };
        total_variance += relativeVariance(result.all.total.standard_error, result.all.total.mean);
        for (Bin& bin : bins)
            if (bin.index < result.all.Rd.size())
                bin.relative_variance +=
                    relativeVariance(result.all.standard_error[bin.index], result.all.Rd[bin.index]);
    }
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    const double iterations = static_cast<double>(state.iterations());
    const auto merit = [&](double variance) { return iterations * iterations / (variance * seconds); };
    state.counters["walks/s"] = total_walks / seconds;
    state.counters["collisions/s"] = collisions / seconds;
    state.counters["merit_total"] = merit(total_variance);
    for (const Bin& bin : bins)
        if (bin.index < result.all.Rd.size()) state.counters[bin.name] = merit(bin.relative_variance);
    state.SetLabel(result.instruction_set + (result.estimator == Estimator::best ? ", best" : ", analogue"));
}

#define SEARCHLIGHT_BOTH(name, walks, ...)                                                                       \
    BENCHMARK_CAPTURE(walk, name##_analogue, __VA_ARGS__, Estimator::analogue, walks, 5)                         \
        ->Unit(benchmark::kMillisecond);                                                                         \
    BENCHMARK_CAPTURE(walk, name##_best, __VA_ARGS__, Estimator::best, walks, 5)->Unit(benchmark::kMillisecond); \
    BENCHMARK_CAPTURE(walk, name##_analogue_10, __VA_ARGS__, Estimator::analogue, walks, 10)                     \
        ->Unit(benchmark::kMillisecond);                                                                         \
    BENCHMARK_CAPTURE(walk, name##_best_10, __VA_ARGS__, Estimator::best, walks, 10)->Unit(benchmark::kMillisecond)

// Jensen 2001: published reduced coefficients, taken with g = 0. Then forward scattering and oblique incidence.
SEARCHLIGHT_BOTH(marble_red, 1e7, HalfSpaceProblem{.sigma_a = 0.0021, .sigma_s = 2.19, .eta = 1.5});
SEARCHLIGHT_BOTH(skin1_red, 2e7, HalfSpaceProblem{.sigma_a = 0.032, .sigma_s = 0.74, .eta = 1.3});
SEARCHLIGHT_BOTH(ketchup_blue, 1e8, HalfSpaceProblem{.sigma_a = 1.45, .sigma_s = 0.03, .eta = 1.3});
SEARCHLIGHT_BOTH(whole_milk_green, 1e7, HalfSpaceProblem{.sigma_a = 0.0024, .sigma_s = 3.21, .eta = 1.3});
SEARCHLIGHT_BOTH(forward_g_06, 1e7, HalfSpaceProblem{.sigma_a = 0.01, .sigma_s = 2.5, .g = 0.6, .eta = 1.4});
SEARCHLIGHT_BOTH(forward_g_09, 3e6, HalfSpaceProblem{.sigma_a = 0.01, .sigma_s = 10, .g = 0.9, .eta = 1.4});
SEARCHLIGHT_BOTH(skin1_red_60_deg, 2e7,
                 HalfSpaceProblem{.sigma_a = 0.032, .sigma_s = 0.74, .eta = 1.3, .angle_deg = 60});

}  // namespace
}  // namespace searchlight
