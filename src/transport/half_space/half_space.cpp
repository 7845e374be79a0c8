#include "transport/half_space/half_space.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "transport/half_space/half_space_best.h"
#include "transport/half_space/half_space_walk.h"
#include "transport/walk/beam.h"

namespace searchlight {

namespace {

constexpr std::uint64_t kFewestChunks = 64;
constexpr std::uint64_t kLargestChunk = 65'536;
constexpr int kFinestGrid = 4096;
// Beyond, expected escapes are few and heavy, and the analogue walk is the better one (docs/benchmarks.md).
constexpr double kMostForward = 0.7;

[[noreturn]] void reject(const char* what, double value, const char* valid) {
    throw inputError(std::string(what) + " is " + numberText(value), std::string(valid));
}

// Written so that NaN is rejected.
void check(const HalfSpaceProblem& problem) {
    constexpr double largest = 1e9;  // keeps squares of radii in mean free paths far from overflow
    if (!(problem.sigma_a >= 0 && problem.sigma_a <= largest)) reject("sigma_a", problem.sigma_a, "0 to 1e9 1/mm");
    if (!(problem.sigma_s >= 0 && problem.sigma_s <= largest)) reject("sigma_s", problem.sigma_s, "0 to 1e9 1/mm");
    if (!(problem.g > -1 && problem.g < 1)) reject("g", problem.g, "above -1 and below 1");
    if (!(problem.eta >= 0.1 && problem.eta <= 10)) reject("eta", problem.eta, "0.1 to 10, inside over outside");
    if (!(problem.angle_deg >= 0 && problem.angle_deg < 90))
        reject("the angle of incidence", problem.angle_deg, "0 to below 90 degrees");
}

void check(const HalfSpaceOptions& options) {
    if (options.walks == 0) throw inputError("a reference needs at least one walk");
    const std::vector<double>& edges = options.edges_mm;
    if (edges.size() < 2) throw inputError("radial bins need at least 2 edges");
    if (!(edges.front() >= 0)) reject("the first edge", edges.front(), "0 mm or more");
    for (std::size_t i = 1; i < edges.size(); ++i)
        if (!(edges[i] > edges[i - 1] && edges[i] <= 1e9))
            reject("an edge", edges[i], "edges ascend and end at 1e9 mm");
    if (options.grid < 0 || options.grid > kFinestGrid) reject("the grid", options.grid, "0 to 4096 cells a side");
    if (options.grid > 0 && !(options.grid_extent_mm > 0 && options.grid_extent_mm <= 1e9))
        reject("the extent of the grid", options.grid_extent_mm, "above 0, up to 1e9 mm");
}

// Sums over chunks of one order of scattering.
struct OrderSums {
    BatchRatios flux;        // weight per slot, over walks
    BatchRatios moments{2};  // weight times x and r^2, over the weight that left

    void add(const ExitTally::Sums& chunk, double walks) {
        flux.add(chunk.flux, walks);
        const double moment[] = {chunk.x, chunk.r2};
        moments.add(moment, chunk.flux[0]);
    }
};

ExitTally::Sums operator+(const ExitTally::Sums& a, const ExitTally::Sums& b) {
    ExitTally::Sums sum{a.flux, a.x + b.x, a.r2 + b.r2};
    for (std::size_t i = 0; i < sum.flux.size(); ++i) sum.flux[i] += b.flux[i];
    return sum;
}

class Reduction {
public:
    Reduction(const HalfSpaceProblem& problem, const HalfSpaceOptions& options, const TallyLayout& layout,
              double transmitted, std::optional<double> reach)
        : options_(options),
          reach_(reach),
          layout_(layout),
          transmitted_(transmitted),
          mfp_(1 / (problem.sigma_a + problem.sigma_s)) {}

    void add(const ExitTally& chunk, std::uint64_t walks) {
        const ExitTally::Sums &one = chunk.sums(ExitTally::single), &more = chunk.sums(ExitTally::multiple);
        const double n = static_cast<double>(walks);
        single_.add(one, n);
        multiple_.add(more, n);
        all_.add(one + more, n);
    }

    void finish(HalfSpaceResult& result) const {
        result.all = tallyOf(all_);
        result.single = tallyOf(single_);
        result.multiple = tallyOf(multiple_);
    }

private:
    // Per unit incident flux. The scatter of batches without an exit would be 0; one exit is the least that can be
    // said, unless exits have been foreseen with weights far below 1.
    Estimate flux(const OrderSums& sums, std::size_t slot, double radius_mfp = 0) const {
        const double walks = static_cast<double>(options_.walks);
        Estimate e = sums.flux.estimate(slot, options_.walks);
        double least = 1 / walks;
        if (reach_)
            least = radius_mfp >= *reach_ ? std::sqrt(std::max(e.mean, least) / walks) : e.mean == 0 ? least : 0;
        e.standard_error = std::max(e.standard_error, least);
        return {transmitted_ * e.mean, transmitted_ * e.standard_error, e.count};
    }

    Estimate moment(const OrderSums& sums, std::size_t index, double unit) const {
        const Estimate e = sums.moments.estimate(index, options_.walks);
        return {e.mean * unit, e.standard_error * unit, e.count};
    }

    HalfSpaceTally tallyOf(const OrderSums& sums) const {
        HalfSpaceTally tally;
        tally.total = flux(sums, 0);
        const std::size_t first = 1, last = layout_.bins.slots();
        tally.beyond = {flux(sums, first).mean + flux(sums, last).mean};
        const std::vector<double>& edges = options_.edges_mm;
        for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
            const double area = std::numbers::pi * (edges[i + 1] - edges[i]) * (edges[i + 1] + edges[i]);
            const Estimate bin = flux(sums, first + 1 + i, edges[i] / mfp_);
            tally.Rd.push_back(bin.mean / area);
            tally.standard_error.push_back(bin.standard_error / area);
        }
        tally.mean_x_mm = moment(sums, 0, mfp_);
        tally.mean_r2_mm2 = moment(sums, 1, mfp_ * mfp_);
        const double side = options_.grid > 0 ? 2 * options_.grid_extent_mm / options_.grid : 0;
        for (std::size_t slot = layout_.gridSlot(); slot < layout_.slots(); ++slot) {
            const Estimate cell = flux(sums, slot);
            tally.grid.push_back(cell.mean / (side * side));
            tally.grid_standard_error.push_back(cell.standard_error / (side * side));
        }
        return tally;
    }

    const HalfSpaceOptions& options_;
    std::optional<double> reach_;  ///< BestPlan::reach; errors beyond are at least those of whole exits
    const TallyLayout& layout_;
    double transmitted_;
    double mfp_;
    OrderSums all_{BatchRatios(layout_.slots())};
    OrderSums single_{BatchRatios(layout_.slots())};
    OrderSums multiple_{BatchRatios(layout_.slots())};
};

// Nothing enters or nothing scatters: exact zeros.
HalfSpaceTally emptyTally(const HalfSpaceOptions& options) {
    HalfSpaceTally tally;
    const std::size_t bins = options.edges_mm.size() - 1;
    const std::size_t cells = static_cast<std::size_t>(options.grid) * static_cast<std::size_t>(options.grid);
    tally.Rd.assign(bins, 0.0);
    tally.standard_error.assign(bins, 0.0);
    tally.beyond = {0.0};
    tally.grid.assign(cells, 0.0);
    tally.grid_standard_error.assign(cells, 0.0);
    return tally;
}

std::vector<double> scaled(std::vector<double> edges, double sigma_t) {
    for (double& edge : edges) edge *= sigma_t;
    return edges;
}

std::uint64_t chunksOf(std::uint64_t walks) {
    return std::min(walks, std::max(kFewestChunks, (walks + kLargestChunk - 1) / kLargestChunk));
}

}  // namespace

HalfSpaceProblem halfSpaceProblem(const Medium& medium, int channel, double angle_deg) {
    return {medium.sigma_a[channel], medium.sigma_s[channel], medium.g[channel], medium.eta, angle_deg};
}

HalfSpaceResult walkHalfSpace(const HalfSpaceProblem& problem, const HalfSpaceOptions& options, Observer& observer) {
    check(problem);
    check(options);
    const Beam beam = enteringBeam(problem.eta, problem.angle_deg);
    HalfSpaceResult result;
    result.specular = beam.specular;
    result.threads = options.threads > 0 ? options.threads : hardwareThreads();
    result.instruction_set = halfSpaceInstructionSet();
    result.estimator = options.grid > 0 || problem.g > kMostForward ? Estimator::analogue : options.estimator;
    if (problem.sigma_s == 0 || beam.specular == 1) {
        result.all = result.single = result.multiple = emptyTally(options);
        return result;
    }

    const double sigma_t = problem.sigma_a + problem.sigma_s;
    const HalfSpaceWalk walk{problem.sigma_a / sigma_t, problem.g, problem.eta, beam.sine, beam.cosine};
    const std::vector<double> edges = scaled(options.edges_mm, sigma_t);
    const TallyLayout layout{RadialBins(edges), static_cast<std::size_t>(options.grid),
                             options.grid_extent_mm * sigma_t};
    std::optional<BestPlan> best;
    if (result.estimator == Estimator::best) best.emplace(walk, edges);
    std::optional<double> reach;
    if (best) reach = best->reach(options.walks);
    Reduction reduction(problem, options, layout, 1 - beam.specular, reach);
    const std::uint64_t chunks = chunksOf(options.walks);
    const auto firstWalk = [&](std::uint64_t chunk) {  // chunks differ by at most one walk
        return options.walks / chunks * chunk + std::min(options.walks % chunks, chunk);
    };

    // Blocks bound the memory; within a block threads take chunks as they come, and sums run in chunk order.
    const std::uint64_t block = 4 * static_cast<std::uint64_t>(result.threads);
    std::atomic<std::uint64_t> done = 0, collisions = 0;
    const auto begin = std::chrono::steady_clock::now();
    for (std::uint64_t start = 0; start < chunks; start += block) {
        std::vector<ExitTally> tallies(std::min(block, chunks - start), ExitTally(layout));
        parallelFor(tallies.size(), options.threads, [&](std::size_t i) {
            if (observer.cancelled()) throw interruptedError();
            const std::uint64_t chunk = start + i, walks = firstWalk(chunk + 1) - firstWalk(chunk);
            collisions += best ? walkBestChunk(*best, options.seed, chunk, walks, tallies[i])
                               : walkHalfSpaceChunk(walk, options.seed, chunk, walks, tallies[i]);
            observer.progress("walk", done += walks, options.walks, "walks");
        });
        for (std::size_t i = 0; i < tallies.size(); ++i)
            reduction.add(tallies[i], firstWalk(start + i + 1) - firstWalk(start + i));
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    result.walks = options.walks;
    result.collisions = collisions;
    reduction.finish(result);
    return result;
}

}  // namespace searchlight
