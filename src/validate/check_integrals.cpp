// Energy, and the closed form of the total.
#include <fmt/format.h>

#include <cmath>

#include "base/text.h"
#include "model/plane.h"
#include "validate/check_bench.h"

namespace searchlight {

namespace {

Rgb total(CheckBench& bench, const Medium& medium, double angle_deg) {
    bench.pollCancelled();
    bench.evaluator().set(medium, bench.parameters());
    return totalRd(bench.evaluator(), bench.model(), medium, angle_deg);
}

}  // namespace

Finding checkEnergy(CheckBench& bench) {
    // A model that does not read wi returns the same at every angle.
    const std::vector<double> angles = bench.file().no_wi ? std::vector<double>{0} : std::vector<double>{0, 45, 80};
    double most = -1;
    std::string where;
    for (const Medium& medium : checkMedia()) {
        for (const double angle_deg : angles) {
            const Rgb sum = total(bench, medium, angle_deg);
            for (int c = 0; c < Rgb::channels; ++c) {
                const std::string place = fmt::format("{}{}", mediumText(medium, c),
                                                      angles.size() > 1 ? fmt::format(", {} deg", angle_deg) : "");
                if (!std::isfinite(sum[c])) return failed(fmt::format("the total is not finite at {}", place));
                if (sum[c] > most) {
                    most = sum[c];
                    where = place;
                }
            }
        }
    }
    const std::string found = fmt::format("largest total {} of what entered, at {}", prettyNumber(most), where);
    // Beyond 1 by more than the integral of rounded values can be.
    if (most <= 1 + bench.rounding())
        return passed(bench.file().energy_violation ? found + "; energy_violation is declared but was not found"
                                                    : found);
    return bench.file().energy_violation ? reported(found + ", as its authors declare") : failed(found);
}

Finding checkClosedForm(CheckBench& bench) {
    if (!bench.file().diffuse_reflectance.present()) return skipped("it has no section diffuseReflectance");
    // In double the integral is good to 1e-10 and a closed form to a few roundings; in float a sum of values with
    // relative errors of 1e-6 each, some of them one-sided.
    const double tolerance = bench.isNative() ? 1e-8 : 1e-4;
    Difference worst;
    for (const Medium& medium : checkMedia()) {
        const Rgb integral = total(bench, medium, 0);
        const Rgb closed = bench.evaluator().diffuseReflectance(medium.alphaPrime());
        for (int c = 0; c < Rgb::channels; ++c) {
            const double relative = std::abs(closed[c] - integral[c]) / std::abs(integral[c]);
            // Written so that NaN is a difference.
            if (!(relative <= worst.relative))
                worst = {relative, fmt::format("{}: {} for {}", mediumText(medium, c), prettyNumber(closed[c], 6),
                                               prettyNumber(integral[c], 6))};
            if (!(relative <= tolerance))
                return failed(
                    fmt::format("DiffuseReflectance is off by {} at {}", prettyNumber(relative, 2), worst.where));
        }
    }
    return passed(fmt::format("within {} of the integral", prettyNumber(worst.relative, 2)));
}

}  // namespace searchlight
