#include "validate/model_shift.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace searchlight {

Rgb modelMeanX(Evaluator& evaluator, const Model& model, const Medium& medium, double angle_deg) {
    if (model.file.no_wi || angle_deg == 0) return {};
    constexpr double pi = std::numbers::pi;
    // Midpoints of a smooth periodic function converge exponentially; the beam lies in the plane y = 0. In the
    // logarithm of r the integrand is as smooth as that of totalRd.
    constexpr int azimuths = 32;
    constexpr double step = 0.25;
    double shortest = INFINITY, longest = 0;
    for (int c = 0; c < Rgb::channels; ++c) {
        if (!medium.scatters(c)) continue;
        shortest = std::min(shortest, 1 / medium.sigmaT()[c]);
        longest = std::max(longest, 1 / medium.sigmaTp()[c]);
    }
    std::vector<Vec3> points;
    for (double u = std::log(1e-4 * shortest); u < std::log(1e4 * longest); u += step)
        for (int k = 0; k < azimuths; ++k) {
            const double phi = pi * (k + 0.5) / azimuths, r = std::exp(u);
            points.push_back({r * std::cos(phi), r * std::sin(phi), 0});
        }
    const std::vector<Rgb> Rd = planeRd(evaluator, model, medium, angle_deg, points);
    Rgb total, moment;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double area = dot(points[i], points[i]);  // of the element, times a constant
        total = total + area * Rd[i];
        moment = moment + area * points[i].x * Rd[i];
    }
    return moment / total;
}

std::vector<double> modelPlane(Evaluator& evaluator, const Model& model, const Medium& medium, double angle_deg,
                               int channel, int cells, double cell_mm) {
    const int side = model.file.no_wo ? 8 : 2, rows = cells / 2;
    std::vector<Vec3> points;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < cells; ++x)
            for (int k = 0; k < side * side; ++k)
                points.push_back(
                    {cell_mm * (x - rows + (k % side + 0.5) / side), cell_mm * (y + (k / side + 0.5) / side), 0});
    const std::vector<Rgb> Rd = planeRd(evaluator, model, medium, angle_deg, points);
    std::vector<double> means(static_cast<std::size_t>(rows * cells));
    const auto count = static_cast<std::size_t>(side * side);
    for (std::size_t i = 0; i < Rd.size(); ++i) means[i / count] += Rd[i][channel] / static_cast<double>(count);
    return means;
}

}  // namespace searchlight
