#include "transport/walk/diffusion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace searchlight {
namespace {

TEST(Diffusion, LegendreSumsAreTheirPowers) {
    std::vector<double> coefficients;
    for (int l = 0; l < 9; ++l) coefficients.push_back(std::cos(l + 0.3));
    const std::vector<double> powers = powersOfLegendre(coefficients);
    ASSERT_EQ(powers.size(), coefficients.size());
    for (const double w : {-0.9, -0.2, 0.0, 0.5, 1.0}) {
        double sum = 0, truth = 0;
        for (std::size_t i = powers.size(); i-- > 0;) sum = sum * w + powers[i];
        for (unsigned l = 0; l < 9; ++l)  // of negative w by parity: P_l(-w) = (-1)^l P_l(w)
            truth += coefficients[l] * (w < 0 && l % 2 == 1 ? -1 : 1) * std::legendre(l, std::abs(w));
        EXPECT_NEAR(sum, truth, 1e-12) << w;  // rounding
    }
    EXPECT_TRUE(powersOfLegendre({}).empty());
}

}  // namespace
}  // namespace searchlight
