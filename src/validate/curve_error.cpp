#include "validate/curve_error.h"

#include <cmath>
#include <numbers>

namespace searchlight {

CurveError curveError(std::span<const Rgb> model, std::span<const Rgb> reference, std::span<const Rgb> standard_error,
                      std::span<const double> edges_mm, int channel, double split_mm) {
    struct Sum {
        double difference = 0, reference = 0;
        double ratio() const { return reference > 0 ? difference / reference : 0; }
    } all, near, far;
    double noise = 0, squares = 0;
    int counted = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        const double r0 = edges_mm[i], r1 = edges_mm[i + 1];
        const double area = std::numbers::pi * (r1 * r1 - r0 * r0);
        const double truth = reference[i][channel], error = standard_error[i][channel];
        const double difference = std::abs(model[i][channel] - truth);
        Sum& part = (r0 + r1) / 2 < split_mm ? near : far;
        for (Sum* sum : {&all, &part}) {
            sum->difference += difference * area;
            sum->reference += truth * area;
        }
        // The mean of |normal| is sqrt(2 / pi) standard deviations.
        noise += std::sqrt(2 / std::numbers::pi) * error * area;
        if (truth > 0 && error < 0.05 * truth) {
            squares += std::pow(difference / truth, 2);
            ++counted;
        }
    }
    return {.weighted = all.ratio(),
            .near = near.ratio(),
            .far = far.ratio(),
            .relative_rms = counted > 0 ? std::sqrt(squares / counted) : 0,
            .noise = all.reference > 0 ? noise / all.reference : 0};
}

}  // namespace searchlight
