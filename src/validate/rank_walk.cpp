#include "validate/rank_walk.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "transport/exact/exact_half_space.h"
#include "transport/walk/radial_edges.h"

namespace searchlight {

namespace {

// Measured on seven materials: a collision of the best estimator takes 2 to 8 times the time of the analogue walk's.
constexpr double best_collision = 4;
// Enough for errors that are good to a third; a few ms, but for media that hardly absorb.
constexpr std::uint64_t analogue_trial = 16'384, best_trial = 4'096;

enum class Wanted { profile, shift };

// Relative: the noise of the profile as CurveError has it, or the standard error of mean x.
double noiseOf(const HalfSpaceResult& walked, const std::vector<double>& edges, Wanted wanted) {
    const HalfSpaceTally& all = walked.all;
    if (wanted == Wanted::shift) return all.mean_x_mm.standard_error / std::abs(all.mean_x_mm.mean);
    double noise = 0, light = 0;
    for (std::size_t i = 0; i < all.Rd.size(); ++i) {
        const double area = (edges[i + 1] - edges[i]) * (edges[i + 1] + edges[i]);
        noise += std::sqrt(2 / std::numbers::pi) * all.standard_error[i] * area;
        light += all.Rd[i] * area;
    }
    return noise / light;
}

double costOf(const HalfSpaceResult& walked) {
    return static_cast<double>(walked.collisions) * (walked.estimator == Estimator::best ? best_collision : 1);
}

// Channels and angles must not share random numbers. Odd constant of [Steele2014].
std::uint64_t streamSeed(std::uint64_t seed, int stream) {
    return seed + static_cast<std::uint64_t>(stream) * 0x9e3779b97f4a7c15u;
}

// Two trials of other random numbers, then the walks of the cheaper estimator: as many as the noise needs, or as the
// collisions allow.
HalfSpaceResult walkTo(const HalfSpaceProblem& problem, const std::vector<double>& edges, Wanted wanted, double noise,
                       double collisions, std::uint64_t seed, int threads, Observer& observer) {
    HalfSpaceOptions options;
    options.edges_mm = edges;
    options.threads = threads;
    options.seed = ~seed;
    double least = INFINITY, found = 0, cost_of_walk = 1;
    Observer silent;
    for (const Estimator estimator : {Estimator::best, Estimator::analogue}) {
        if (observer.cancelled()) throw interruptedError();
        HalfSpaceOptions trial = options;
        trial.estimator = estimator;
        trial.walks = estimator == Estimator::best ? best_trial : analogue_trial;
        const HalfSpaceResult walked = walkHalfSpace(problem, trial, silent);
        const double error = noiseOf(walked, edges, wanted), cost = std::max(costOf(walked), 1.0);
        // Few exits say nothing about their scatter: then NaN or chance, and the other estimator is as good.
        if (!(error * error * cost < least)) continue;
        least = error * error * cost;
        options.estimator = estimator;
        cost_of_walk = cost / static_cast<double>(walked.walks);
        found = error * std::sqrt(static_cast<double>(walked.walks));
    }
    const double needed = std::pow(found / noise, 2), allowed = collisions / cost_of_walk;
    options.walks = static_cast<std::uint64_t>(std::max<double>(best_trial, std::min(needed, allowed)));
    options.seed = seed;
    return walkHalfSpace(problem, options, observer);
}

// Of the square in which R_d(x, y) is compared: a third of a mean free path each.
constexpr int plane_cells = 24;
constexpr double plane_extent = 4;  // half the side, in transport mean free paths
constexpr double worst_plane_noise = 0.25;

// The analogue walk with its grid, folded at the plane of incidence. Counts are Poisson numbers, so exits, of which the
// walks of the shift know the part, tell how many walks the noise needs.
void walkPlane(const HalfSpaceProblem& problem, const RankEffort& effort, std::uint64_t seed, Observer& observer,
               RankWalks& walks) {
    RankReference& reference = walks.reference;
    const double extent = plane_extent * reference.split_mm;
    HalfSpaceOptions options;
    options.walks = analogue_trial;
    options.seed = ~seed;
    options.estimator = Estimator::analogue;
    options.threads = effort.threads;
    options.edges_mm = {0, extent};
    Observer silent;
    const double collisions = std::max(costOf(walkHalfSpace(problem, options, silent)), 1.0) / analogue_trial;
    constexpr double cells = 0.5 * plane_cells * plane_cells;
    const double exits = 2 / std::numbers::pi * cells / (effort.plane_noise * effort.plane_noise);
    const double needed = exits / walks.oblique.all.total.mean, allowed = 0.5 * effort.collisions / collisions;
    // Written so that infinity and NaN, where nothing was seen to leave, are too much.
    if (!(effort.plane_noise * std::sqrt(needed / allowed) <= worst_plane_noise)) return;
    options.walks = static_cast<std::uint64_t>(std::max<double>(analogue_trial, std::min(needed, allowed)));
    options.seed = seed;
    options.grid = plane_cells;
    options.grid_extent_mm = extent;
    walks.plane = walkHalfSpace(problem, options, observer);
    reference.cells = plane_cells;
    reference.cell_mm = 2 * extent / plane_cells;
    const std::vector<double>&grid = walks.plane.all.grid, &error = walks.plane.all.grid_standard_error;
    for (std::size_t y = 0; y < plane_cells / 2; ++y)
        for (std::size_t x = 0; x < plane_cells; ++x) {
            const std::size_t above = (plane_cells / 2 + y) * plane_cells + x;
            const std::size_t below = (plane_cells / 2 - 1 - y) * plane_cells + x;
            reference.plane.push_back(0.5 * (grid[above] + grid[below]));
            reference.plane_error.push_back(0.5 * std::hypot(error[above], error[below]));
        }
}

}  // namespace

std::vector<double> rankEdges(const HalfSpaceProblem& problem, int bins) {
    std::vector<double> edges = defaultEdges(problem, bins);
    const double split = 1 / (problem.sigma_a + (1 - problem.g) * problem.sigma_s);
    const auto after = std::lower_bound(edges.begin(), edges.end(), split);
    if (after != edges.end() && *after != split) edges.insert(after, split);
    return edges;
}

RankWalks walkForRank(const Medium& medium, int channel, const RankEffort& effort, Observer& observer) {
    const HalfSpaceProblem problem = halfSpaceProblem(medium, channel);
    const std::vector<double> edges = rankEdges(problem, effort.bins);
    RankWalks walks;
    walks.exact = whyNotExact(problem).empty();
    walks.normal = walks.exact ? solveHalfSpace(problem, edges)
                               : walkTo(problem, edges, Wanted::profile, effort.noise, effort.collisions,
                                        streamSeed(effort.seed, channel), effort.threads, observer);
    walks.oblique =
        walkTo(halfSpaceProblem(medium, channel, effort.angle_deg), edges, Wanted::shift, effort.shift_noise,
               effort.collisions / 2, streamSeed(effort.seed, Rgb::channels + channel), effort.threads, observer);
    RankReference& reference = walks.reference;
    reference.channel = channel;
    reference.edges_mm = edges;
    reference.Rd.resize(edges.size() - 1);
    reference.standard_error.resize(edges.size() - 1);
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        reference.Rd[i][channel] = walks.normal.all.Rd[i];
        reference.standard_error[i][channel] = walks.normal.all.standard_error[i];
    }
    reference.total = walks.normal.all.total;
    reference.split_mm = 1 / medium.sigmaTp()[channel];
    reference.mean_x_mm = walks.oblique.all.mean_x_mm;
    walkPlane(halfSpaceProblem(medium, channel, effort.angle_deg), effort,
              streamSeed(effort.seed, 2 * Rgb::channels + channel), observer, walks);
    return walks;
}

}  // namespace searchlight
