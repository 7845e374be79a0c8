#include "kernel/burley_width.h"

#include <cmath>

#include "kernel/preintegrated.h"

namespace searchlight {

double burleyTransform(double d_mm, double omega) {
    const double square = d_mm * d_mm * omega * omega;
    return 0.25 * (1 / std::sqrt(1 + square) + 3 / std::sqrt(1 + 9 * square));
}

Rgb burleyWidth(const GroundTruth& truth) {
    const std::array<LineKernel, Rgb::channels> lines = lineSpread(truth);
    Rgb width;
    for (int c = 0; c < Rgb::channels; ++c) {
        if (!truth.scatters(c)) continue;
        const double radius = truth.radiusOf(0.5, c);
        std::vector<double> omegas, targets;
        for (double omega = 0.05 / radius; omega < 20 / radius; omega *= std::exp2(0.25)) {
            omegas.push_back(omega);
            targets.push_back(lines[static_cast<std::size_t>(c)].transform(omega));
        }
        const auto error = [&](double d) {
            double sum = 0;
            for (std::size_t i = 0; i < omegas.size(); ++i) {
                const double difference = burleyTransform(d, omegas[i]) - targets[i];
                sum += difference * difference / omegas[i];
            }
            return sum;
        };
        // One minimum over the logarithm of d: thirds, until a millionth is left.
        double low = std::log(1e-3 * radius), high = std::log(1e3 * radius);
        while (high - low > 1e-6) {
            const double a = low + (high - low) / 3, b = high - (high - low) / 3;
            if (error(std::exp(a)) < error(std::exp(b)))
                high = b;
            else
                low = a;
        }
        width[c] = std::exp(0.5 * (low + high));
    }
    return width;
}

}  // namespace searchlight
