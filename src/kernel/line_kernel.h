// An even function of one variable, known by its integral: what a separable kernel is made of.
#pragma once

#include <span>
#include <vector>

namespace searchlight {

/// a(x) = a(-x), 1/mm, tabulated for x >= 0 together with its integral from 0, beside a delta at 0: light that does not
/// move. Between the nodes the integral is the cubic through both; beyond the last node a is 0. The density at 0 may be
/// large but is finite; weights of samples come from integrals, so that a peak at 0 costs nothing.
class LineKernel {
public:
    /// The delta alone: light stays where it is.
    LineKernel() = default;
    explicit LineKernel(double delta) : delta_(delta) {}

    /// x_mm ascends from 0, integral[0] = 0; all three lists have the same size of at least 2.
    LineKernel(std::vector<double> x_mm, std::vector<double> integral, std::vector<double> density, double delta = 0);

    /// Density at x, without the delta.
    double operator()(double x_mm) const;

    /// Integral of the density over [from, to], from <= to, without the delta.
    double integral(double from_mm, double to_mm) const { return fromZero(to_mm) - fromZero(from_mm); }

    /// Integral of a(x) cos(omega x) over the line, omega >= 0 in 1/mm, with the delta; exact for the tabulated curve.
    double transform(double omega) const;

    /// Integral over the line, with the delta.
    double mass() const { return delta_ + (x_.empty() ? 0 : 2 * integral_.back()); }

    double delta() const { return delta_; }
    double extent() const { return x_.empty() ? 0 : x_.back(); }  ///< the last node, mm; 0 for a delta alone
    std::span<const double> nodes() const { return x_; }

    /// The kernel times a number.
    LineKernel scaled(double factor) const;

private:
    double fromZero(double x_mm) const;

    std::vector<double> x_, integral_, density_;
    double delta_ = 1;
};

}  // namespace searchlight
