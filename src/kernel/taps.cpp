#include "kernel/taps.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace searchlight {

std::vector<double> quadraticOffsets(int count, double extent_mm) {
    assert(count >= 3 && count % 2 == 1 && extent_mm > 0);
    const int side = count / 2;
    std::vector<double> offsets;
    for (int i = -side; i <= side; ++i) {
        const double t = static_cast<double>(i) / side;
        offsets.push_back(extent_mm * t * std::abs(t));
    }
    return offsets;
}

Taps sampleTaps(const SeparableKernel& kernel, const std::vector<double>& offsets_mm) {
    const std::size_t count = offsets_mm.size(), middle = count / 2;
    assert(count % 2 == 1 && count >= 3);
    Taps taps{.extent_mm = offsets_mm.back()};
    for (const KernelTerm& term : kernel.terms) {
        TapTerm sampled{.angle_deg = term.angle_deg, .scale = term.scale, .offsets_mm = offsets_mm};
        sampled.weights.resize(count);
        for (int c = 0; c < Rgb::channels; ++c) {
            const LineKernel& line = term.lines[static_cast<std::size_t>(c)];
            sampled.delta[c] = line.delta();
            for (std::size_t i = middle; i < count; ++i) {
                const double from =
                    i == middle ? -0.5 * offsets_mm[middle + 1] : 0.5 * (offsets_mm[i - 1] + offsets_mm[i]);
                const double to =
                    i + 1 == count ? std::max(line.extent(), offsets_mm[i]) : 0.5 * (offsets_mm[i] + offsets_mm[i + 1]);
                sampled.weights[i][c] = sampled.weights[2 * middle - i][c] = line.integral(from, to);
            }
        }
        taps.terms.push_back(std::move(sampled));
    }
    return taps;
}

double tapExtent(const SeparableKernel& kernel, double rest) {
    double extent = 0;
    for (const KernelTerm& term : kernel.terms)
        for (const LineKernel& line : term.lines) {
            if (line.extent() == 0) continue;
            const double mass = std::abs(line.mass() - line.delta());
            double low = 0, high = line.extent();
            for (int i = 0; i < 60; ++i) {
                const double middle = 0.5 * (low + high);
                (2 * std::abs(line.integral(middle, line.extent())) > rest * mass ? low : high) = middle;
            }
            extent = std::max(extent, high);
        }
    return extent > 0 ? extent : 1;
}

}  // namespace searchlight
