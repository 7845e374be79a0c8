// Local minimum of a smooth function within bounds.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace searchlight {

/// f(x), and its gradient when `gradient` is not empty.
using Objective = std::function<double(std::span<const double> x, std::span<double> gradient)>;

struct Minimum {
    std::vector<double> x;
    double value = 0;
    int evaluations = 0;
};

/// From `start` (moved into the bounds) until x or f stop changing in their tenth digit, or after `max_evaluations`.
/// Deterministic: sequential quadratic programming [Kraft1994]. What the objective throws comes out.
Minimum minimise(const Objective& objective, std::vector<double> start, const std::vector<double>& lower,
                 const std::vector<double>& upper, int max_evaluations);

}  // namespace searchlight
