#include "model/profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <numbers>

#include "base/error.h"

namespace searchlight {

namespace {

// Derivative at x[k] of the polynomial through the samples [first, last), by Lagrange's formula.
double polynomialSlope(std::span<const double> x, std::span<const Rgb> y, std::size_t k, std::size_t first,
                       std::size_t last, int channel) {
    double slope = 0;
    for (std::size_t i = first; i < last; ++i) {
        if (i == k) continue;
        double weight = 1 / (x[i] - x[k]);
        for (std::size_t j = first; j < last; ++j)
            if (j != i && j != k) weight *= (x[k] - x[j]) / (x[i] - x[j]);
        slope += weight * (y[i][channel] - y[k][channel]);
    }
    return slope;
}

// Fourth-order slopes, limited so that the cubic stays monotone between samples: [FritschCarlson1980].
std::vector<Rgb> monotoneSlopes(std::span<const double> x, std::span<const Rgb> y) {
    const std::size_t n = x.size();
    std::vector<Rgb> slopes(n);
    for (int c = 0; c < Rgb::channels; ++c) {
        const auto secant = [&](std::size_t k) { return (y[k + 1][c] - y[k][c]) / (x[k + 1] - x[k]); };
        for (std::size_t k = 0; k < n; ++k) {
            const double before = secant(k == 0 ? 0 : k - 1);
            const double after = secant(k + 1 == n ? k - 1 : k);
            if (before * after <= 0) continue;
            // Of five samples, k in the middle where it can be.
            const std::size_t first = n < 5 ? 0 : std::clamp<std::size_t>(k, 2, n - 3) - 2;
            const double slope = polynomialSlope(x, y, k, first, std::min(first + 5, n), c);
            const double limit = 3 * std::min(std::abs(before), std::abs(after));
            if (slope * before > 0) slopes[k][c] = std::copysign(std::min(std::abs(slope), limit), before);
        }
    }
    return slopes;
}

// R_d(r) = sum of coefficient[i] t^i with r = r0 + h t.
struct Cubic {
    double coefficient[4];
    double r0, h;

    Cubic(double r0_, double r1, double y0, double y1, double slope0, double slope1) : r0(r0_), h(r1 - r0_) {
        const double m0 = h * slope0, m1 = h * slope1;
        coefficient[0] = y0;
        coefficient[1] = m0;
        coefficient[2] = 3 * (y1 - y0) - 2 * m0 - m1;
        coefficient[3] = 2 * (y0 - y1) + m0 + m1;
    }

    double operator()(double r) const {
        const double t = (r - r0) / h;
        return coefficient[0] + t * (coefficient[1] + t * (coefficient[2] + t * coefficient[3]));
    }

    // Integral of 2 pi r R_d over [r0, r].
    double encircled(double r) const {
        const double t = (r - r0) / h;
        double sum = 0;
        for (int i = 3; i >= 0; --i) sum = t * sum + coefficient[i] * (r0 / (i + 1) + h * t / (i + 2));
        return 2 * std::numbers::pi * h * t * sum;
    }
};

std::size_t intervalOf(std::span<const double> radii, double r) {
    const auto above = std::upper_bound(radii.begin() + 1, radii.end() - 1, r);
    return static_cast<std::size_t>(above - radii.begin()) - 1;
}

Cubic cubic(std::span<const double> r, std::span<const Rgb> y, std::span<const Rgb> slope, std::size_t i, int c) {
    return {r[i], r[i + 1], y[i][c], y[i + 1][c], slope[i][c], slope[i + 1][c]};
}

}  // namespace

Profile::Profile(std::vector<double> radii_mm, std::vector<Rgb> values)
    : radii_mm_(std::move(radii_mm)), values_(std::move(values)) {
    assert(radii_mm_.size() == values_.size());
    if (radii_mm_.size() < 2) throw inputError("a profile needs at least 2 radii");
    if (!(radii_mm_.front() >= 0)) throw inputError("the first radius of a profile is negative");
    for (std::size_t i = 0; i < radii_mm_.size(); ++i) {
        for (int c = 0; c < Rgb::channels; ++c)
            if (!std::isfinite(values_[i][c]))
                throw inputError(fmt::format("the profile is not finite at r = {} mm", radii_mm_[i]));
        if (i > 0 && !(radii_mm_[i] > radii_mm_[i - 1] && std::isfinite(radii_mm_[i])))
            throw inputError(
                fmt::format("the radii of a profile must ascend: {} mm after {} mm", radii_mm_[i], radii_mm_[i - 1]));
    }
    slopes_ = monotoneSlopes(radii_mm_, values_);
    cumulative_.reserve(radii_mm_.size());
    cumulative_.push_back(std::numbers::pi * radii_mm_[0] * radii_mm_[0] * values_[0]);
    for (std::size_t i = 0; i + 1 < radii_mm_.size(); ++i) {
        Rgb sum = cumulative_.back();
        for (int c = 0; c < Rgb::channels; ++c)
            sum[c] += cubic(radii_mm_, values_, slopes_, i, c).encircled(radii_mm_[i + 1]);
        cumulative_.push_back(sum);
    }
}

Rgb Profile::operator()(double r_mm) const {
    if (r_mm <= radii_mm_.front()) return values_.front();
    if (r_mm > radii_mm_.back()) return {};
    const std::size_t i = intervalOf(radii_mm_, r_mm);
    Rgb value;
    for (int c = 0; c < Rgb::channels; ++c) value[c] = cubic(radii_mm_, values_, slopes_, i, c)(r_mm);
    return value;
}

double Profile::encircledIn(std::size_t interval, double r_mm, int channel) const {
    return cumulative_[interval][channel] + cubic(radii_mm_, values_, slopes_, interval, channel).encircled(r_mm);
}

Rgb Profile::encircled(double r_mm) const {
    if (r_mm <= radii_mm_.front()) return std::numbers::pi * r_mm * r_mm * values_.front();
    if (r_mm >= radii_mm_.back()) return total();
    const std::size_t i = intervalOf(radii_mm_, r_mm);
    return {encircledIn(i, r_mm, 0), encircledIn(i, r_mm, 1), encircledIn(i, r_mm, 2)};
}

Rgb Profile::total() const { return cumulative_.back(); }

Rgb Profile::annulusMean(double r0_mm, double r1_mm) const {
    assert(r0_mm < r1_mm);
    return 1 / (std::numbers::pi * (r1_mm - r0_mm) * (r1_mm + r0_mm)) * (encircled(r1_mm) - encircled(r0_mm));
}

double Profile::sampleRadius(double u, int channel) const {
    assert(u >= 0 && u < 1 && total()[channel] > 0);
    const double target = u * total()[channel];
    if (target <= cumulative_.front()[channel])
        return radii_mm_.front() > 0 ? std::sqrt(target / (std::numbers::pi * values_.front()[channel])) : 0;
    const auto above = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, target,
                                        [=](double value, const Rgb& sum) { return value < sum[channel]; });
    const auto i = static_cast<std::size_t>(above - cumulative_.begin()) - 1;
    double low = radii_mm_[i], high = radii_mm_[i + 1];
    double r = 0.5 * (low + high);
    // Newton inside a bracket: d(encircled)/dr = 2 pi r R_d. 60 halvings exhaust a double.
    for (int step = 0; step < 60 && high - low > 1e-14 * high; ++step) {
        const double excess = encircledIn(i, r, channel) - target;
        (excess > 0 ? high : low) = r;
        const double density = 2 * std::numbers::pi * r * cubic(radii_mm_, values_, slopes_, i, channel)(r);
        const double next = density > 0 ? r - excess / density : low;
        if (std::abs(next - r) <= 1e-14 * r) return next;
        r = next > low && next < high ? next : 0.5 * (low + high);
    }
    return r;
}

}  // namespace searchlight
