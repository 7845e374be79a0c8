// Whether the best estimator anywhere knows less than the analogue one in the same time: both in turns over a grid of
// half-spaces and over slabs of many kinds, for every number that they tell.
//
//     merit_bench half|slab [CPU seconds of a run] [rounds] [part of a name]
//
// Prints the quotient of their figures of merit, 1 / (relative variance x CPU seconds of whole runs on one thread),
// cell by cell; cells with a number below 1.15 are walked four times as long again. Then what is still below 1.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "transport/half_space/half_space.h"
#include "transport/slab/slab.h"

namespace searchlight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Numbers that are judged as one: by the mean of their relative variances.
struct Group {
    std::string name;
    std::vector<Estimate> numbers;
};

struct Cell {
    std::string name;
    std::function<std::vector<Group>(bool best, std::uint64_t walks, std::uint64_t seed)> run;
};

Group series(std::string name, const std::vector<double>& mean, const std::vector<double>& error, std::size_t first,
             std::size_t count) {
    Group group{std::move(name), {}};
    for (std::size_t i = first; i < std::min(first + count, mean.size()); ++i)
        group.numbers.push_back({mean[i], error[i], 0});
    return group;
}

std::vector<double> ascending(double step, int count) {
    std::vector<double> edges;
    for (int i = 0; i <= count; ++i) edges.push_back(step * i);
    return edges;
}

// Five bins from each of these, of widths of 0.1 reduced mean free paths.
struct Place {
    const char* name;
    std::size_t first;
};
constexpr Place kPlaces[] = {{"0.5", 3}, {"1", 8}, {"2", 18}, {"5", 48}};

std::vector<Group> runHalfSpace(const HalfSpaceProblem& problem, bool best, std::uint64_t walks, std::uint64_t seed) {
    HalfSpaceOptions options{.walks = walks, .seed = seed};
    options.threads = 1;
    options.estimator = best ? Estimator::best : Estimator::analogue;
    options.edges_mm = ascending(0.1 / (problem.sigma_a + (1 - problem.g) * problem.sigma_s), 53);
    Observer observer;
    const HalfSpaceTally all = walkHalfSpace(problem, options, observer).all;
    std::vector<Group> groups;
    for (const Place& place : kPlaces)
        groups.push_back(series(fmt::format("R({})", place.name), all.Rd, all.standard_error, place.first, 5));
    groups.push_back({"R", {all.total}});
    groups.push_back({"r2", {all.mean_r2_mm2}});
    if (problem.angle_deg > 0) groups.push_back({"x", {all.mean_x_mm}});
    return groups;
}

std::vector<Cell> halfSpaces() {
    std::vector<Cell> cells;
    for (const double angle : {0.0, 60.0})
        for (const double eta : {1.0, 1.3, 1.5})
            for (const double g : {0.0, 0.5, 0.8, 0.9, 0.95})
                for (const double albedo : {0.3, 0.7, 0.9, 0.99, 0.999, 0.9999}) {
                    const HalfSpaceProblem problem{
                        .sigma_a = 1 - albedo, .sigma_s = albedo, .g = g, .eta = eta, .angle_deg = angle};
                    cells.push_back({fmt::format("albedo {} g {} eta {} at {}", albedo, g, eta, angle),
                                     [problem](bool best, std::uint64_t walks, std::uint64_t seed) {
                                         return runHalfSpace(problem, best, walks, seed);
                                     }});
                }
    return cells;
}

// Of a slab, lengths in reduced mean free paths of its thickest layer.
std::vector<Group> runSlab(const SlabProblem& problem, bool best, std::uint64_t walks, std::uint64_t seed) {
    double thickness = 0, rate = 0, most = 0;
    for (const SlabLayer& layer : problem.layers) {
        thickness += layer.thickness_mm;
        const double reduced = layer.sigma_a + (1 - layer.g) * layer.sigma_s;
        if (const double depth = layer.thickness_mm * reduced; depth > most || rate == 0) rate = reduced, most = depth;
    }
    SlabOptions options{.walks = walks, .seed = seed};
    options.edges_mm = ascending(0.1 / rate, 53);
    options.depths = 40;
    options.depth_mm = std::isinf(thickness) ? 8 / rate : thickness;
    options.threads = 1;
    options.estimator = best ? SlabEstimator::best : SlabEstimator::analogue;
    Observer observer;
    const SlabResult r = walkSlab(problem, options, observer);
    std::vector<Group> groups{{"R", {r.R}}, {"T", {r.T}}, {"A", {r.A}}};
    for (const auto& [name, found] : {std::pair("R", &r.R_r), std::pair("T", &r.T_r)})
        for (const Place& place : kPlaces)
            groups.push_back(
                series(fmt::format("{}({})", name, place.name), found->mean, found->standard_error, place.first, 5));
    for (const auto& [name, found] : {std::pair("R", &r.R_a), std::pair("T", &r.T_a)}) {
        groups.push_back(series(fmt::format("{}(9-30)", name), found->mean, found->standard_error, 3, 7));
        groups.push_back(series(fmt::format("{}(45-75)", name), found->mean, found->standard_error, 15, 10));
    }
    for (std::size_t quarter = 0; quarter < 4; ++quarter)
        groups.push_back(
            series(fmt::format("A(z {})", quarter + 1), r.A_z.mean, r.A_z.standard_error, 10 * quarter, 10));
    return groups;
}

std::vector<Cell> slabs() {
    struct Slab {
        const char* name;
        SlabProblem problem;
    };
    const SlabLayer glass{1.5, 0, 0, 0, 1};
    const SlabLayer skin1{1.4, 0.032, 0.74, 0, 2}, skin2{1.4, 0.013, 1.09, 0, 8};
    const Slab all[] = {
        {"marble, 10 mm", {1, 1, {{1.5, 0.0021, 2.19, 0, 10}}}},
        {"marble, 10 mm, at 60", {1, 1, {{1.5, 0.0021, 2.19, 0, 10}}, 60}},
        {"marble, 2 mm", {1, 1, {{1.5, 0.0021, 2.19, 0, 2}}}},
        {"skin1 on skin2", {1, 1, {skin1, skin2}}},
        {"skin1 on g .5 at 30", {1, 1, {skin1, {1.5, 0.01, 3, 0.5, 2}}, 30}},
        {"g .5, 6 mm", {1, 1, {{1.4, 0.05, 4, 0.5, 6}}}},
        {"g .5, 1 mm", {1, 1, {{1.4, 0.05, 4, 0.5, 1}}}},
        {"g .5, 2 mm at 60", {1, 1, {{1.4, 0.05, 4, 0.5, 2}}, 60}},
        {"g .5 matched, 3 mm", {1, 1, {{1, 0.05, 4, 0.5, 3}}}},
        {"g .7, 3 mm", {1, 1, {{1.4, 0.1, 5, 0.7, 3}}}},
        {"g .8, 3 mm", {1, 1, {{1.4, 0.1, 8, 0.8, 3}}}},
        {"g .9, 3 mm", {1, 1, {{1.4, 0.1, 10, 0.9, 3}}}},
        {"g -.3, 2 mm", {1, 1, {{1.4, 0.1, 2, -0.3, 2}}}},
        {"thin (.05, 1), 1 mm", {1, 1, {{1.4, 0.05, 1, 0, 1}}}},
        {"thin matched (0, 1), 1 mm", {1, 1, {{1, 0, 1, 0, 1}}}},
        {"very thin (.01, .1), 1 mm", {1, 1, {{1.4, 0.01, 0.1, 0, 1}}}},
        {"infinite (.1, 2)", {1, 1, {{1.5, 0.1, 2, 0, kInfinity}}}},
        {"infinite g .9", {1, 1, {{1.4, 0.1, 10, 0.9, kInfinity}}}},
        {"sheet g .75", {1, 1, {{1, 1, 9, 0.75, 0.2}}}},
        {"three layers", {1, 1, {{1.37, 0.1, 10, 0.9, 0.1}, {1.37, 0.1, 1, 0, 0.1}, {1.37, 0.2, 1, 0.7, 0.2}}}},
        {"three thicker layers", {1, 1, {{1.37, 1, 100, 0.9, 0.1}, {1.37, 1, 10, 0, 0.1}, {1.37, 2, 10, 0.7, 0.2}}}},
        {"glass, 4 mm, glass", {1, 1, {glass, {1.4, 0.05, 2, 0, 4}, glass}}},
        {"glass, g .9, at 45", {1, 1, {glass, {1.4, 0.05, 10, 0.9, 2}, glass}, 45}},
        {"gap", {1, 1, {{1.5, 0.05, 2, 0, 1}, {1, 0, 0, 0, 0.5}, {1.4, 0.05, 2, 0, 1}}}},
        {"absorbing (1, 1), 2 mm", {1, 1, {{1.4, 1, 1, 0, 2}}}},
        {"absorbing (3, 1), 1 mm", {1, 1, {{1.4, 3, 1, 0, 1}}}},
        {"absorbing (10, 1), 1 mm", {1, 1, {{1.4, 10, 1, 0, 1}}}},
        {"absorbing (1, 3, g .5), 2 mm at 60", {1, 1, {{1.4, 1, 3, 0.5, 2}}, 60}},
        {"absorbing (3, 10, g .9), 0.5 mm", {1, 1, {{1.4, 3, 10, 0.9, 0.5}}}},
        {"index 2 below", {1, 2, {{1.3, 0.05, 2, 0, 3}}}},
    };
    std::vector<Cell> cells;
    for (const Slab& slab : all)
        cells.push_back({slab.name, [problem = slab.problem](bool best, std::uint64_t walks, std::uint64_t seed) {
                             return runSlab(problem, best, walks, seed);
                         }});
    return cells;
}

double cpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Both estimators in turns; what they found so far.
class Contest {
public:
    Contest(const Cell& cell, double seconds) : cell_(cell), seconds_(seconds) {}

    void walk(int rounds) {
        for (int round = 0; round < rounds; ++round, ++seed_)
            for (std::size_t who = 0; who < 2; ++who) {
                if (walks_[who] == 0) calibrate(who);
                const double begin = cpuSeconds();
                found_[who].push_back(cell_.run(who == 1, walks_[who], seed_));
                time_[who] += cpuSeconds() - begin;
            }
    }

    struct Ratio {
        std::string name;
        double value = 0, error = 0;  // NaN where the analogue walk knows nothing; relative, from the chunks' number
    };
    std::vector<Ratio> ratios() const {
        std::vector<Ratio> ratios;
        for (std::size_t group = 0; group < found_[0][0].size(); ++group) {
            const double analogue = variance(0, group), best = variance(1, group);
            const double rounds = static_cast<double>(found_[0].size());
            // Variances of 64 chunks, of neighbours that know nothing of each other.
            const double count = rounds * 32 * static_cast<double>(found_[0][0][group].numbers.size());
            ratios.push_back({found_[0][0][group].name, analogue * time_[0] / (best * time_[1]), std::sqrt(2 / count)});
        }
        return ratios;
    }

private:
    void calibrate(std::size_t who) {
        std::uint64_t walks = 4096;
        for (;;) {
            const double begin = cpuSeconds();
            cell_.run(who == 1, walks, 99);
            const double took = cpuSeconds() - begin;
            if (took > 0.25 * seconds_ || walks > 2'000'000'000) {
                walks_[who] = static_cast<std::uint64_t>(static_cast<double>(walks) * seconds_ / took);
                return;
            }
            walks *= took < 0.05 * seconds_ ? 8 : 2;
        }
    }

    // Mean over rounds and numbers of the relative variance, of numbers that the analogue walk knows to a fifth.
    double variance(std::size_t who, std::size_t group) const {
        double sum = 0, count = 0;
        for (std::size_t i = 0; i < found_[0][0][group].numbers.size(); ++i) {
            double mean = 0, error = 0;
            for (const std::vector<Group>& round : found_[0]) mean += round[group].numbers[i].mean;
            for (const std::vector<Group>& round : found_[0]) error += round[group].numbers[i].standard_error;
            if (!(error < 0.2 * mean)) continue;
            mean /= static_cast<double>(found_[0].size());
            for (const std::vector<Group>& round : found_[who])
                sum += std::pow(round[group].numbers[i].standard_error / mean, 2), ++count;
        }
        return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
    }

    const Cell& cell_;
    double seconds_;
    std::uint64_t seed_ = 1, walks_[2] = {};
    double time_[2] = {};
    std::vector<std::vector<Group>> found_[2];
};

int contest(const std::vector<Cell>& cells, double seconds, int rounds, std::string_view part) {
    std::vector<std::string> below;
    for (const Cell& cell : cells) {
        if (cell.name.find(part) == std::string::npos) continue;
        Contest contest(cell, seconds);
        contest.walk(rounds);
        for (const Contest::Ratio& ratio : contest.ratios())
            if (ratio.value < 1.15) {
                contest.walk(3 * rounds);
                break;
            }
        std::string line = cell.name + ':';
        for (const Contest::Ratio& ratio : contest.ratios()) {
            line += fmt::format("  {} {:.3g}", ratio.name, ratio.value);
            if (ratio.value < 1)
                below.push_back(
                    fmt::format("{}: {} {:.2f} +- {:.0f} %", cell.name, ratio.name, ratio.value, 100 * ratio.error));
        }
        std::puts(line.c_str());
        std::fflush(stdout);
    }
    std::printf("\n%zu numbers below 1\n", below.size());
    for (const std::string& line : below) std::puts(line.c_str());
    return 0;
}

}  // namespace
}  // namespace searchlight

int main(int count, char** arguments) {
    const std::string_view which = count > 1 ? arguments[1] : "";
    if (which != "half" && which != "slab") {
        std::puts("merit_bench half|slab [CPU seconds of a run] [rounds] [part of a name]");
        return 2;
    }
    const double seconds = count > 2 ? std::atof(arguments[2]) : 0.3;
    const int rounds = count > 3 ? std::atoi(arguments[3]) : 1;
    return searchlight::contest(which == "half" ? searchlight::halfSpaces() : searchlight::slabs(), seconds, rounds,
                                count > 4 ? arguments[4] : "");
}
