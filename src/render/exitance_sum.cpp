#include "render/exitance_sum.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <chrono>

#include "base/parallel.h"
#include "render/exitance/audit.h"

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

struct SumMemory::Impl {
    DualTreeResult sums;
    OpeningCache openings;
    Audit audit;
};

SumMemory::SumMemory() : impl_(std::make_unique<Impl>()) {}
SumMemory::~SumMemory() = default;
SumMemory::SumMemory(SumMemory&&) noexcept = default;
SumMemory& SumMemory::operator=(SumMemory&&) noexcept = default;

namespace {

class Sum {
public:
    Sum(const PilotInput& input, SumMemory::Impl& memory, Observer* observer, SumStatistics& found)
        : input_(input), memory_(memory), observer_(observer), found_(found) {}

    /// With what is known, a calibration that has an opening, as it is.
    void take(const SumCalibration& known) {
        const auto start = Clock::now();
        Opening none;
        const bool opens = known.opening != Rgb{};
        traverse({input_.points,
                  input_.table,
                  input_.receivers,
                  opens ? memory_.openings.of(input_, known.opening) : none,
                  {},
                  observer_},
                 input_.threads, memory_.sums);
        found_.sum_ms += millisecondsSince(start);
        ++found_.taken;
    }

    /// With an opening that was found for something else, and judged afterwards: it is taken again where the error is
    /// not kept. False where that does not lead anywhere.
    bool takeAndJudge(SumCalibration& calibration) {
        const Rgb most = largestOpening(input_);
        Rgb opening;
        for (int c = 0; c < Rgb::channels; ++c) {
            if (!matters(input_, c)) continue;
            if (!(calibration.next[c] > 0)) return false;
            opening[c] = std::min(most[c], calibration.next[c]);
        }
        if (opening == Rgb{}) return false;
        double since_drawn = 0;  // by how much the opening fell since the sample was drawn
        for (int attempt = 0; attempt < 3; ++attempt) {
            take({.opening = opening});
            const auto start = Clock::now();
            // A sum that was far off says little about where to look, and its reference may be off as well.
            if (since_drawn < 0.5) {
                memory_.audit.draw(input_, memory_.sums, opening, memory_.openings);
                since_drawn = 1;
            }
            Rgb bounds;
            const SumCalibration judged = memory_.audit.judged(input_, memory_.sums, opening, bounds);
            found_.pilot_ms += millisecondsSince(start);
            if (judged.error_bound <= input_.error) {
                calibration = judged;
                calibration.next = attempt == 0 ? wider(opening, bounds, most) : opening;
                return true;
            }
            double least = 1;
            for (int c = 0; c < Rgb::channels; ++c) {
                const double ratio = input_.error / std::max(bounds[c], 1e-30);
                if (!matters(input_, c) || ratio > 1 / aim) continue;
                const double factor = std::max(aim * ratio, 1.0 / 64);
                opening[c] *= factor;
                least = std::min(least, factor);
            }
            since_drawn *= least;
        }
        return false;
    }

private:
    // The part of the error asked for at which an opening aims: samples differ, and what is near the limit would be
    // summed twice now and then.
    static constexpr double aim = 0.8;

    // What to begin with the next time, where the error turned out less than that. None where the opening says nothing
    // about it: a pilot has to find one.
    Rgb wider(Rgb opening, Rgb bounds, Rgb most) const {
        for (int c = 0; c < Rgb::channels; ++c) {
            if (!matters(input_, c) || opening[c] >= most[c]) continue;
            const double ratio = input_.error / std::max(bounds[c], 1e-30);
            if (ratio > 8) return {};
            if (ratio > 1.45) opening[c] = std::min(most[c], opening[c] * aim * ratio);
        }
        return opening;
    }

    const PilotInput& input_;
    SumMemory::Impl& memory_;
    Observer* observer_;
    SumStatistics& found_;
};

}  // namespace

void sumExitance(const PointTree& points, const RadialTable& table, const ReceiverTree& receivers,
                 const SumOptions& options, std::vector<Rgbf>& exitance, SumStatistics* statistics) {
    const PilotInput input{points.impl(), table.impl(), receivers.impl(), std::clamp(options.error, 1e-4, 0.5),
                           options.threads};
    SumCalibration unkept;
    SumCalibration& calibration = options.calibration ? *options.calibration : unkept;
    SumMemory unkept_memory;
    SumMemory::Impl& memory = (options.memory ? *options.memory : unkept_memory).impl();
    SumStatistics found;
    Sum sum(input, memory, options.observer, found);
    if (points.size() <= few_points || options.one_by_one || receivers.size() == 0) {
        sum.take({});
    } else {
        const std::uint64_t key = keyOf(input);
        if (calibration.key == key) {
            sum.take(calibration);
        } else {
            found.calibrated = true;
            // Where an earlier sum was, the same opening most likely does. A sum that is cancelled leaves what was.
            SumCalibration tried = calibration;
            if (!sum.takeAndJudge(tried)) {
                const auto start = Clock::now();
                tried = calibrate(input, calibration.opening);
                tried.next = tried.opening;
                found.pilot_ms += millisecondsSince(start);
                sum.take(tried);
            }
            calibration = tried;
            calibration.key = key;
        }
        found.error_bound = calibration.error_bound;
        found.largest_error_bound = calibration.largest_error_bound;
    }

    const auto start = Clock::now();
    exitance.resize(receivers.size());
    const Rgbf unit = toFloat(input.points.unit);
    const DualTreeResult& sums = memory.sums;
    constexpr std::size_t grain = 1 << 14;
    parallelFor((exitance.size() + grain - 1) / grain, options.threads, [&](std::size_t task) {
        for (std::size_t i = task * grain; i < std::min(exitance.size(), (task + 1) * grain); ++i)
            exitance[input.receivers.order[i]] = {unit.r * sums.exitance[0][i], unit.g * sums.exitance[1][i],
                                                  unit.b * sums.exitance[2][i]};
    });
    found.sum_ms += millisecondsSince(start);
    found.interactions = sums.interactions;
    found.expansions = sums.expansions;
    found.tree_ms = input.receivers.build_ms;
    if (statistics) *statistics = found;
}

std::vector<Rgbf> sumExitance(const PointTree& points, const RadialTable& table, const ReceiverTree& receivers,
                              const SumOptions& options, SumStatistics* statistics) {
    std::vector<Rgbf> exitance;
    sumExitance(points, table, receivers, options, exitance, statistics);
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
