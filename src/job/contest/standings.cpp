#include "job/contest/standings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"

namespace searchlight {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();
// Ranges are found to 2 %: clocks know no better.
constexpr double grain = 1.02;

// y at x on the line through two points of logarithms.
double logLine(double x0, double y0, double x1, double y1, double x) {
    if (x1 == x0) return y1;
    const double t = std::log(x / x0) / std::log(x1 / x0);
    return y0 * std::pow(y1 / y0, t);
}

}  // namespace

ErrorCurve::ErrorCurve(std::vector<CostPoint> points) {
    std::ranges::sort(
        points, [](const CostPoint& a, const CostPoint& b) { return a.ms != b.ms ? a.ms < b.ms : a.error < b.error; });
    for (const CostPoint& point : points)
        if (front_.empty() || point.error < front_.back().error) front_.push_back(point);
}

double ErrorCurve::errorAt(double ms) const {
    if (front_.empty() || ms < front_.front().ms) return never;
    const auto after = std::ranges::upper_bound(front_, ms, {}, &CostPoint::ms);
    if (after == front_.end()) return front_.back().error;
    const CostPoint &a = *(after - 1), &b = *after;
    return logLine(a.ms, a.error, b.ms, b.error, ms);
}

double ErrorCurve::timeTo(double error) const {
    for (std::size_t i = 0; i < front_.size(); ++i) {
        if (front_[i].error > error) continue;
        if (i == 0) return front_[0].ms;
        return logLine(front_[i - 1].error, front_[i - 1].ms, front_[i].error, front_[i].ms, error);
    }
    return never;
}

std::vector<TimeReign> nearestOverTime(std::span<const ErrorCurve> curves, double floor) {
    double first = never, last = 0;
    for (const ErrorCurve& curve : curves)
        if (!curve.empty()) {
            first = std::min(first, curve.points().front().ms);
            last = std::max(last, curve.points().back().ms);
        }
    std::vector<TimeReign> reigns;
    if (first == never) return reigns;
    const auto known = [&](std::size_t c, double ms) { return std::max(curves[c].errorAt(ms), floor); };
    // The last step is at the end of all curves, so that the last range holds for good.
    const int steps = static_cast<int>(std::ceil(std::log(last / first) / std::log(grain)));
    for (int i = 0; i <= steps; ++i) {
        const double ms = i == steps ? last : first * std::pow(grain, i);
        std::size_t best = reigns.empty() ? 0 : reigns.back().curve;
        for (std::size_t c = 0; c < curves.size(); ++c)
            if (known(c, ms) < known(best, ms)) best = c;
        if (reigns.empty() || reigns.back().curve != best) {
            if (!reigns.empty()) reigns.back().to_ms = ms;
            reigns.push_back({.curve = best, .from_ms = ms, .to_ms = never});
        }
        reigns.back().error = known(best, ms);
    }
    return reigns;
}

std::vector<ErrorReign> fastestOverError(std::span<const ErrorCurve> curves, double floor) {
    double largest = 0, least = never;
    for (const ErrorCurve& curve : curves)
        if (!curve.empty()) {
            largest = std::max(largest, curve.points().front().error);
            least = std::min(least, curve.points().back().error);
        }
    std::vector<ErrorReign> reigns;
    least = std::max(least, floor);
    if (largest < least) return reigns;
    const int steps = static_cast<int>(std::ceil(std::log(largest / least) / std::log(grain)));
    for (int i = 0; i <= steps; ++i) {
        const double error = i == steps ? least : largest * std::pow(grain, -i);
        std::size_t best = reigns.empty() ? 0 : reigns.back().curve;
        for (std::size_t c = 0; c < curves.size(); ++c)
            if (curves[c].timeTo(error) < curves[best].timeTo(error)) best = c;
        if (reigns.empty() || reigns.back().curve != best) reigns.push_back({.curve = best, .from = error});
        reigns.back().to = error;
        reigns.back().ms = curves[best].timeTo(error);
    }
    return reigns;
}

std::string reignText(std::span<const TimeReign> reigns, std::span<const std::string> labels) {
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < reigns.size(); ++i) {
        const TimeReign& reign = reigns[i];
        std::string when;
        if (reigns.size() == 1)
            when = "at all times";
        else if (i == 0)
            when = fmt::format("below {}", durationText(reign.to_ms));
        else if (i + 1 < reigns.size())
            when = fmt::format("from there to {}", durationText(reign.to_ms));
        else
            when = fmt::format("from {} on", durationText(reign.from_ms));
        parts.push_back(fmt::format("{} {}", labels[reign.curve], when));
    }
    return join(parts, ", ");
}

std::string reignText(std::span<const ErrorReign> reigns, std::span<const std::string> labels) {
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < reigns.size(); ++i) {
        const ErrorReign& reign = reigns[i];
        const std::string where =
            i == 0 ? fmt::format("down to {}", errorText(reign.to)) : fmt::format("on to {}", errorText(reign.to));
        parts.push_back(fmt::format("{} {} ({})", labels[reign.curve], where, durationText(reign.ms)));
    }
    return join(parts, ", ");
}

std::string durationText(double ms) {
    return ms < 1000 ? prettyNumber(ms, 2) + " ms" : prettyNumber(ms / 1000, 2) + " s";
}

std::string errorText(double error) { return prettyNumber(100 * error, 2) + " %"; }

}  // namespace searchlight
