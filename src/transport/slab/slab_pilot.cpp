#include "transport/slab/slab_pilot.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace searchlight {

namespace {

constexpr std::uint64_t kPilotSeed = 0x70696C6F7473, kChunkWalks = 16;
// Slopes from n chunks by p controls leave a variance that is p / n larger than could be.
constexpr std::size_t kChunksPerControl = 48, kFewestChunks = 96;
constexpr std::uint64_t kMostSteps = 20'000'000;
// Of the root of the largest sum of squares. Controls that hardly differ are one: where few walks are absorbed, or get
// through, these alone would tell them apart.
constexpr double kLeastPivot = 0.05;
// Slots that fewer chunks met are left alone: a slope from few events could make small fluxes negative.
constexpr std::size_t kFewestMet = 24;

constexpr SlabLayout::Run kTotals[] = {SlabLayout::R_scattered, SlabLayout::R_single, SlabLayout::T_scattered,
                                       SlabLayout::A_total, SlabLayout::A_layer};
constexpr SlabLayout::Run kSeries[] = {SlabLayout::R_a, SlabLayout::T_a, SlabLayout::A_z, SlabLayout::F_z};

}  // namespace

SlabPilot::SlabPilot(const SlabWalk& walk, const SlabControl& control, const SlabDepths& depths,
                     const SlabLayout& tallied)
    : layout(tallied.withoutAnnuli()),
      slopes(layout.slots()),
      mean(layout.slots()),
      variance(layout.slots()),
      analogue_variance(layout.slots()) {
    const std::size_t size = control.size(), most = std::max(kFewestChunks, kChunksPerControl * size);
    const auto controls = static_cast<Eigen::Index>(size), slots = static_cast<Eigen::Index>(layout.slots());
    // Sums over chunks.
    Eigen::VectorXd x = Eigen::VectorXd::Zero(controls), y = Eigen::VectorXd::Zero(slots), y2 = y;
    Eigen::MatrixXd xx = Eigen::MatrixXd::Zero(controls, controls), xy = Eigen::MatrixXd::Zero(controls, slots);
    Eigen::Matrix3d ends = Eigen::Matrix3d::Zero();
    const Eigen::Index R_T_A[] = {static_cast<Eigen::Index>(layout.first(SlabLayout::R_scattered)),
                                  static_cast<Eigen::Index>(layout.first(SlabLayout::T_scattered)),
                                  static_cast<Eigen::Index>(layout.first(SlabLayout::A_total))};
    std::vector<std::size_t> met(layout.slots());
    std::size_t chunks = 0;
    std::uint64_t all_steps = 0, all_crossings = 0;
    for (; chunks < most && (chunks < kFewestChunks || all_steps < kMostSteps); ++chunks) {
        SlabTally tally(layout);
        std::vector<double> sums(SlabControl::kSums * control.layers.size());
        all_steps +=
            walkSlabDepthsChunk(walk, kPilotSeed, chunks, kChunkWalks, tally, control, sums, depths, &all_crossings);
        const std::span<const double> flux = tally.flux();
        const std::vector<double> list =
            control.controls(sums, flux[layout.first(SlabLayout::R_unscattered)],
                             flux[layout.first(SlabLayout::T_unscattered)], static_cast<double>(kChunkWalks));
        const Eigen::VectorXd found = Eigen::Map<const Eigen::VectorXd>(list.data(), controls);
        x += found;
        xx += found * found.transpose();
        for (std::size_t slot = 0; slot < flux.size(); ++slot) {
            if (flux[slot] == 0) continue;  // most, where there are many depths
            const auto at = static_cast<Eigen::Index>(slot);
            ++met[slot];
            y[at] += flux[slot];
            y2[at] += flux[slot] * flux[slot];
            xy.col(at) += flux[slot] * found;
        }
        const Eigen::Vector3d end(flux[layout.first(SlabLayout::R_scattered)],
                                  flux[layout.first(SlabLayout::T_scattered)], flux[layout.first(SlabLayout::A_total)]);
        ends += end * end.transpose();
    }
    const double n = static_cast<double>(chunks), per_chunk = static_cast<double>(kChunkWalks);
    steps = static_cast<double>(all_steps) / (n * per_chunk);
    crossings = static_cast<double>(all_crossings) / (n * per_chunk);
    // About the means of the fluxes; those of the controls are known: they are 0.
    for (Eigen::Index slot = 0; slot < slots; ++slot) xy.col(slot) -= (y[slot] / n) * x;
    for (std::size_t slot = 0; slot < layout.slots(); ++slot) {
        const auto at = static_cast<Eigen::Index>(slot);
        mean[slot] = y[at] / (n * per_chunk);
        variance[slot] = std::max(0.0, y2[at] - y[at] * y[at] / n) / (n - 1) / per_chunk;
    }
    analogue_variance = variance;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(xx);
    const Eigen::VectorXd& values = solver.eigenvalues();
    const double least = kLeastPivot * kLeastPivot * values.maxCoeff();
    Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(controls, controls);
    std::size_t rank = 0;
    for (Eigen::Index i = 0; i < controls; ++i) {
        if (!(values[i] > least)) continue;
        inverse += solver.eigenvectors().col(i) * solver.eigenvectors().col(i).transpose() / values[i];
        ++rank;
    }
    const double freedom = n - 1 - static_cast<double>(rank);
    const auto learn = [&](std::size_t slot) {
        const auto column = xy.col(static_cast<Eigen::Index>(slot));
        const Eigen::VectorXd slope = inverse * column;
        slopes[slot].assign(slope.begin(), slope.end());
        const double rest = analogue_variance[slot] * (n - 1) - slope.dot(column) / per_chunk;
        variance[slot] = std::max(0.0, rest) / freedom;
    };
    for (const SlabLayout::Run run : kTotals)
        for (std::size_t slot = layout.first(run); slot < layout.first(run) + layout.size(run); ++slot)
            if (met[slot] >= kFewestMet) learn(slot);
    for (const SlabLayout::Run run : kSeries)
        for (std::size_t slot = layout.first(run); slot < layout.first(run) + layout.size(run); ++slot) {
            if (met[slot] < kFewestMet) continue;
            learn(slot);
            if (variance[slot] < 0.98 * analogue_variance[slot]) continue;
            slopes[slot].clear();
            variance[slot] = analogue_variance[slot];
        }
    // Of what is left when each has lost what its own slopes say.
    const auto slopeOf = [&](Eigen::Index slot) -> Eigen::VectorXd {
        const std::vector<double>& slope = slopes[static_cast<std::size_t>(slot)];
        if (slope.empty()) return Eigen::VectorXd::Zero(controls);
        return Eigen::Map<const Eigen::VectorXd>(slope.data(), controls);
    };
    for (Eigen::Index i = 0; i < 3; ++i) {
        const Eigen::Index a = R_T_A[i];
        often[static_cast<std::size_t>(i)] = met[static_cast<std::size_t>(a)] >= kFewestMet;
        for (Eigen::Index j = 0; j < 3; ++j) {
            const Eigen::Index b = R_T_A[j];
            const Eigen::VectorXd of_a = slopeOf(a), of_b = slopeOf(b);
            const double sum =
                ends(i, j) - y[a] * y[b] / n - of_a.dot(xy.col(b)) - of_b.dot(xy.col(a)) + of_a.dot(xx * of_b);
            covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = sum / freedom / per_chunk;
        }
    }
}

void SlabPilot::correct(const SlabControl& control, std::span<const double> sums, double walks, const SlabLayout& of,
                        std::span<double> flux) const {
    double& R_unscattered = flux[of.first(SlabLayout::R_unscattered)];
    double& T_unscattered = flux[of.first(SlabLayout::T_unscattered)];
    const std::vector<double> controls = control.controls(sums, R_unscattered, T_unscattered, walks);
    R_unscattered = walks * control.unscattered.R;
    T_unscattered = walks * control.unscattered.T;
    const auto take = [&](SlabLayout::Run run) {
        for (std::size_t i = 0; i < layout.size(run); ++i) {
            const std::vector<double>& slope = slopes[layout.first(run) + i];
            for (std::size_t k = 0; k < slope.size(); ++k) flux[of.first(run) + i] -= slope[k] * controls[k];
        }
    };
    for (const SlabLayout::Run run : kTotals) take(run);
    for (const SlabLayout::Run run : kSeries) take(run);
}

void SlabPilot::join(const SlabControl& control, double walks, std::vector<double> others, double other_walks,
                     const SlabLayout& of, std::span<double> flux) const {
    const double n = walks + other_walks;
    // How much light stays unscattered is known: what more or less of it the others found, is not or is scattered.
    const double surplus = others[of.first(SlabLayout::R_unscattered)] + others[of.first(SlabLayout::T_unscattered)] -
                           other_walks * (control.unscattered.R + control.unscattered.T);
    const double scattered = mean[layout.first(SlabLayout::R_scattered)] + mean[layout.first(SlabLayout::T_scattered)] +
                             mean[layout.first(SlabLayout::A_total)];
    for (const SlabLayout::Run run : kTotals)
        for (std::size_t i = 0; scattered > 0 && i < layout.size(run); ++i)
            others[of.first(run) + i] += surplus * mean[layout.first(run) + i] / scattered;
    std::vector<char> joined(flux.size());
    // Variance of a walk that tells controls over that of one that does not.
    const auto quotient = [&](std::size_t known) {
        return slopes[known].empty() || !(variance[known] > 0) ? 1 : variance[known] / analogue_variance[known];
    };
    const auto mix = [&](SlabLayout::Run run, double least) {
        for (std::size_t i = 0; i < layout.size(run); ++i) {
            const std::size_t known = layout.first(run) + i, slot = of.first(run) + i;
            if (slopes[known].empty()) continue;
            const double a = walks / std::max(least, quotient(known));
            flux[slot] = n * (a * flux[slot] / walks + others[slot]) / (a + other_walks);
            joined[slot] = 1;
        }
    };
    // Sums of these are the whole: all have the same part, that of the one which gains least.
    constexpr SlabLayout::Run ends[] = {SlabLayout::R_scattered, SlabLayout::T_scattered, SlabLayout::A_total};
    double least = 0;
    for (const SlabLayout::Run run : ends)
        if (mean[layout.first(run)] > 0) least = std::max(least, quotient(layout.first(run)));
    for (const SlabLayout::Run run : ends) mix(run, least);
    for (const SlabLayout::Run run : {SlabLayout::R_single, SlabLayout::A_layer}) mix(run, 0);
    for (const SlabLayout::Run run : kSeries) mix(run, 0);
    for (std::size_t slot = 0; slot < flux.size(); ++slot)
        if (!joined[slot]) flux[slot] += others[slot];
    flux[of.first(SlabLayout::R_unscattered)] = n * control.unscattered.R;
    flux[of.first(SlabLayout::T_unscattered)] = n * control.unscattered.T;
}

std::vector<double> SlabPilot::spread(std::span<const double> flux, const SlabLayout& to) const {
    std::vector<double> result(to.slots());
    const auto copy = [&](SlabLayout::Run run) {
        for (std::size_t i = 0; i < layout.size(run); ++i) result[to.first(run) + i] = flux[layout.first(run) + i];
    };
    for (const SlabLayout::Run run : kTotals) copy(run);
    for (const SlabLayout::Run run : kSeries) copy(run);
    for (const SlabLayout::Run run : {SlabLayout::R_unscattered, SlabLayout::T_unscattered}) copy(run);
    return result;
}

}  // namespace searchlight
