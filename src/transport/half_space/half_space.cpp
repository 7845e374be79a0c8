#include "transport/half_space/half_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "base/text.h"
#include "transport/half_space/half_space_best.h"
#include "transport/half_space/half_space_gl.h"
#include "transport/half_space/half_space_walk.h"
#include "transport/walk/beam.h"
#include "transport/walk/chunks.h"

namespace searchlight {

namespace {

constexpr int kFinestGrid = 2048;  // 4 million cells, of which a few per thread are in memory at once

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
    const BeamShape& beam = problem.beam;
    if (beam.kind != BeamShape::pencil && !(beam.radius > 0 && beam.radius <= largest))
        reject("the radius of the beam", beam.radius, "above 0, up to 1e9 mm");
}

void check(const HalfSpaceOptions& options) {
    if (options.walks == 0) throw inputError("a reference needs at least one walk");
    const std::vector<double>& edges = options.edges_mm;
    if (edges.size() < 2) throw inputError("radial bins need at least 2 edges");
    if (!(edges.front() >= 0)) reject("the first edge", edges.front(), "0 mm or more");
    for (std::size_t i = 1; i < edges.size(); ++i)
        if (!(edges[i] > edges[i - 1] && edges[i] <= 1e9))
            reject("an edge", edges[i], "edges ascend and end at 1e9 mm");
    if (options.grid < 0 || options.grid > kFinestGrid)
        reject("the grid", options.grid, fmt::format("0 to {} cells a side", kFinestGrid).c_str());
    if (options.grid > 0 && !(options.grid_extent_mm > 0 && options.grid_extent_mm <= 1e9))
        reject("the extent of the grid", options.grid_extent_mm, "above 0, up to 1e9 mm");
    const std::vector<double>& strip = options.strip_edges_mm;
    if (strip.size() == 1) throw inputError("a strip needs at least 2 edges");
    for (std::size_t i = 0; i < strip.size(); ++i)
        if (!(std::abs(strip[i]) <= 1e9 && (i == 0 || strip[i] > strip[i - 1])))
            reject("an edge of the strip", strip[i], "edges ascend within 1e9 mm of the entry point");
    if (!strip.empty() && !(options.strip_half_width_mm > 0 && options.strip_half_width_mm <= 1e9))
        reject("half the width of the strip", options.strip_half_width_mm, "above 0, up to 1e9 mm");
}

// What is summed over chunks, for every order of scattering: weight per slot, over walks; and weight times x and r^2,
// over the weight that left.
enum Sum { all_flux, single_flux, multiple_flux, all_moments, single_moments, multiple_moments, sum_count };

std::vector<BatchRatios> emptySums(const TallyLayout& layout) {
    std::vector<BatchRatios> sums(all_moments, BatchRatios(layout.slots()));
    sums.resize(sum_count, BatchRatios(2));
    return sums;
}

ExitTally::Sums operator+(const ExitTally::Sums& a, const ExitTally::Sums& b) {
    ExitTally::Sums sum{a.flux, a.x + b.x, a.r2 + b.r2};
    for (std::size_t i = 0; i < sum.flux.size(); ++i) sum.flux[i] += b.flux[i];
    return sum;
}

void addChunk(const ExitTally& chunk, std::uint64_t walks, std::vector<BatchRatios>& sums) {
    const ExitTally::Sums &one = chunk.sums(ExitTally::single), &more = chunk.sums(ExitTally::multiple);
    const ExitTally::Sums both = one + more;
    for (int order = 0; order < 3; ++order) {
        const ExitTally::Sums& add = order == 0 ? both : order == 1 ? one : more;
        sums[all_flux + order].add(add.flux, static_cast<double>(walks));
        const double moment[] = {add.x, add.r2};
        sums[all_moments + order].add(moment, add.flux[0]);
    }
}

// From sums to the numbers of the result.
class Reduction {
public:
    Reduction(const HalfSpaceProblem& problem, const HalfSpaceOptions& options, const TallyLayout& layout,
              double transmitted)
        : options_(options),
          layout_(layout),
          transmitted_(transmitted),
          lossless_(problem.sigma_a == 0),
          mfp_(1 / (problem.sigma_a + problem.sigma_s)) {}

    /// `reach`: BestPlan::reach; errors beyond are at least those of whole exits.
    void finish(const std::vector<BatchRatios>& sums, std::uint64_t walks, std::optional<double> reach,
                HalfSpaceResult& result) {
        walks_ = walks;
        reach_ = reach;
        result.all = tallyOf(sums[all_flux], sums[all_moments]);
        result.single = tallyOf(sums[single_flux], sums[single_moments]);
        result.multiple = tallyOf(sums[multiple_flux], sums[multiple_moments]);
    }

private:
    // Per unit incident flux. The scatter of batches without an exit would be 0; one exit is the least that can be
    // said, unless exits have been foreseen with weights far below 1.
    Estimate flux(const BatchRatios& sums, std::size_t slot, double radius_mfp = 0) const {
        const double walks = static_cast<double>(walks_);
        Estimate e = sums.estimate(slot, walks_);
        double least = 1 / walks;
        // Without absorption the total is known (half_space_plan.cpp); an error of 0 would be of no use to a test.
        if (reach_ && !(lossless_ && slot == 0))
            least = radius_mfp >= *reach_ ? std::sqrt(std::max(e.mean, least) / walks) : e.mean == 0 ? least : 0;
        e.standard_error = std::max(e.standard_error, least);
        return {transmitted_ * e.mean, transmitted_ * e.standard_error, e.count};
    }

    Estimate moment(const BatchRatios& sums, std::size_t index, double unit) const {
        const Estimate e = sums.estimate(index, walks_);
        return {e.mean * unit, e.standard_error * unit, e.count};
    }

    HalfSpaceTally tallyOf(const BatchRatios& sums, const BatchRatios& moments) const {
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
        tally.mean_x_mm = moment(moments, 0, mfp_);
        tally.mean_r2_mm2 = moment(moments, 1, mfp_ * mfp_);
        const double side = options_.grid > 0 ? 2 * options_.grid_extent_mm / options_.grid : 0;
        for (std::size_t slot = layout_.gridSlot(); slot < layout_.stripSlot(); ++slot) {
            const Estimate cell = flux(sums, slot);
            tally.grid.push_back(cell.mean / (side * side));
            tally.grid_standard_error.push_back(cell.standard_error / (side * side));
        }
        for (std::size_t i = 0; i < layout_.stripCells(); ++i) {
            const double area =
                2 * options_.strip_half_width_mm * (options_.strip_edges_mm[i + 1] - options_.strip_edges_mm[i]);
            const Estimate cell = flux(sums, layout_.stripSlot() + i);
            tally.strip.push_back(cell.mean / area);
            tally.strip_standard_error.push_back(cell.standard_error / area);
        }
        return tally;
    }

    const HalfSpaceOptions& options_;
    const TallyLayout& layout_;
    double transmitted_;
    bool lossless_;
    double mfp_;
    std::uint64_t walks_ = 0;
    std::optional<double> reach_;
};

// Whether the total, and the profile by its flux-weighted mean error, are known well enough.
EnoughFunction enoughFor(double error, const TallyLayout& layout) {
    if (error <= 0) return {};
    return [error, first = std::size_t{1}, last = layout.bins.slots()](const std::vector<BatchRatios>& sums,
                                                                       std::uint64_t walks) {
        const BatchRatios& flux = sums[all_flux];
        const Estimate total = flux.estimate(0, walks);
        double spread = 0, within = 0;
        for (std::size_t slot = first; slot <= last; ++slot) {
            const Estimate bin = flux.estimate(slot, walks);
            spread += bin.standard_error;
            within += bin.mean;
        }
        return total.standard_error <= error * total.mean && spread <= error * within;
    };
}

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
    const std::size_t strip = options.strip_edges_mm.empty() ? 0 : options.strip_edges_mm.size() - 1;
    tally.strip.assign(strip, 0.0);
    tally.strip_standard_error.assign(strip, 0.0);
    return tally;
}

std::vector<double> scaled(std::vector<double> edges, double sigma_t) {
    for (double& edge : edges) edge *= sigma_t;
    return edges;
}

}  // namespace

void checkHalfSpaceProblem(const HalfSpaceProblem& problem) { check(problem); }

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
    const bool cells = options.grid > 0 || !options.strip_edges_mm.empty();
    const bool pencil = problem.beam.kind == BeamShape::pencil;
    result.estimator = cells || !pencil || options.gl ? Estimator::analogue : options.estimator;
    if (problem.sigma_s == 0 || beam.specular == 1) {
        result.all = result.single = result.multiple = emptyTally(options);
        return result;
    }

    const double sigma_t = problem.sigma_a + problem.sigma_s;
    const HalfSpaceWalk walk{.absorbed = problem.sigma_a / sigma_t,
                             .g = problem.g,
                             .eta = problem.eta,
                             .sin_beam = beam.sine,
                             .cos_beam = beam.cosine,
                             .shape = {problem.beam.kind, problem.beam.radius * sigma_t},
                             .cos_incidence = std::cos(problem.angle_deg * (std::numbers::pi / 180))};
    const std::vector<double> edges = scaled(options.edges_mm, sigma_t);
    const TallyLayout layout{RadialBins(edges), static_cast<std::size_t>(options.grid),
                             options.grid_extent_mm * sigma_t, scaled(options.strip_edges_mm, sigma_t),
                             options.strip_half_width_mm * sigma_t};
    std::optional<BestPlan> best;
    if (result.estimator == Estimator::best) best.emplace(walk, edges, tuningFor(walk));
    ChunkedWalk job;
    job.plan = planChunks(options.walks, options.control.until_error > 0);
    job.plan = job.plan.goingOn(options.control.state);
    job.threads = options.threads;
    job.enough = enoughFor(options.control.until_error, layout);
    job.control = options.control;
    std::optional<HalfSpaceGl> device;
    if (options.gl) {
        device.emplace(*options.gl, walk, options.seed, job.plan, options.control);
        job.threads = result.threads = 1;
        result.instruction_set = device->device();
    }
    const auto walkOne = [&](std::uint64_t chunk, std::uint64_t walks, ExitTally& tally) {
        if (device) return device->walkChunk(chunk, tally);
        return best ? walkBestChunk(*best, options.seed, chunk, walks, tally)
                    : walkHalfSpaceChunk(walk, options.seed, chunk, walks, tally);
    };
    const ChunkedResult walked = walkChunks(job, emptySums(layout), ExitTally(layout), walkOne, addChunk, observer);
    result.seconds = walked.seconds;
    result.walks = walked.walks;
    result.collisions = walked.collisions;
    result.interrupted = walked.interrupted;
    std::optional<double> reach;
    if (best && walked.walks > 0) reach = best->reach(walked.walks);
    Reduction(problem, options, layout, 1 - beam.specular).finish(walked.sums, walked.walks, reach, result);
    return result;
}

}  // namespace searchlight
