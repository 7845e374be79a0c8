// Who wins where: techniques by their error at equal time, and by their time at equal error.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace searchlight {

/// What a budget cost, and what error it left.
struct CostPoint {
    double ms = 0;
    double error = 0;  ///< relative, above 0
};

/// The least error that a technique has at each time. Between budgets it is taken to fall along a straight line of
/// logarithms; before the cheapest there is no answer, after the dearest the error stays.
class ErrorCurve {
public:
    /// Points in any order; those that cost more than another and are no nearer are left out.
    explicit ErrorCurve(std::vector<CostPoint> points);

    bool empty() const { return front_.empty(); }
    /// Ascending in time, falling in error.
    std::span<const CostPoint> points() const { return front_; }

    /// Infinite before the first point.
    double errorAt(double ms) const;
    /// The time after which the error is that or less; infinite where it never is.
    double timeTo(double error) const;

private:
    std::vector<CostPoint> front_;
};

/// A range of time in which one curve is nearest.
struct TimeReign {
    std::size_t curve = 0;
    double from_ms = 0, to_ms = 0;  ///< infinite at the end: from there on
    double error = 0;               ///< at its end
};

/// From the first point of all on, without gaps. Errors below `floor` are not told apart: of those the curve that was
/// there first stays. Empty where all curves are.
std::vector<TimeReign> nearestOverTime(std::span<const ErrorCurve> curves, double floor);

/// A range of errors in which one curve is fastest.
struct ErrorReign {
    std::size_t curve = 0;
    double from = 0, to = 0;  ///< from is the larger error
    double ms = 0;            ///< to the smaller one
};

/// From the largest error that any curve starts with down to the least that any reaches, or `floor`.
std::vector<ErrorReign> fastestOverError(std::span<const ErrorCurve> curves, double floor);

/// "separable below 12 ms, texture-space from there to 90 ms, hierarchical from 90 ms on".
std::string reignText(std::span<const TimeReign> reigns, std::span<const std::string> labels);
std::string reignText(std::span<const ErrorReign> reigns, std::span<const std::string> labels);

/// "7.3 ms", "1.2 s".
std::string durationText(double ms);

/// "12 %", "0.35 %".
std::string errorText(double error);

}  // namespace searchlight
