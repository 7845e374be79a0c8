// Walks per CPU second of one thread with AVX-512, AVX2 and SSE4, which take turns: medians of rounds, so that ratios
// hold on a machine that does other things. Usage: instruction_set_bench [rounds]
#include <fmt/format.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "transport/half_space/half_space.h"
#include "transport/slab/slab.h"

namespace searchlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::array targets{HWY_AVX3, HWY_AVX2, HWY_SSE4};
constexpr double seconds = 0.15;  // of one turn

struct Case {
    std::string name;
    std::function<double(double walks)> walk;  // returns how many were walked
};

Case halfSpace(const char* name, const HalfSpaceProblem& problem, Estimator estimator) {
    return {fmt::format("{}, {}", name, estimator == Estimator::best ? "best" : "analogue"), [=](double walks) {
                HalfSpaceOptions options{.walks = static_cast<std::uint64_t>(walks), .threads = 1};
                options.estimator = estimator;
                const double mfp = 1 / (problem.sigma_a + (1 - problem.g) * problem.sigma_s);
                for (int i = 0; i <= 51; ++i) options.edges_mm.push_back(0.1 * i * mfp);
                Observer observer;
                return static_cast<double>(walkHalfSpace(problem, options, observer).walks);
            }};
}

Case slab(const char* name, const SlabProblem& problem, SlabEstimator estimator) {
    return {fmt::format("{}, {}", name, estimator == SlabEstimator::best ? "best" : "analogue"), [=](double walks) {
                SlabOptions options{.walks = static_cast<std::uint64_t>(walks), .depths = 40, .depth_mm = 4};
                options.threads = 1;
                options.estimator = estimator;
                for (int i = 0; i <= 50; ++i) options.edges_mm.push_back(0.1 * i);
                Observer observer;
                return static_cast<double>(walkSlab(problem, options, observer).walks);
            }};
}

std::vector<Case> cases() {
    std::vector<Case> list;
    const auto half = [&](const char* name, const HalfSpaceProblem& problem) {
        for (const Estimator estimator : {Estimator::analogue, Estimator::best})
            list.push_back(halfSpace(name, problem, estimator));
    };
    const auto layers = [&](const char* name, const SlabProblem& problem) {
        for (const SlabEstimator estimator : {SlabEstimator::analogue, SlabEstimator::best})
            list.push_back(slab(name, problem, estimator));
    };
    // Jensen 2001: published reduced coefficients, taken with g = 0. Then forward scattering.
    half("marble, red", {.sigma_a = 0.0021, .sigma_s = 2.19, .eta = 1.5});
    half("skin1, red", {.sigma_a = 0.032, .sigma_s = 0.74, .eta = 1.3});
    half("ketchup, blue", {.sigma_a = 1.45, .sigma_s = 0.03, .eta = 1.3});
    half("whole milk, green", {.sigma_a = 0.0024, .sigma_s = 3.21, .eta = 1.3});
    half("g = 0.9", {.sigma_a = 0.01, .sigma_s = 10, .g = 0.9, .eta = 1.4});
    layers("three layers, n 1.37", {1, 1, {{1.37, 0.1, 10, 0.9, 1}, {1.37, 0.1, 1, 0, 1}, {1.37, 0.2, 1, 0.7, 2}}});
    layers("sheet, g 0.75", {1, 1, {{1, 1, 9, 0.75, 0.2}}});
    layers("half-space, g 0, n 1.5", {1, 1, {{1.5, 1, 9, 0, infinity}}});
    layers("half-space, g 0.9, n 1.4", {1, 1, {{1.4, 0.01, 10, 0.9, infinity}}});
    return list;
}

double rate(const Case& one, double walks) {
    const std::clock_t begin = std::clock();
    const double walked = one.walk(walks);
    return walked * CLOCKS_PER_SEC / static_cast<double>(std::max<std::clock_t>(1, std::clock() - begin));
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

}  // namespace
}  // namespace searchlight

int main(int argc, char** argv) {
    using namespace searchlight;
    const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 7;
    fmt::print("{:<36} {:>12} {:>12} {:>12}   {:>7} {:>7}\n", "walks/s", "AVX-512", "AVX2", "SSE4", "AVX2", "SSE4");
    for (const Case& one : cases()) {
        std::array<double, targets.size()> walks{};
        std::array<std::vector<double>, targets.size()> rates, parts;
        for (int round = -1; round < rounds; ++round) {
            std::array<double, targets.size()> found{};
            for (std::size_t i = 0; i < targets.size(); ++i) {
                if ((hwy::SupportedTargets() & targets[i]) == 0) continue;
                hwy::SetSupportedTargetsForTest(targets[i]);
                found[i] = rate(one, round < 0 ? 20'000 : walks[i]);
                hwy::SetSupportedTargetsForTest(0);
                if (round < 0)
                    walks[i] = std::max(1e4, found[i] * seconds);
                else
                    rates[i].push_back(found[i]);
            }
            for (std::size_t i = 0; i < targets.size() && round >= 0; ++i) parts[i].push_back(found[i] / found[0]);
        }
        fmt::print("{:<36}", one.name);
        for (const auto& list : rates) fmt::print(" {:>12.4g}", list.empty() ? 0 : median(list));
        fmt::print("   {:>7.2f} {:>7.2f}\n", median(parts[1]), median(parts[2]));
    }
    return 0;
}
