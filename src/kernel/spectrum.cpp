#include "kernel/spectrum.h"

#include <cmath>
#include <numbers>

namespace searchlight {

namespace {

// The transform is smooth over the logarithm of the frequency: cubics through 12 nodes an octave are within 1e-6.
constexpr int nodes_per_octave = 12;

}  // namespace

RadialSpectrum::RadialSpectrum(const std::array<LineKernel, Rgb::channels>& lines, double lowest, double highest)
    : first_(lowest), per_octave_(nodes_per_octave) {
    const int count = static_cast<int>(std::ceil(per_octave_ * std::log2(highest / lowest))) + 3;
    for (int i = -1; i < count; ++i) {
        const double omega = first_ * std::exp2(i / per_octave_);
        values_.push_back({lines[0].transform(omega), lines[1].transform(omega), lines[2].transform(omega)});
    }
}

Rgb RadialSpectrum::operator()(double omega) const {
    if (omega < first_) return {1, 1, 1};
    const double at = per_octave_ * std::log2(omega / first_);
    const auto i = static_cast<std::size_t>(at);
    if (i + 3 >= values_.size()) return {};
    const double t = at - static_cast<double>(i);
    // Lagrange through four nodes, of which the second and third enclose the frequency.
    const double a = -t * (t - 1) * (t - 2) / 6, b = (t + 1) * (t - 1) * (t - 2) / 2, c = -(t + 1) * t * (t - 2) / 2,
                 d = (t + 1) * t * (t - 1) / 6;
    return a * values_[i] + b * values_[i + 1] + c * values_[i + 2] + d * values_[i + 3];
}

double tapsTransform(const TapTerm& term, int channel, double omega, double width) {
    const std::size_t middle = term.offsets_mm.size() / 2;
    double sum = term.delta[channel] + term.weights[middle][channel];
    for (std::size_t i = middle + 1; i < term.offsets_mm.size(); ++i)
        sum += 2 * term.weights[i][channel] * std::cos(omega * width * term.offsets_mm[i]);
    return sum;
}

Rgb tapsTransform(const Taps& taps, double omega_x, double omega_y, double width) {
    Rgb sum;
    for (const TapTerm& term : taps.terms) {
        const double angle = term.angle_deg * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
        for (int k = 0; k < Rgb::channels; ++k)
            sum[k] += term.scale[k] * tapsTransform(term, k, c * omega_x + s * omega_y, width) *
                      tapsTransform(term, k, c * omega_y - s * omega_x, width);
    }
    return sum;
}

}  // namespace searchlight
