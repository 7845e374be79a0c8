// Where the half-space's contour bends away from the imaginary axis of k, layers of finite depth let discrete
// directions grow as exp(kappa s cos(phi) h / mu). So k runs parallel to the real axis here, k = x + i c, with c below
// the slowest lateral decay: everything decays with depth, and the error falls with r as exp(-c r). The transform is
// smooth in u = asinh(x / w), so that some forty frequencies serve all radii.
#include "transport/exact/ordinate_slab.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/parallel.h"
#include "transport/exact/exact_half_space.h"
#include "transport/exact/ordinate_problem.h"
#include "transport/exact/ordinate_stack.h"
#include "transport/exact/ordinate_totals.h"
#include "transport/exact/ordinates.h"

namespace searchlight {

namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

// Reduced mean free paths of the layer where they are shortest.
constexpr double kSmallestRadius = 0.05, kLargestRadius = 1000, kReach = 50;
constexpr double kStep = 0.2;  // of u
constexpr StackCount kFine{8, 4, 5, 3, 12, 24, 10, 20}, kCoarse{6, 3, 4, 2, 10, 16, 8, 16};
// Of the line, as parts of the slowest lateral rate and of the least extinction: nearer to these, light that runs
// along the layers decays little and oscillates, which few cosines follow.
constexpr double kShift = 0.7, kLargestShift = 0.3;
// How far light may run along a clear layer, in reduced mean free paths as above: beyond, few directions do not tell
// where it comes out again.
constexpr double kFarthest = 3;
constexpr double kSafety = 2;
constexpr double kCurvature = 0.03;  // of the slowest rate: 1e-5 of <r^2> are left
// Relative; of a transform that ends where directions are too few, so much is left in doubt of its end.
constexpr double kAgreed = 0.2;

double reduced(const SlabLayer& layer) { return layer.sigma_a + (1 - layer.g) * layer.sigma_s; }

// mm.
double smallestRadius(const SlabProblem& problem) {
    double largest = 0;
    for (const SlabLayer& layer : problem.layers) largest = std::max(largest, reduced(layer));
    return kSmallestRadius / largest;
}

// A lateral rate below the slowest, as close as some 20 %. Up to the slowest, the transform of what leaves is positive
// and grows.
double slowestRate(const SlabProblem& problem, const OrdinateStack& stack) {
    double least = 1e300, fastest = 1e300, depth = 0;
    bool clear = false;
    for (std::size_t i = 0; i < stack.layers.size(); ++i) {
        const SlabLayer& layer = problem.layers[i];
        if (layer.clear()) {
            clear = true;
            depth += layer.thickness_mm;
            continue;
        }
        const double sigma_t = layer.sigma_a + layer.sigma_s;
        fastest = std::min(fastest, stack.layers[i].sigma_t);
        // An infinite layer, which absorbs, is as deep as light gets there.
        const double own = sigma_t * diffusionRate({layer.sigma_s / sigma_t, layer.g, 1});
        least = std::min(least, own);
        depth += (std::isinf(layer.thickness_mm) ? 1 / own : layer.thickness_mm) + 10 / reduced(layer);
    }
    // Without absorption pi over the depth between the extrapolated surfaces: this is a third of it.
    double rate = std::max(least, 1 / depth), before = 0;
    // Along clear layers there are no discrete directions that such light takes: a scale is all that is needed.
    if (clear) return std::min(rate, 0.9 * fastest);
    const StackCount count{.escaping = 4, .alone = 2, .trapped = 3, .azimuths = 6};
    for (double next = rate; next < 0.9 * fastest; next *= 1.2) {
        const double value = stackExitance(stack, count, next).R.real();
        if (!(value > before)) break;
        before = value;
        rate = next;
    }
    return std::min(rate, 0.9 * fastest);
}

// The steepest light in a clear layer, as a tangent: infinite unless its index is above those of layers that scatter.
double steepest(const SlabLayer& clear, const SlabProblem& problem) {
    double highest = 0;
    for (const SlabLayer& layer : problem.layers)
        if (layer.sigma_s > 0) highest = std::max(highest, layer.n);
    if (clear.n <= highest) return std::numeric_limits<double>::infinity();
    return highest / std::sqrt((clear.n - highest) * (clear.n + highest));
}

// How far to the right the line may lie: layers make up for what grows along the wave, and light does not go far in
// clear ones.
double largestShift(const SlabProblem& problem, const OrdinateStack& stack) {
    double shift = 1e300;
    for (std::size_t i = 0; i < problem.layers.size(); ++i) {
        const SlabLayer& layer = problem.layers[i];
        const double reach =
            layer.clear() ? layer.thickness_mm * steepest(layer, problem) : 1 / stack.layers[i].sigma_t;
        shift = std::min(shift, kLargestShift / reach);
    }
    return shift;
}

// Both transforms, sampled along the line.
struct Line {
    double shift = 0, width = 0;  // rate = shift - i width sinh(u)
    std::vector<StackFlux> samples;

    Complex rate(double u) const { return {shift, -width * std::sinh(u)}; }

    // 12-point Lagrange interpolation; on the other side of 0 is the conjugate.
    Complex at(double u, Complex StackFlux::*member) const {
        constexpr int points = 12;
        const int count = static_cast<int>(samples.size());
        const int first = std::min(static_cast<int>(std::floor(u / kStep)) - points / 2 + 1, count - points);
        const double x = u / kStep - first;
        Complex sum = 0;
        for (int i = 0; i < points; ++i) {
            double weight = 1;
            for (int j = 0; j < points; ++j)
                if (j != i) weight *= (x - j) / (i - j);
            const int at = first + i;
            const Complex sample = samples[static_cast<std::size_t>(std::abs(at))].*member;
            sum += weight * (at < 0 ? std::conj(sample) : sample);
        }
        return sum;
    }
};

// The contour for radii from the smallest to r_max: the line, panel by panel, and beyond its end a power of the rate,
// on a ray that turns to where waves decay.
std::vector<HankelSolution::Node> contourOf(const Line& line, Complex StackFlux::*member, std::size_t samples,
                                            double smallest, double r_max, bool tail) {
    std::vector<HankelSolution::Node> contour;
    const GaussRule rule = gaussRule(16);
    const double end = kStep * static_cast<double>(samples - 1), last = -line.rate(end).imag();
    for (double x = 0; x < last;) {
        const double next = std::min(last, x + std::min(0.5 * std::hypot(line.width, x), 16 / r_max));
        for (std::size_t i = 0; i < rule.x.size(); ++i) {
            const double at = x + (next - x) * rule.x[i];
            const Complex value = line.at(std::asinh(at / line.width), member);
            contour.push_back({{line.shift, -at}, Complex(0, -(next - x) * rule.weight[i]) * value});
        }
        x = next;
    }
    if (!tail) return contour;
    const Complex corner = line.rate(end), value = line.samples[samples - 1].*member,
                  before = line.samples[samples - 2].*member;
    if (value == 0.0) return contour;
    const double power = std::clamp(std::log(std::abs(before / value)) / kStep, 2.0, 8.0);
    const Complex turn = std::polar(1.0, -pi / 4);
    double from = 0;
    for (double to = 0.25 * last; from * smallest < 60; to *= 1.5) {
        for (std::size_t i = 0; i < rule.x.size(); ++i) {
            const Complex rate = corner + turn * (from + (to - from) * rule.x[i]);
            contour.push_back({rate, turn * (to - from) * rule.weight[i] * value * std::pow(corner / rate, power)});
        }
        from = to;
    }
    return contour;
}

// How many samples two numbers of directions agree about. Beyond, few directions do not cancel each other as all would.
std::size_t agreed(const Line& fine, const Line& coarse, Complex StackFlux::*member) {
    std::size_t count = 2;
    while (count < fine.samples.size()) {
        const Complex value = fine.samples[count].*member, other = coarse.samples[count].*member;
        if (!(std::abs(value - other) <= kAgreed * std::abs(value))) break;
        ++count;
    }
    return count;
}

// Flux beyond each edge but for what is scattered once.
std::vector<double> beyondEdges(std::vector<HankelSolution::Node> contour, const std::vector<double>& edges) {
    HankelSolution solution;
    solution.ends_early = true;
    solution.contour = std::move(contour);
    const ExactHalfSpace exact(std::move(solution));
    std::vector<double> beyond;
    for (const double edge : edges) beyond.push_back(edge > 0 ? exact.beyond(edge).multiple.mean : 0);
    return beyond;
}

// One side of the slab, solved with two numbers of directions. total: of what is scattered, per flux that entered.
struct Side {
    const Line *fine, *coarse;
    Complex StackFlux::*member;
    const std::vector<double>*fine_single, *coarse_single;
    double total;
};

SlabSeries seriesOf(const Side& side, const std::vector<double>& edges, double smallest, double entered) {
    const std::size_t samples = agreed(*side.fine, *side.coarse, side.member);
    const auto solve = [&](const Line& line, const std::vector<double>& single, bool tail) {
        std::vector<double> beyond =
            beyondEdges(contourOf(line, side.member, samples, smallest, edges.back(), tail), edges);
        double straight = 0;
        for (std::size_t i = edges.size(); i-- > 0;) {
            straight += single[i + 1];
            beyond[i] = edges[i] > 0 ? beyond[i] + straight : side.total;
        }
        std::vector<double> flux;
        for (std::size_t i = 0; i + 1 < edges.size(); ++i) flux.push_back(beyond[i] - beyond[i + 1]);
        return flux;
    };
    const std::vector<double> fine = solve(*side.fine, *side.fine_single, true),
                              coarse = solve(*side.coarse, *side.coarse_single, true),
                              cut = solve(*side.fine, *side.fine_single, false);
    SlabSeries series;
    for (std::size_t i = 0; i < fine.size(); ++i) {
        // Differences change their sign, which does not make them small.
        double relative = 0;
        for (std::size_t j = i > 0 ? i - 1 : 0; j < std::min(i + 2, fine.size()); ++j)
            if (fine[j] != 0) relative = std::max(relative, std::abs(coarse[j] / fine[j] - 1));
        const double per_area = entered / (pi * (edges[i + 1] - edges[i]) * (edges[i + 1] + edges[i]));
        series.mean.push_back(fine[i] * per_area);
        series.standard_error.push_back(
            kSafety * (relative * std::abs(fine[i]) + kAgreed * std::abs(fine[i] - cut[i])) * per_area);
    }
    return series;
}

}  // namespace

std::string whyNotOrdinateSlab(const SlabProblem& problem) {
    if (const std::string reason = whyNotOrdinateTotals(problem); !reason.empty()) return reason;
    if (problem.angle_deg != 0) return fmt::format("the beam is oblique, {} deg", problem.angle_deg);
    if (problem.beam.kind != BeamShape::pencil) return "the beam is wide";
    const auto scatters = [](const SlabLayer& layer) { return layer.sigma_s > 0; };
    if (std::ranges::none_of(problem.layers, scatters)) return "nothing scatters";
    for (std::size_t i = 0; i < problem.layers.size(); ++i)
        if (const SlabLayer& layer = problem.layers[i]; layer.clear()) {
            const double reach = layer.thickness_mm * steepest(layer, problem);
            if (!(reach <= kFarthest * smallestRadius(problem) / kSmallestRadius))
                return std::isinf(reach)
                           ? fmt::format(
                                 "layer {} is clear and of no higher index than what scatters: light runs along it",
                                 i + 1)
                           : fmt::format("light runs up to {:.3g} mm along layer {}, which is clear", reach, i + 1);
        }
    return {};
}

std::string ordinateSlabsCovered() {
    return fmt::format(
        "--exact takes Henyey-Greenstein layers, |g| up to {}, refractive indices within a factor of {}, an infinite "
        "layer of albedo up to {}, and for R(r) and T(r) a normal pencil beam; without it the slab is walked",
        kOrdinateLargestG, kOrdinateLargestRatio, kOrdinateLargestAlbedo);
}

SlabResult solveSlab(const SlabProblem& problem, const SlabOptions& options, Observer& observer) {
    SlabOptions tallies = options;
    tallies.depth_mm = 1;
    slabLayout(problem, tallies);
    if (const std::string reason = whyNotOrdinateSlab(problem); !reason.empty())
        throw inputError("no exact profile: " + reason, ordinateSlabsCovered());
    SlabResult result = solveSlabTotals(problem, options.angles);
    const std::vector<double>& edges = options.edges_mm;
    const double smallest = smallestRadius(problem), largest = smallest / kSmallestRadius * kLargestRadius;
    for (const double edge : edges)
        if (edge > 0 && !(edge >= smallest * (1 - 1e-9) && edge <= largest * (1 + 1e-9)))
            throw inputError(fmt::format("the exact profile is asked for at {} mm", edge),
                             fmt::format("edges of 0, or of {:.4g} to {:.4g} mm: {} to {} reduced mean free paths of "
                                         "the layer where they are shortest",
                                         smallest, largest, kSmallestRadius, kLargestRadius));
    const auto start = std::chrono::steady_clock::now();

    struct Level {
        const StackCount* count;
        OrdinateStack stack;
        SlabSingle single;
        Line line;
    };
    Level levels[2] = {{&kFine, {}, {}, {}}, {&kCoarse, {}, {}, {}}};
    std::vector<char> scatters;
    for (const SlabLayer& layer : problem.layers) scatters.push_back(layer.sigma_s > 0);
    for (Level& level : levels) {
        level.stack = ordinateStack(problem, *level.count);
        const SlabWalk walk = straightWalk(problem, level.stack);
        addBeam(level.stack, walk);
        level.single = slabSingle(walk, edges, scatters, 0);
    }
    const double slowest = slowestRate(problem, levels[1].stack);
    const double shift = std::min(kShift * slowest, largestShift(problem, levels[0].stack));
    const double width = slowest - shift, last = kReach * kSmallestRadius / smallest;
    const auto count = static_cast<std::size_t>(std::asinh(last / width) / kStep) + 2;
    for (Level& level : levels) level.line = {shift, width, std::vector<StackFlux>(count)};
    std::atomic<std::uint64_t> done = 0;
    parallelFor(2 * count, options.threads, [&](std::size_t i) {
        if (observer.cancelled()) return;
        Level& level = levels[i % 2];
        level.line.samples[i / 2] =
            stackTransform(level.stack, *level.count, level.line.rate(static_cast<double>(i / 2) * kStep));
        observer.progress("solve", ++done, 2 * count, "frequencies");
    });
    if (observer.cancelled()) throw interruptedError();

    const double entered = 1 - result.specular;
    const auto side = [&](Complex StackFlux::*member, std::vector<double> SlabSingle::*single, const Estimate& total) {
        return seriesOf({&levels[0].line, &levels[1].line, member, &(levels[0].single.*single),
                         &(levels[1].single.*single), total.mean / entered},
                        edges, smallest, entered);
    };
    result.R_r = side(&StackFlux::R, &SlabSingle::reflected, result.R);
    if (std::isinf(problem.layers.back().thickness_mm))
        result.T_r = {std::vector<double>(edges.size() - 1), std::vector<double>(edges.size() - 1)};
    else
        result.T_r = side(&StackFlux::T, &SlabSingle::transmitted, result.T);
    result.threads = options.threads > 0 ? options.threads : hardwareThreads();
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

Estimate slabMeanR2(const SlabProblem& problem) {
    const auto solve = [&](const StackCount& count) {
        OrdinateStack stack = ordinateStack(problem, count);
        addBeam(stack, straightWalk(problem, stack));
        // The transform is R (1 + rate^2 <r^2> / 4 + rate^4 <r^4> / 64 + ...).
        const double rate = kCurvature * slowestRate(problem, stack), R = stackExitance(stack, count, 0).R.real();
        const auto curvature = [&](double at) {
            return 4 * (stackExitance(stack, count, at).R.real() / R - 1) / (at * at);
        };
        return (4 * curvature(rate) - curvature(2 * rate)) / 3;
    };
    const double fine = solve(kFine);
    return {fine, kSafety * std::abs(fine - solve(kCoarse))};
}

}  // namespace searchlight
