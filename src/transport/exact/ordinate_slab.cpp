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
#include <numbers>

#include "base/error.h"
#include "base/parallel.h"
#include "transport/exact/exact_half_space.h"
#include "transport/exact/ordinate_stack.h"
#include "transport/exact/ordinates.h"
#include "transport/slab/slab_single.h"
#include "transport/walk/beam.h"

namespace searchlight {

namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

constexpr double kLargestG = 0.9, kLargestRatio = 2, kLargestAlbedo = 0.99999;
// Reduced mean free paths of the layer where they are shortest.
constexpr double kSmallestRadius = 0.05, kLargestRadius = 1000, kReach = 50;
constexpr double kStep = 0.2;  // of u
constexpr StackCount kFine{8, 4, 5, 12, 24, 10, 20}, kCoarse{6, 3, 4, 10, 16, 8, 16};
// Of the line, as parts of the slowest lateral rate and of the least extinction: nearer to these, light that runs
// along the layers decays little and oscillates, which few cosines follow.
constexpr double kShift = 0.7, kLargestShift = 0.3;
constexpr int kTotalCosines = 28;
constexpr double kSafety = 2, kRounding = 1e-9;
// Relative; of a transform that ends where directions are too few, so much is left in doubt of its end.
constexpr double kAgreed = 0.2;

double reduced(const SlabLayer& layer) { return layer.sigma_a + (1 - layer.g) * layer.sigma_s; }

// mm.
double smallestRadius(const SlabProblem& problem) {
    double largest = 0;
    for (const SlabLayer& layer : problem.layers) largest = std::max(largest, reduced(layer));
    return kSmallestRadius / largest;
}

// The stack, smoothed as far as so many cosines follow.
OrdinateStack stackOf(const SlabProblem& problem, const StackCount& count) {
    OrdinateStack stack{problem.n_above, problem.n_below, {}};
    for (const SlabLayer& layer : problem.layers)
        stack.layers.push_back({.n = layer.n, .sigma_t = 1, .thickness = layer.thickness_mm});
    StackCount cosines = count;
    cosines.azimuths = 1;
    const std::vector<LayerRays> rays = stackRays(stack, cosines, 0);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const SlabLayer& layer = problem.layers[i];
        OrdinateStack::Layer& smooth = stack.layers[i];
        smooth.phase = smoothPhase(layer.g, static_cast<int>(2 * rays[i].size()) - 2);
        smooth.sigma_s = layer.sigma_s * (1 - smooth.phase.peak);
        smooth.sigma_t = layer.sigma_a + smooth.sigma_s;
    }
    return stack;
}

// The same as slabSingle() sees it.
SlabWalk straightOf(const SlabProblem& problem, const OrdinateStack& stack) {
    SlabWalk walk;
    for (std::size_t i = 0; i < stack.layers.size(); ++i) {
        const SlabLayer& layer = problem.layers[i];
        const double above = i == 0 ? problem.n_above : problem.layers[i - 1].n;
        const double beyond = i + 1 == stack.layers.size() ? problem.n_below : problem.layers[i + 1].n;
        const double sigma_t = stack.layers[i].sigma_t;
        // The phase function is put back as it is, with its peak, [Nakajima1988].
        walk.layers.push_back({.mfp_mm = 1 / sigma_t,
                               .absorbed = 1 - layer.sigma_s / sigma_t,
                               .g = layer.g,
                               .thickness_mm = layer.thickness_mm,
                               .eta_up = layer.n / above,
                               .eta_down = std::isinf(layer.thickness_mm) ? 1 : layer.n / beyond});
    }
    return walk;
}

SlabUnscattered addBeam(OrdinateStack& stack, const SlabWalk& walk) {
    SlabUnscattered beam = slabUnscattered(walk);
    for (std::size_t i = 0; i < stack.layers.size(); ++i) {
        stack.layers[i].beam_down = beam.down[i];
        stack.layers[i].beam_up = beam.up[i];
    }
    return beam;
}

// A lateral rate below the slowest, as close as some 20 %. Up to the slowest, the transform of what leaves is positive
// and grows.
double slowestRate(const SlabProblem& problem, const OrdinateStack& stack) {
    double least = 1e300, fastest = 1e300, depth = 0;
    for (std::size_t i = 0; i < stack.layers.size(); ++i) {
        const SlabLayer& layer = problem.layers[i];
        const double sigma_t = layer.sigma_a + layer.sigma_s;
        fastest = std::min(fastest, stack.layers[i].sigma_t);
        // An infinite layer, which absorbs, is as deep as light gets there.
        const double own = sigma_t * diffusionRate({layer.sigma_s / sigma_t, layer.g, 1});
        least = std::min(least, own);
        depth += (std::isinf(layer.thickness_mm) ? 1 / own : layer.thickness_mm) + 10 / reduced(layer);
    }
    // Without absorption pi over the depth between the extrapolated surfaces: this is a third of it.
    double rate = std::max(least, 1 / depth), before = 0;
    const StackCount count{.escaping = 4, .alone = 2, .trapped = 3, .azimuths = 6};
    for (double next = rate; next < 0.9 * fastest; next *= 1.2) {
        const double value = stackExitance(stack, count, next).R.real();
        if (!(value > before)) break;
        before = value;
        rate = next;
    }
    return std::min(rate, 0.9 * fastest);
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
    if (problem.angle_deg != 0) return fmt::format("the beam is oblique, {} deg", problem.angle_deg);
    if (problem.beam.kind != BeamShape::pencil) return "the beam is wide";
    double n_min = std::min(problem.n_above, problem.n_below), n_max = std::max(problem.n_above, problem.n_below);
    bool scatters = false;
    for (std::size_t i = 0; i < problem.layers.size(); ++i) {
        const SlabLayer& layer = problem.layers[i];
        const std::string name = fmt::format("layer {}", i + 1);
        n_min = std::min(n_min, layer.n);
        n_max = std::max(n_max, layer.n);
        scatters |= layer.sigma_s > 0;
        if (layer.phase) return name + " has a tabulated phase function";
        if (layer.clear()) return name + " is clear";
        if (layer.thickness_mm == 0) return name + " has no thickness";
        if (!(std::abs(layer.g) <= kLargestG))
            return fmt::format("|g| {} of {} is above {}", std::abs(layer.g), name, kLargestG);
        const double albedo = layer.sigma_s / (layer.sigma_a + layer.sigma_s);
        if (std::isinf(layer.thickness_mm) && !(albedo <= kLargestAlbedo))
            return fmt::format("{} is infinite and its albedo {} is above {}", name, albedo, kLargestAlbedo);
    }
    if (n_max > kLargestRatio * n_min)
        return fmt::format("the refractive indices {} and {} differ by more than a factor of {}", n_min, n_max,
                           kLargestRatio);
    if (!scatters) return "nothing scatters";
    return {};
}

std::string ordinateSlabsCovered() {
    return fmt::format(
        "--exact takes a normal pencil beam on layers that scatter or absorb, |g| up to {}, refractive "
        "indices within a factor of {}, an infinite layer of albedo up to {}; without it the slab is walked",
        kLargestG, kLargestRatio, kLargestAlbedo);
}

SlabResult solveSlabTotals(const SlabProblem& problem) {
    slabLayout(problem, {.edges_mm = {0, 1}, .depth_mm = 1});
    if (const std::string reason = whyNotOrdinateSlab(problem); !reason.empty())
        throw inputError("no exact solution: " + reason, ordinateSlabsCovered());
    // At k = 0 nothing varies with the azimuth, so that directions are few whatever their cosines are.
    struct Level {
        StackTotals totals;
        SlabUnscattered beam;
    };
    const auto at = [&](int cosines) {
        OrdinateStack stack = stackOf(problem, {.escaping = cosines, .alone = 0, .trapped = cosines});
        const SlabUnscattered beam = addBeam(stack, straightOf(problem, stack));
        return Level{stackTotals(stack, cosines), beam};
    };
    const Level fine = at(kTotalCosines), coarse = at(kTotalCosines - 4);
    // What is scattered into the peaks has gone on with the beam there.
    OrdinateStack whole = stackOf(problem, kCoarse);
    for (std::size_t i = 0; i < whole.layers.size(); ++i)
        whole.layers[i].sigma_t = problem.layers[i].sigma_a + problem.layers[i].sigma_s;
    const SlabUnscattered beam = slabUnscattered(straightOf(problem, whole));

    SlabResult result;
    result.specular = enteringBeam(problem.layers.front().n / problem.n_above, 0).specular;
    const double entered = 1 - result.specular;
    const auto estimate = [&](double value, double other) {
        return Estimate{entered * value, entered * kSafety * std::abs(value - other) + kRounding};
    };
    result.R_unscattered = {entered * beam.R};
    result.T_unscattered = {entered * beam.T};
    result.R = estimate(fine.totals.R + fine.beam.R - beam.R, coarse.totals.R + coarse.beam.R - beam.R);
    result.T = estimate(fine.totals.T + fine.beam.T - beam.T, coarse.totals.T + coarse.beam.T - beam.T);
    for (std::size_t i = 0; i < problem.layers.size(); ++i) {
        result.A_layer.push_back(estimate(fine.totals.absorbed[i], coarse.totals.absorbed[i]));
        result.A.mean += result.A_layer.back().mean;
        result.A.standard_error += result.A_layer.back().standard_error;
    }
    return result;
}

SlabResult solveSlab(const SlabProblem& problem, const SlabOptions& options, Observer& observer) {
    SlabOptions tallies = options;
    tallies.depth_mm = 1;
    slabLayout(problem, tallies);
    SlabResult result = solveSlabTotals(problem);
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
    const std::vector<char> all(problem.layers.size(), 1);
    for (Level& level : levels) {
        level.stack = stackOf(problem, *level.count);
        const SlabWalk walk = straightOf(problem, level.stack);
        addBeam(level.stack, walk);
        level.single = slabSingle(walk, edges, all, 0);
    }
    const double slowest = slowestRate(problem, levels[1].stack);
    double shift = kShift * slowest;
    for (const OrdinateStack::Layer& layer : levels[0].stack.layers)
        shift = std::min(shift, kLargestShift * layer.sigma_t);
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

}  // namespace searchlight
