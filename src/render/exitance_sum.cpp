#include "render/exitance_sum.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <chrono>

#include "base/parallel.h"
#include "render/exitance/dual_tree.h"
#include "render/exitance/pilot.h"

namespace searchlight {

namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// So few points are summed one by one: 2 ns each beat any expansion.
constexpr std::size_t few_points = 64;

std::uint64_t keyOf(const PilotInput& input) {
    std::uint64_t key = 0xcbf29ce484222325;
    for (const std::uint64_t part : {input.points.fingerprint, input.table.fingerprint, input.receivers.fingerprint,
                                     std::bit_cast<std::uint64_t>(input.error)})
        key = (key ^ part ^ key >> 29) * 0x100000001b3;
    return std::max<std::uint64_t>(key, 1);
}

}  // namespace

std::vector<Rgbf> sumExitance(const PointTree& points, const RadialTable& table, const ReceiverTree& receivers,
                              const SumOptions& options, SumStatistics* statistics) {
    const PilotInput input{points.impl(), table.impl(), receivers.impl(), std::clamp(options.error, 1e-4, 0.5),
                           options.threads};
    SumCalibration unkept;
    SumCalibration& calibration = options.calibration ? *options.calibration : unkept;
    SumStatistics found;
    const auto start = Clock::now();
    const bool direct = points.size() <= few_points;
    Opening opening;
    if (!direct && receivers.size() > 0) {
        const std::uint64_t key = keyOf(input);
        if (calibration.key != key) {
            calibration = calibrate(input, calibration.opening);
            calibration.key = key;
            found.calibrated = true;
        }
        found.error_bound = calibration.error_bound;
        found.largest_error_bound = calibration.largest_error_bound;
        if (calibration.opening != Rgb{}) opening = openingFor(input, calibration.opening);
    }
    found.pilot_ms = millisecondsSince(start);

    const auto sum_start = Clock::now();
    DualTreeResult sums;
    traverse({input.points, input.table, input.receivers, opening, {}}, options.threads, sums);
    std::vector<Rgbf> exitance(receivers.size());
    const Rgbf unit = toFloat(input.points.unit);
    constexpr std::size_t grain = 1 << 14;
    parallelFor((exitance.size() + grain - 1) / grain, options.threads, [&](std::size_t task) {
        for (std::size_t i = task * grain; i < std::min(exitance.size(), (task + 1) * grain); ++i)
            exitance[input.receivers.order[i]] = {unit.r * sums.exitance[0][i], unit.g * sums.exitance[1][i],
                                                  unit.b * sums.exitance[2][i]};
    });
    found.sum_ms = millisecondsSince(sum_start);
    found.interactions = sums.interactions;
    found.expansions = sums.expansions;
    found.tree_ms = input.receivers.build_ms;
    if (statistics) *statistics = found;
    return exitance;
}

std::vector<Rgbf> sumExitance(const PointTree& points, const RadialTable& table, std::span<const Vec3f> receivers,
                              const SumOptions& options, SumStatistics* statistics) {
    return sumExitance(points, table, ReceiverTree(receivers, options.threads), options, statistics);
}

std::vector<Rgb> sumExitanceDirectly(const PointCloud& points, std::span<const Rgbf> transmitted,
                                     const Profile& profile, std::span<const Vec3f> receivers, int threads) {
    const std::size_t n = points.positions.size();
    assert(n > 0 && points.areas.size() == n && transmitted.size() == n);
    double area = 0;
    for (const float a : points.areas) area += static_cast<double>(a);
    const RadialKernel kernel(profile, area / static_cast<double>(n));
    std::vector<Rgb> exitance(receivers.size());
    parallelFor(receivers.size(), threads, [&](std::size_t k) {
        const Vec3 xo = toDouble(receivers[k]);
        Rgb sum;
        for (std::size_t i = 0; i < n; ++i) {
            if (transmitted[i] == Rgbf{}) continue;
            const Rgb flux = static_cast<double>(points.areas[i]) * toDouble(transmitted[i]);
            sum = sum + flux * kernel(length(xo - toDouble(points.positions[i])));
        }
        exitance[k] = sum;
    });
    return exitance;
}

}  // namespace searchlight
