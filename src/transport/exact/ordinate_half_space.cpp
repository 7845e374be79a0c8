#include "transport/exact/ordinate_half_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/parallel.h"
#include "transport/exact/ordinate_slab.h"
#include "transport/exact/ordinates.h"
#include "transport/walk/fresnel.h"

namespace searchlight {

namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

// Beyond these the two numbers of directions differ by more than some 1e-3.
constexpr double kLargestG = 0.5, kLargestEta = 2, kLargestAlbedo = 0.99999;
// Reduced mean free paths.
constexpr double kSmallestRadius = 0.02;
constexpr double kTilt = pi / 4, kStep = 0.2;  // of the contour, as in exact_half_space.cpp
constexpr double kDecay = 14;                  // exponent at the end of the contour, at the smallest radius
constexpr OrdinateCount kFine{4, 6, 12, 10, 48}, kFineMatched{0, 8, 12, 10, 48};
constexpr OrdinateCount kCoarse{3, 5, 10, 8, 36}, kCoarseMatched{0, 6, 10, 8, 36};
// The coarser directions say what the finer ones are worth: their difference, times this.
constexpr double kSafety = 2;

// Depth by depth in closed form; what is left is an integral over the angle of the way back,
// a 2 pi p(-mu) T(mu) cos d(angle) exp(-r (1 + cos) / sin), [Habel2013] section 5 with the unreduced phase function.
std::vector<HankelSolution::Single> singleNodes(const OrdinateMedium& medium, double entered) {
    std::vector<HankelSolution::Single> nodes;
    const double critical = std::acos(criticalCosine(medium.eta));
    // Doubly exponential towards both ends: 0, where small radii come from, and the root at the critical angle.
    constexpr double step = 1.0 / 32;
    for (int i = -128; i <= 128; ++i) {
        const double t = i * step, inner = 0.5 * pi * std::sinh(t), part = 1 / (1 + std::exp(-2 * inner));
        const double angle = critical * part, cosine = std::cos(angle), sine = std::sin(angle);
        if (!(sine > 0) || part >= 1) continue;
        const double width = critical * step * 0.5 * pi * std::cosh(t) * 2 * part / (1 + std::exp(2 * inner));
        const double d = 1 + medium.g * medium.g + 2 * medium.g * cosine;
        const double phase = 0.5 * (1 - medium.g * medium.g) / (d * std::sqrt(d));
        const double transmitted = medium.eta == 1 ? 1 : 1 - internalReflectance(medium.eta, cosine);
        nodes.push_back({(1 + cosine) / sine, entered * medium.albedo * phase * transmitted * cosine * width});
    }
    return nodes;
}

// What the half-space's own solver does not take may be a slab of one layer.
SlabProblem slabOf(const HalfSpaceProblem& problem) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return {
        1, 1, {{problem.eta, problem.sigma_a, problem.sigma_s, problem.g, infinity}}, problem.angle_deg, problem.beam};
}

Estimate operator-(const Estimate& a, const Estimate& b) {
    return {a.mean - b.mean, a.standard_error + b.standard_error};
}

HalfSpaceResult solveAsSlab(const HalfSpaceProblem& problem, const std::vector<double>& edges_mm, int threads,
                            Observer& observer) {
    const SlabProblem slab = slabOf(problem);
    SlabOptions options;
    options.edges_mm = edges_mm;
    options.threads = threads;
    const SlabResult all = solveSlab(slab, options, observer);
    HankelSolution once;
    once.sigma_t = problem.sigma_a + problem.sigma_s;
    once.single = singleNodes({problem.sigma_s / once.sigma_t, problem.g, problem.eta}, 1 - all.specular);
    once.single_error = 1e-9;
    HalfSpaceResult result = tallyExact(ExactHalfSpace(std::move(once)), edges_mm);
    const HalfSpaceTally& single = result.single;
    result.all.total = all.R;
    result.multiple.total = all.R - single.total;
    result.all.Rd = all.R_r.mean;
    result.all.standard_error = all.R_r.standard_error;
    double within = 0;
    for (std::size_t i = 0; i < all.R_r.mean.size(); ++i) {
        const Estimate more =
            Estimate{all.R_r.mean[i], all.R_r.standard_error[i]} - Estimate{single.Rd[i], single.standard_error[i]};
        result.multiple.Rd[i] = more.mean;
        result.multiple.standard_error[i] = more.standard_error;
        within += all.R_r.mean[i] * std::numbers::pi * (edges_mm[i + 1] * edges_mm[i + 1] - edges_mm[i] * edges_mm[i]);
    }
    result.all.beyond = {all.R.mean - within};
    result.multiple.beyond = {result.all.beyond[0] - single.beyond[0]};
    result.all.mean_r2_mm2 = slabMeanR2(slab);
    const auto moment = [](const HalfSpaceTally& of) {
        return Estimate{of.mean_r2_mm2.mean * of.total.mean, of.mean_r2_mm2.standard_error * of.total.mean};
    };
    const Estimate more = moment(result.all) - moment(single);
    const double flux = result.multiple.total.mean;
    result.multiple.mean_r2_mm2 = {more.mean / flux, more.standard_error / flux};
    return result;
}

}  // namespace

std::string whyNotExactHalfSpace(const HalfSpaceProblem& problem) {
    const std::string reason = whyNotOrdinates(problem);
    if (reason.empty() || whyNotExact(problem).empty()) return {};
    return problem.sigma_s > 0 ? whyNotOrdinateSlab(slabOf(problem)) : reason;
}

std::string whyNotOrdinates(const HalfSpaceProblem& problem) {
    const double sigma_t = problem.sigma_a + problem.sigma_s;
    if (problem.angle_deg != 0) return fmt::format("the beam is oblique, {} deg", problem.angle_deg);
    if (problem.beam.kind != BeamShape::pencil) return "the beam is wide";
    if (!(std::abs(problem.g) <= kLargestG))
        return fmt::format("|g| {} is above {}: scattering is narrower than the directions", std::abs(problem.g),
                           kLargestG);
    if (!(problem.eta >= 0.7 && problem.eta <= kLargestEta))
        return fmt::format("eta {} is outside 0.7 to {}", problem.eta, kLargestEta);
    if (!(problem.sigma_s > 0)) return "nothing scatters";
    if (!(problem.sigma_s / sigma_t <= kLargestAlbedo))
        return fmt::format("the albedo {} is above {}", problem.sigma_s / sigma_t, kLargestAlbedo);
    return {};
}

ExactHalfSpace solveOrdinates(const HalfSpaceProblem& problem, int threads, Observer& observer) {
    checkHalfSpaceProblem(problem);
    if (const std::string reason = whyNotOrdinates(problem); !reason.empty())
        throw inputError("no exact solution: " + reason,
                         fmt::format("normal incidence, |g| up to {}, eta 0.7 to {}, albedo up to {}; or walk it",
                                     kLargestG, kLargestEta, kLargestAlbedo));
    HankelSolution solution;
    solution.sigma_t = problem.sigma_a + problem.sigma_s;
    const OrdinateMedium medium{problem.sigma_s / solution.sigma_t, problem.g, problem.eta};
    const double entered = 1 - enteringBeam(problem.eta, 0).specular;
    const bool splits = medium.eta > 1;
    const OrdinateCount &fine = splits ? kFine : kFineMatched, &coarse = splits ? kCoarse : kCoarseMatched;

    const double reduced = 1 - medium.albedo * medium.g, slowest = diffusionRate(medium);
    solution.smallest_radius = kSmallestRadius / reduced;
    const double fastest = kDecay / (solution.smallest_radius * std::cos(kTilt));
    const auto count = static_cast<std::size_t>(std::log(2 * fastest / slowest) / kStep) + 2;
    // One more: the total, at k = 0.
    struct Node {
        Complex rate, value, doubt;
    };
    std::vector<Node> nodes(count + 1);
    std::atomic<std::uint64_t> done = 0;
    parallelFor(nodes.size(), threads, [&](std::size_t i) {
        if (observer.cancelled()) return;
        Node& node = nodes[i];
        node.rate = i == count ? 0 : slowest * std::cosh(Complex(static_cast<double>(i) * kStep, -kTilt));
        node.value = ordinateTransform(medium, fine, node.rate);
        node.doubt = kSafety * (node.value - ordinateTransform(medium, coarse, node.rate));
        observer.progress("solve", ++done, nodes.size(), "frequencies");
    });
    if (observer.cancelled()) throw interruptedError();

    const Node& total = nodes.back();
    solution.multiple_total = entered * total.value.real();
    solution.multiple_total_error = entered * std::abs(total.doubt);
    solution.ends_early = true;
    solution.contour_error = 1000 * std::exp(-2 * pi * (0.5 * pi - kTilt) / kStep);
    for (std::size_t i = 0; i < count; ++i) {
        const Complex change = slowest * std::sinh(Complex(static_cast<double>(i) * kStep, -kTilt));
        const Complex weight = (i == 0 ? 0.5 : 1.0) * kStep * entered * change;
        solution.contour.push_back({nodes[i].rate, weight * nodes[i].value, weight * nodes[i].doubt});
    }
    solution.single = singleNodes(medium, entered);
    solution.single_error = 1e-9;
    return ExactHalfSpace(std::move(solution));
}

HalfSpaceResult solveAnyHalfSpace(const HalfSpaceProblem& problem, const std::vector<double>& edges_mm, int threads,
                                  Observer& observer) {
    if (whyNotExact(problem).empty()) return solveHalfSpace(problem, edges_mm);
    checkHalfSpaceProblem(problem);
    const bool as_slab = !whyNotOrdinates(problem).empty() && whyNotExactHalfSpace(problem).empty();
    const double smallest = kSmallestRadius / (problem.sigma_a + (1 - problem.g) * problem.sigma_s);
    for (const double edge : edges_mm)
        if (!as_slab && edge > 0 && edge < smallest * (1 - 1e-9))
            throw inputError(
                fmt::format("the exact profile is asked for at {} mm", edge),
                fmt::format("edges of 0, or of {:.4g} mm (0.02 reduced mean free paths) and more", smallest));
    const auto start = std::chrono::steady_clock::now();
    HalfSpaceResult result = as_slab ? solveAsSlab(problem, edges_mm, threads, observer)
                                     : tallyExact(solveOrdinates(problem, threads, observer), edges_mm);
    result.specular = enteringBeam(problem.eta, 0).specular;
    result.threads = threads > 0 ? threads : hardwareThreads();
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace searchlight
