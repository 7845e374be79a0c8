#include "kernel/preintegrated.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace searchlight {

namespace {

// Abscissae and weights of Gauss-Legendre quadrature on [0, 1].
constexpr std::array<double, 6> abscissa{0.033765242898423987, 0.16939530676686775, 0.38069040695840156,
                                         0.61930959304159844,  0.83060469323313225, 0.96623475710157601};
constexpr std::array<double, 6> weight{0.085662246189585173, 0.18038078652406930, 0.23395696728634552,
                                       0.23395696728634552,  0.18038078652406930, 0.085662246189585173};

struct LineValues {
    Rgb strip;    // energy in |x'| < x
    Rgb density;  // a(x)
};

// A ring of radius r has the part (2 / pi) asin(x / r) within |x'| < x; integrating by parts leaves the encircled
// energy, which is smooth where R_d is not. With r = x cosh t both integrands are smooth at r = x.
LineValues lineValues(const GroundTruth& truth, double x, double end) {
    LineValues values;
    const double far = std::acosh(end / x);
    const int panels = std::max(1, static_cast<int>(std::ceil(4 * far)));
    const double h = far / panels;
    for (int i = 0; i < panels; ++i)
        for (std::size_t k = 0; k < abscissa.size(); ++k) {
            const double cosh = std::cosh(h * (i + abscissa[k]));
            values.strip = values.strip + (h * weight[k] / cosh) * truth.encircled(x * cosh);
            values.density = values.density + (2 * h * weight[k] * x * cosh) * truth(x * cosh);
        }
    values.strip = (2 / std::numbers::pi) * (values.strip + std::asin(x / end) * truth.encircled(end));
    return values;
}

}  // namespace

std::array<LineKernel, Rgb::channels> lineSpread(const GroundTruth& truth) {
    const double end = truth.extent();
    // Where half of the narrowest channel's energy lies gives the scale of the peak.
    double narrow = end;
    for (int c = 0; c < Rgb::channels; ++c)
        if (truth.scatters(c)) narrow = std::min(narrow, truth.radiusOf(0.5, c));
    // Below 1e-4 of it the integral of the line is straight. Nodes are 6 % apart where the line is a power, and evenly
    // spaced where it falls exponentially.
    const double first = 1e-4 * narrow, step = end / 400;
    std::vector<double> x{0, first};
    while (x.back() < end) x.push_back(std::min(x.back() + std::min(x.back() / 16, step), end));
    std::array<std::vector<double>, Rgb::channels> integral, density;
    for (std::size_t i = 1; i < x.size(); ++i) {
        const LineValues values =
            i + 1 < x.size() ? lineValues(truth, x[i], end) : LineValues{truth.encircled(end), {}};
        for (int c = 0; c < Rgb::channels; ++c) {
            integral[static_cast<std::size_t>(c)].push_back(values.strip[c] / 2);
            density[static_cast<std::size_t>(c)].push_back(values.density[c]);
        }
    }
    std::array<LineKernel, Rgb::channels> lines;
    for (std::size_t c = 0; c < lines.size(); ++c) {
        if (!truth.scatters(static_cast<int>(c))) continue;
        integral[c].insert(integral[c].begin(), 0);
        density[c].insert(density[c].begin(), integral[c][1] / first);
        lines[c] = LineKernel(x, std::move(integral[c]), std::move(density[c]));
    }
    return lines;
}

SeparableKernel preintegrated(const GroundTruth& truth) {
    SeparableKernel kernel{.method = "preintegrated", .terms = {{}}, .extent_mm = truth.extent()};
    kernel.terms[0].lines = lineSpread(truth);
    return kernel;
}

}  // namespace searchlight
