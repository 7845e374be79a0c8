#include "transport/half_space/radiance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "transport/half_space/half_space_walk.h"
#include "transport/walk/beam.h"
#include "transport/walk/chunks.h"

namespace searchlight {

namespace {

constexpr double pi = std::numbers::pi;
constexpr int kMostCells = 1 << 16;

void check(const RadianceOptions& options) {
    if (options.walks == 0) throw inputError("a reference needs at least one walk");
    if (!(options.r0_mm >= 0 && options.r1_mm > options.r0_mm && options.r1_mm <= 1e9))
        throw inputError(fmt::format("an annulus from {} to {} mm", options.r0_mm, options.r1_mm),
                         "its radii ascend from 0 or more, up to 1e9 mm");
    if (!std::isfinite(options.azimuth_deg))
        throw inputError("the azimuth of the sector is not finite", "degrees from +x");
    if (!(options.half_width_deg > 0 && options.half_width_deg <= 180))
        throw inputError(fmt::format("half the width of the sector is {} deg", options.half_width_deg),
                         "above 0, up to 180");
    if (options.polar < 1 || options.turns < 1 || options.polar > kMostCells / options.turns)
        throw inputError(fmt::format("a hemisphere of {} x {} cells", options.polar, options.turns),
                         "at least 1 x 1, up to 65,536 cells");
}

// Integral of the cosine over cell i of the hemisphere.
double projectedSolidAngle(const RadianceOptions& options, int i) {
    const auto sine2 = [&](int edge) { return std::pow(std::sin(0.5 * pi * edge / options.polar), 2); };
    return 0.5 * (sine2(i + 1) - sine2(i)) * 2 * pi / options.turns;
}

}  // namespace

RadianceResult walkRadiance(const HalfSpaceProblem& problem, const RadianceOptions& options, Observer& observer) {
    checkHalfSpaceProblem(problem);
    check(options);
    const Beam beam = enteringBeam(problem.eta, problem.angle_deg);
    const std::size_t cells = static_cast<std::size_t>(options.polar) * static_cast<std::size_t>(options.turns);
    RadianceResult result;
    result.specular = beam.specular;
    if (problem.sigma_s == 0 || beam.specular == 1) {
        result.radiance.assign(cells, 0.0);
        result.standard_error.assign(cells, 0.0);
        return result;
    }
    const double sigma_t = problem.sigma_a + problem.sigma_s;
    const HalfSpaceWalk walk{.absorbed = problem.sigma_a / sigma_t,
                             .g = problem.g,
                             .eta = problem.eta,
                             .sin_beam = beam.sine,
                             .cos_beam = beam.cosine,
                             .shape = {problem.beam.kind, problem.beam.radius * sigma_t},
                             .cos_incidence = std::cos(problem.angle_deg * pi / 180)};
    RadianceLayout layout{options.r0_mm * sigma_t, options.r1_mm * sigma_t, options.azimuth_deg * pi / 180};
    // A sector of the whole turn has no edge that rounding could lose an exit at.
    layout.half_width = options.half_width_deg == 180 ? 4 : options.half_width_deg * pi / 180;
    layout.eta = problem.eta;
    layout.polar = static_cast<std::size_t>(options.polar);
    layout.turns = static_cast<std::size_t>(options.turns);

    ChunkedWalk job;
    job.plan = planChunks(options.walks);
    job.threads = options.threads;
    const ChunkedResult walked = walkChunks(
        job, {BatchRatios(layout.slots())}, RadianceTally(layout),
        [&](std::uint64_t chunk, std::uint64_t walks, RadianceTally& tally) {
            return walkHalfSpaceChunk(walk, options.seed, chunk, walks, tally);
        },
        [](const RadianceTally& tally, std::uint64_t walks, std::vector<BatchRatios>& sums) {
            sums[0].add(tally.flux(), static_cast<double>(walks));
        },
        observer);
    result.walks = walked.walks;
    result.seconds = walked.seconds;

    const double area =
        options.half_width_deg / 180 * pi * (options.r1_mm - options.r0_mm) * (options.r1_mm + options.r0_mm);
    const double per_area = (1 - beam.specular) / area;
    const auto estimate = [&](std::size_t slot) {
        Estimate e = walked.sums[0].estimate(slot, walked.walks);
        e.standard_error = std::max(e.standard_error, 1 / static_cast<double>(walked.walks));
        return Estimate{per_area * e.mean, per_area * e.standard_error, e.count};
    };
    result.exitance = estimate(0);
    for (int i = 0; i < options.polar; ++i)
        for (int j = 0; j < options.turns; ++j) {
            const Estimate cell = estimate(1 + static_cast<std::size_t>(i * options.turns + j));
            result.radiance.push_back(cell.mean / projectedSolidAngle(options, i));
            result.standard_error.push_back(cell.standard_error / projectedSolidAngle(options, i));
        }
    return result;
}

}  // namespace searchlight
