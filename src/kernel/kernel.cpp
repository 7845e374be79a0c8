#include "kernel/kernel.h"

#include <cmath>
#include <numbers>

namespace searchlight {

Rgb KernelTerm::mass() const {
    Rgb mass;
    for (int c = 0; c < Rgb::channels; ++c) {
        const double line = lines[static_cast<std::size_t>(c)].mass();
        mass[c] = scale[c] * line * line;
    }
    return mass;
}

Rgb SeparableKernel::operator()(double x_mm, double y_mm) const {
    Rgb sum;
    for (const KernelTerm& term : terms) {
        const double angle = term.angle_deg * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
        const double u = c * x_mm + s * y_mm, v = c * y_mm - s * x_mm;
        for (int k = 0; k < Rgb::channels; ++k) {
            const LineKernel& line = term.lines[static_cast<std::size_t>(k)];
            sum[k] += term.scale[k] * line(u) * line(v);
        }
    }
    return sum;
}

Rgb SeparableKernel::mass() const {
    Rgb mass;
    for (const KernelTerm& term : terms) mass = mass + term.mass();
    return mass;
}

Rgb TapTerm::mass() const {
    Rgb line = delta;
    for (const Rgb& weight : weights) line = line + weight;
    return scale * line * line;
}

Rgb TapTerm::weight(std::size_t i) const { return i == weights.size() / 2 ? weights[i] + delta : weights[i]; }

Rgb Taps::mass() const {
    Rgb mass;
    for (const TapTerm& term : terms) mass = mass + term.mass();
    return mass;
}

}  // namespace searchlight
