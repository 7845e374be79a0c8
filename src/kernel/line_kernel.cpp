#include "kernel/line_kernel.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace searchlight {

LineKernel::LineKernel(std::vector<double> x_mm, std::vector<double> integral, std::vector<double> density,
                       double delta)
    : x_(std::move(x_mm)), integral_(std::move(integral)), density_(std::move(density)), delta_(delta) {
    assert(x_.size() >= 2 && integral_.size() == x_.size() && density_.size() == x_.size());
    assert(x_.front() == 0 && integral_.front() == 0 && std::ranges::is_sorted(x_));
}

namespace {

std::size_t intervalOf(const std::vector<double>& x, double at) {
    const auto above = std::upper_bound(x.begin() + 1, x.end() - 1, at);
    return static_cast<std::size_t>(above - x.begin()) - 1;
}

}  // namespace

double LineKernel::fromZero(double x_mm) const {
    if (x_.empty()) return 0;
    const double x = std::min(std::abs(x_mm), x_.back());
    const std::size_t i = intervalOf(x_, x);
    const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h, u = 1 - t;
    const double value = u * u * (1 + 2 * t) * integral_[i] + t * t * (3 - 2 * t) * integral_[i + 1] +
                         h * t * u * (u * density_[i] - t * density_[i + 1]);
    return std::copysign(1.0, x_mm) * value;
}

double LineKernel::operator()(double x_mm) const {
    const double x = std::abs(x_mm);
    if (x_.empty() || x >= x_.back()) return 0;
    const std::size_t i = intervalOf(x_, x);
    const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h, u = 1 - t;
    return 6 * t * u * (integral_[i + 1] - integral_[i]) / h + u * (1 - 3 * t) * density_[i] +
           t * (1 - 3 * u) * density_[i + 1];
}

double LineKernel::transform(double omega) const {
    // Gauss-Legendre with 3 points, exact for the parabola times what cos is within half a radian.
    constexpr double at[] = {0.11270166537925831, 0.5, 0.88729833462074169};
    constexpr double weight[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    double sum = 0;
    for (std::size_t i = 0; i + 1 < x_.size(); ++i) {
        const double h = x_[i + 1] - x_[i], mean = (integral_[i + 1] - integral_[i]) / h;
        const double first = density_[i], last = density_[i + 1];
        // The density is first + t slope + t^2 bend.
        const double slope = 6 * mean - 4 * first - 2 * last, bend = 3 * (first + last) - 6 * mean;
        if (omega * h < 0.5) {
            for (int k = 0; k < 3; ++k)
                sum += h * weight[k] * (first + at[k] * (slope + at[k] * bend)) * std::cos(omega * (x_[i] + at[k] * h));
            continue;
        }
        // By parts until nothing is left of the parabola.
        const double w = omega * h, c0 = std::cos(omega * x_[i]), s0 = std::sin(omega * x_[i]);
        const double c1 = std::cos(omega * x_[i + 1]), s1 = std::sin(omega * x_[i + 1]);
        sum += h * ((last * s1 - first * s0) / w + ((slope + 2 * bend) * c1 - slope * c0) / (w * w) -
                    2 * bend * (s1 - s0) / (w * w * w));
    }
    return delta_ + 2 * sum;
}

LineKernel LineKernel::scaled(double factor) const {
    LineKernel result = *this;
    for (double& value : result.integral_) value *= factor;
    for (double& value : result.density_) value *= factor;
    result.delta_ *= factor;
    return result;
}

}  // namespace searchlight
