#include "render/exitance/radial_kernel.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

namespace searchlight {

namespace {

// A profile may be cut off where it still matters. A step would be a ring in the picture, and no expansion of a kernel
// holds across it, so the end becomes a slope between 0.9 and 1.1 times the last radius that holds the same flux.
class Fade {
public:
    explicit Fade(const Profile& profile) : profile_(profile), last_(profile.radii().back()) {
        Rgb plain, bump;
        constexpr int steps = 400;
        for (int i = 0; i < steps; ++i) {
            const double r = begin() + (i + 0.5) / steps * (end() - begin());
            const double s = step(r), weight = 2 * std::numbers::pi * r * (end() - begin()) / steps;
            const Rgb R = profile_(std::min(r, last_));
            plain = plain + weight * (1 - s) * R;
            bump = bump + weight * (1 - s) * 4 * s * (1 - s) * R;
        }
        const Rgb held = profile_.total() - profile_.encircled(begin());
        for (int c = 0; c < Rgb::channels; ++c) {
            // Where next to nothing is left, rounding decides: then nothing needs to be mended.
            const double share = bump[c] != 0 ? (held[c] - plain[c]) / bump[c] : 0;
            share_[c] = std::isfinite(share) ? std::clamp(share, -1.0, 1.0) : 0;
        }
    }

    double begin() const { return 0.9 * last_; }
    double end() const { return 1.1 * last_; }

    Rgb operator()(double r) const {
        if (r >= end()) return {};
        if (r <= begin()) return profile_(r);
        const double s = step(r);
        return (1 - s) * (Rgb{1, 1, 1} + 4 * s * (1 - s) * share_) * profile_(std::min(r, last_));
    }

private:
    // From 0 to 1 with three continuous derivatives.
    double step(double r) const {
        const double t = std::clamp((r - begin()) / (end() - begin()), 0.0, 1.0);
        return t * t * t * t * (35 + t * (-84 + t * (70 - 20 * t)));
    }

    const Profile& profile_;
    double last_;
    Rgb share_;
};

// Mean of R_d over a disc whose centre is at distance r, by the divergence theorem: of the field y E(|y|)/(2 pi |y|^2),
// E being the encircled flux, the divergence is R_d. No divergence of R_d at 0 is in the way.
Rgb discMeanNear(const Profile& profile, double radius, double r) {
    constexpr int angles = 64;
    Rgb sum;
    for (int i = 0; i < angles; ++i) {
        const double cosine = std::cos(std::numbers::pi * (i + 0.5) / angles);
        const double square = radius * radius + r * r - 2 * radius * r * cosine;
        sum = sum + (radius - r * cosine) / square * profile.encircled(std::sqrt(square));
    }
    return 1 / (std::numbers::pi * radius * angles) * sum;
}

// The same far away, where R_d is smooth over the disc: exact for polynomials of degree 5 ([Abramowitz1964] 25.4.61,
// n = 7).
template <class Function>
Rgb discMeanFar(const Function& Rd, double radius, double r) {
    const double ring = radius * std::sqrt(2.0 / 3.0);
    Rgb sum = 0.25 * Rd(r);
    for (int i = 0; i < 6; ++i) {
        const double angle = std::numbers::pi / 3 * (i + 0.5);
        sum = sum + 0.125 * Rd(std::hypot(r + ring * std::cos(angle), ring * std::sin(angle)));
    }
    return sum;
}

// Disc radii from which the profile is taken to be smooth over the disc: 1/r is then off by 2e-6.
constexpr double far = 8;

// Times the end, how far the nodes go on with zeros: a pair of tree nodes may stand further apart than the profile
// reaches and still have points that are close, which its distance has to tell.
constexpr double beyond = 8;

Rgb secondMoment(const Profile& profile) {
    Rgb flux, moment;
    const std::span<const double> radii = profile.radii();
    for (std::size_t i = 0; i + 1 < radii.size(); ++i) {
        const double r = 0.5 * (radii[i] + radii[i + 1]), width = radii[i + 1] - radii[i];
        const Rgb R = profile(r);
        for (int c = 0; c < Rgb::channels; ++c) {
            flux[c] += r * width * std::abs(R[c]);
            moment[c] += r * r * r * width * std::abs(R[c]);
        }
    }
    for (int c = 0; c < Rgb::channels; ++c) moment[c] = flux[c] > 0 ? moment[c] / flux[c] : 0;
    return moment;
}

}  // namespace

RadialKernel::RadialKernel(const Profile& profile, double cell_area_mm2)
    : total_(profile.total()), mean_square_radius_(secondMoment(profile)) {
    assert(cell_area_mm2 >= 0);
    // Points without area have no disc; the table needs one.
    const double radius = std::max(std::sqrt(cell_area_mm2 / std::numbers::pi), 1e-6 * profile.radii().back());
    offset_ = std::exp2(std::floor(std::log2(radius * radius / 16)));
    const Fade fade(profile);
    // Of a profile that ends within a few discs, the disc's own shape is the slope.
    const bool fades = profile.radii().back() > 2 * far * radius;
    const double end = fades ? fade.end() + 2 * radius : profile.radii().back() + 2 * radius;
    const double known = beyond * end;
    octaves_ = static_cast<std::size_t>(std::ceil(std::log2((known * known + offset_) / offset_)));
    const std::size_t count = nodes_per_octave * octaves_ + 1;
    values_.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
        const double r = std::sqrt(node(k) - offset_);
        if (r >= end) break;
        values_[k] = r < far * radius || !fades ? discMeanNear(profile, radius, r) : discMeanFar(fade, radius, r);
    }
    values_.back() = {};
}

double RadialKernel::node(std::size_t k) const {
    const std::size_t octave = k / nodes_per_octave, step = k % nodes_per_octave;
    return std::ldexp(offset_, static_cast<int>(octave)) * (1 + static_cast<double>(step) / nodes_per_octave);
}

Rgb RadialKernel::operator()(double r_mm) const {
    const double w = r_mm * r_mm + offset_;
    int octave = 0;
    const double mantissa = 2 * std::frexp(w / offset_, &octave);
    const double at = nodes_per_octave * (octave - 1 + mantissa - 1);
    if (!(at < static_cast<double>(values_.size() - 1))) return {};
    // Lagrange's polynomial through four nodes. Their spacing doubles at an octave.
    const std::size_t first = std::clamp<std::size_t>(static_cast<std::size_t>(at), 1, values_.size() - 3) - 1;
    std::array<double, 4> x;
    for (std::size_t i = 0; i < 4; ++i) x[i] = node(first + i);
    Rgb sum;
    for (std::size_t i = 0; i < 4; ++i) {
        double weight = 1;
        for (std::size_t j = 0; j < 4; ++j)
            if (j != i) weight *= (w - x[j]) / (x[i] - x[j]);
        sum = sum + weight * values_[first + i];
    }
    return sum;
}

}  // namespace searchlight
