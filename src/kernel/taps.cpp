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

Taps quadraticTaps(const SeparableKernel& kernel, int count, double rest) {
    Taps taps;
    for (const KernelTerm& term : kernel.terms) {
        const SeparableKernel alone{.terms = {term}};
        Taps sampled = sampleTaps(alone, quadraticOffsets(count, tapExtent(alone, rest)));
        taps.extent_mm = std::max(taps.extent_mm, sampled.extent_mm);
        taps.terms.push_back(std::move(sampled.terms[0]));
    }
    return taps;
}

double tapExtent(const SeparableKernel& kernel, double rest) {
    double extent = 0;
    for (const KernelTerm& term : kernel.terms)
        for (const LineKernel& line : term.lines) {
            const std::span<const double> x = line.nodes();
            if (x.empty()) continue;
            std::vector<double> within{0};
            for (std::size_t i = 0; i + 1 < x.size(); ++i)
                within.push_back(within.back() + std::abs(line.integral(x[i], x[i + 1])));
            const double goal = (1 - rest) * within.back();
            const auto above = static_cast<std::size_t>(std::ranges::lower_bound(within, goal) - within.begin());
            if (above == 0 || above >= x.size()) continue;
            const double t = (goal - within[above - 1]) / (within[above] - within[above - 1]);
            extent = std::max(extent, std::lerp(x[above - 1], x[above], t));
        }
    return extent > 0 ? extent : 1;
}

}  // namespace searchlight
