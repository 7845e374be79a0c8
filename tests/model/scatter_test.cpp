// physics/scatter.glsl, through its double-precision twin.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/physics.h"

namespace searchlight {
namespace {

using P = Physics<double>;

// Moments of Henyey-Greenstein are powers of g, by the midpoint rule over the uniform number: 1e5 points leave 1e-9
// but for g near 1, where the inverse is steep.
TEST(Scatter, VersinesHaveTheMomentsOfHenyeyGreenstein) {
    for (const double g : {-0.9, -0.3, 0.0, 1e-6, 0.5, 0.9, 0.99}) {
        constexpr int points = 100'000;
        double first = 0, second = 0;
        for (int i = 0; i < points; ++i) {
            const double mu = 1 - P::henyeyGreensteinVersine(g, 2 * (i + 0.5) / points - 1);
            first += mu / points;
            second += 0.5 * (3 * mu * mu - 1) / points;
        }
        EXPECT_NEAR(first, g, 1e-6) << g;
        EXPECT_NEAR(second, g * g, 1e-6) << g;
    }
}

// Of forward scattering the inverse must not drown in 1 - cos: the versine of s near 1 is (1 - g)^2 (1 - s) / (2 (1 +
// g)) to first order.
TEST(Scatter, SmallVersinesKeepTheirDigits) {
    const double g = 0.99, s = 1 - 1e-12;
    EXPECT_NEAR(P::henyeyGreensteinVersine(g, s) / (0.5 * 0.01 * 0.01 * (1 - s) * 2 / (1 + g)), 1, 1e-10);
}

TEST(Scatter, ATurnHasItsAngleAndItsAzimuth) {
    for (const glsl::Vec<double, 3>& from :
         {glsl::Vec<double, 3>{0, 0, 1}, glsl::Vec<double, 3>{0, 0, -1}, glsl::Vec<double, 3>{0.6, 0.48, 0.64},
          glsl::Vec<double, 3>{-0.8, 0.6, 0}, glsl::Vec<double, 3>{1e-9, 0, -1}})
        for (const double versine : {1e-12, 0.1, 1.0, 1.9, 2.0}) {
            double sum[3] = {};
            for (int i = 0; i < 8; ++i) {
                const double phi = std::numbers::pi / 4 * i;
                const auto to = P::turnedDirection(from, versine, std::cos(phi), std::sin(phi));
                double length2 = 0, cosine = 0;
                for (int k = 0; k < 3; ++k) {
                    length2 += to[k] * to[k], cosine += to[k] * from[k];
                    sum[k] += to[k] / 8;
                }
                EXPECT_NEAR(length2, 1, 1e-12);
                EXPECT_NEAR(cosine, 1 - versine, 1e-12);
            }
            // Azimuths that are evenly spread leave the part along `from`.
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(sum[k], (1 - versine) * from[k], 1e-12);
        }
}

}  // namespace
}  // namespace searchlight
