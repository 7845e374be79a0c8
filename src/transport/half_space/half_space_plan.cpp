// What the best estimator decides before it walks: its tables, and how its time is divided between the walks that
// foresee where light leaves and the guided walks that give totals and moments.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "transport/half_space/half_space_best.h"

namespace searchlight {

namespace {

// Beyond, a sharp phase function makes few, heavy deposits, and what crosses the surface says more: at g = .8 by a
// tenth, at .9 by a factor of nine.
constexpr double kMostForesight = 0.7;

// The pilot has numbers of its own, the same for every seed.
constexpr std::uint64_t kPilotSeed = 0x70696C6F74, kGuidedStream = 0x677569646564;
constexpr std::uint64_t kPilotChunks = 16, kPilotWalks = 128, kPilotGuided = 256;
constexpr double kStepTime = 4.5, kForwardStepTime = 5.3, kCrossingStepTime = 3.5, kGuidedStart = 28;  // ns
constexpr double kGuidedStepTime = 3.5, kGuidedIsotropicStepTime = 2;

// The part of the time for guided walks, so that no moment is worse known than by the analogue walk; with absorption
// guided walks are short.
constexpr double kPart = 0.08, kForwardPart = 0.25, kAbsorbingPart = 0.12, kAnisotropicPart = 0.35;
constexpr double kLeastMixed = 0.1;  // 1 - albedo, reduced
constexpr double kForward = 0.4, kAbsorbing = 0.01, kStronglyAbsorbing = 0.2;

// y against x by least squares, from sums over chunks.
class Slope {
public:
    void add(double x, double y) { ++n_, x_ += x, y_ += y, xx_ += x * x, xy_ += x * y; }
    double value() const {
        const double variance = n_ * xx_ - x_ * x_;
        return variance > 0 ? (n_ * xy_ - x_ * y_) / variance : 0;
    }

private:
    double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
};

struct GuidedPilot {
    double total = 0, collisions = 0;  // per walk
    double x_slope = 0, r2_slope = 0;  // of the moments by their controls
    std::array<double, 2> variance{};  // of one walk's total and x less its control
};

// Chunks that the foreseeing pilot leaves.
GuidedPilot guidedPilot(const GuidedWalk& guided) {
    GuidedPilot pilot;
    Slope x, r2;
    std::vector<GuidedSums> all;
    // Without a control there is no slope to be found, and each chunk may have a very long walk.
    const std::uint64_t chunks = guided.inverse_kappa > 0 ? kPilotChunks : 1;
    const auto walks = static_cast<double>(chunks * kPilotGuided);
    for (std::uint64_t chunk = 0; chunk < chunks; ++chunk) {
        const GuidedSums led = walkGuidedChunk(guided, kPilotSeed, kPilotChunks + chunk, kPilotGuided);
        all.push_back(led);
        pilot.total += led.total / walks;
        pilot.collisions += static_cast<double>(led.collisions) / walks;
        x.add(led.x_control, led.x);
        r2.add(led.r2_control, led.r2);
    }
    pilot.x_slope = x.value();
    pilot.r2_slope = r2.value();
    BatchRatios spread(2);
    for (const GuidedSums& led : all) {
        const double values[] = {led.total, led.x - pilot.x_slope * led.x_control};
        spread.add(values, kPilotGuided);
    }
    for (std::size_t i = 0; i < 2; ++i) pilot.variance[i] = std::pow(spread.estimate(i, 1).standard_error, 2) * walks;
    return pilot;
}

// to = (1 - part) to + part scale from, slot by slot; no moments.
void mix(const ExitTally::Sums& from, double scale, const std::vector<double>& part, ExitTally::Sums& to) {
    for (std::size_t i = 0; i < to.flux.size(); ++i)
        to.flux[i] = (1 - part[i]) * to.flux[i] + part[i] * scale * from.flux[i];
}

}  // namespace

BestPlan::BestPlan(const HalfSpaceWalk& half_space, std::span<const double> edges, const BestTuning& chosen)
    : walk(half_space),
      tuning(chosen),
      foresees(half_space.g <= kMostForesight),
      importance(makeImportanceTable(half_space, edges, chosen)),
      bins(laneBins(edges)),
      guided(half_space),
      layout{RadialBins(edges)} {
    // Grazing beams under a sharp phase function are left to the walks.
    if (SingleScattering once = singleScattering(walk, edges); once.error <= 1e-6) single = std::move(once);
    if (!guided.useful()) return;
    const GuidedPilot led = guidedPilot(guided);
    x_slope = led.x_slope;
    r2_slope = led.r2_slope;
    BatchRatios flux(layout.slots()), whole(2);
    std::uint64_t steps = 0;
    for (std::uint64_t chunk = 0; chunk < kPilotChunks; ++chunk) {
        ExitTally pilot(layout);
        steps += walkForeseeingChunk(*this, streamOf(kPilotSeed, chunk), kPilotWalks, pilot);
        const ExitTally::Sums &one = pilot.sums(ExitTally::single), &more = pilot.sums(ExitTally::multiple);
        flux.add(more.flux, kPilotWalks);
        const double values[] = {one.flux[0] + more.flux[0], one.x + more.x};
        whole.add(values, kPilotWalks);
    }
    constexpr std::uint64_t walks = kPilotChunks * kPilotWalks;
    const double total = led.total;
    const double step_time = walk.g == 0 ? kStepTime : foresees ? kForwardStepTime : kCrossingStepTime;
    const double time = step_time * static_cast<double>(steps) / walks;
    const double guided_time =
        kGuidedStart + (walk.g == 0 ? kGuidedIsotropicStepTime : kGuidedStepTime) * led.collisions;
    const double part = walk.g > kForward                                   ? kForwardPart
                        : walk.g != 0 || walk.absorbed > kStronglyAbsorbing ? kAnisotropicPart
                        : walk.absorbed > kAbsorbing                        ? kAbsorbingPart
                                                                            : kPart;
    guided_share = part / (1 - part) * time / guided_time;
    // Where absorption is strong, walks without guidance know total and shift as well: both kinds have a say. Elsewhere
    // a pilot would not see the heavy walks that these rest on; it never sees those of r^2.
    guided_moments = foresees || walk.absorbed < kLeastMixed * (1 - walk.g * (1 - walk.absorbed));
    for (std::size_t i = 0; i < 2 && !guided_moments; ++i) {
        const double variance = std::pow(whole.estimate(i, walks).standard_error, 2) * static_cast<double>(walks);
        if (variance > 0 && std::isfinite(led.variance[i]))
            guided_whole[i] = variance / (variance + led.variance[i] / guided_share);
    }
    const std::size_t last = layout.slots() - 1;
    counts_beyond = flux.estimate(last, walks).mean > 0.02 * total;
    if (walk.g == 0) return;
    // Guided walks leave with nearly equal weights, total each: their bins have the variance of counts. The pilot knows
    // a bin's variance poorly, so that its neighbours have a say.
    guided_part.assign(layout.slots(), 0.0);
    constexpr std::size_t neighbours = 3;
    for (std::size_t slot = 1; slot <= last; ++slot) {
        double variance = 0, guided_variance = 0;
        // What is below the bins and beyond them is of another kind.
        const bool outside = slot == 1 || slot == last;
        const std::size_t begin = outside ? slot : std::max<std::size_t>(2, slot - std::min(slot, neighbours));
        const std::size_t end = outside ? slot : std::min(last - 1, slot + neighbours);
        for (std::size_t i = begin; i <= end; ++i) {
            const Estimate bin = flux.estimate(i, walks);
            variance += bin.standard_error * bin.standard_error * static_cast<double>(walks);
            guided_variance += bin.mean * total / guided_share;
        }
        if (variance > 0) guided_part[slot] = variance / (variance + guided_variance);
    }
}

double BestPlan::reach(std::uint64_t walks) const {
    return std::log(std::max(1.0, static_cast<double>(walks) / 100)) / std::max(importance.decay, 1e-30);
}

std::uint64_t walkBestChunk(const BestPlan& plan, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                            ExitTally& tally) {
    const double n = static_cast<double>(walks);
    ExitTally::Sums &one = tally.sums(ExitTally::single), &more = tally.sums(ExitTally::multiple);
    const std::uint64_t collisions = walkForeseeingChunk(plan, streamOf(seed, chunk), walks, tally);
    const auto led = static_cast<std::uint64_t>(std::ceil(n * plan.guided_share));
    const double scale = n / static_cast<double>(led);
    GuidedSums all;
    if (!plan.guided_part.empty()) {
        ExitTally guided(plan.layout);
        all = walkGuidedChunk(plan.guided, seed ^ kGuidedStream, chunk, led, plan.layout.bins, guided);
        for (const ExitTally::Order order : {ExitTally::single, ExitTally::multiple})
            mix(guided.sums(order), scale, plan.guided_part, tally.sums(order));
    } else if (led > 0) {
        all = walkGuidedChunk(plan.guided, seed ^ kGuidedStream, chunk, led);
    }
    if (plan.single) {
        one.flux[0] = n * plan.single->total;
        for (std::size_t i = 0; i < plan.single->flux.size(); ++i) one.flux[1 + i] = n * plan.single->flux[i];
        one.x = n * plan.single->x;
        one.r2 = n * plan.single->r2;
    }
    if (led == 0) return collisions;
    const auto mixed = [&](std::size_t i, double led_sum, double once, double& own) {
        own = plan.guided_whole[i] * (scale * led_sum - once) + (1 - plan.guided_whole[i]) * own;
    };
    mixed(0, all.total, one.flux[0], more.flux[0]);
    mixed(1, all.x - plan.x_slope * all.x_control, one.x, more.x);
    more.r2 = scale * (all.r2 - plan.r2_slope * all.r2_control) - one.r2;
    if (plan.walk.absorbed == 0) more.flux[0] = n - one.flux[0];  // everything leaves
    if (plan.counts_beyond) {
        more.flux.back() = more.flux[0];
        for (std::size_t slot = 1; slot + 1 < more.flux.size(); ++slot) more.flux.back() -= more.flux[slot];
    }
    return collisions + all.collisions;
}

}  // namespace searchlight
