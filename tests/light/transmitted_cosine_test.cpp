#include "light/transmitted_cosine.h"

#include <cmath>
#include <numbers>

namespace searchlight {
namespace {

TEST(TransmittedCosine, IntegratesToThePublishedMoments) {
    // docs/conventions.md, pi 4 C_phi(1/eta), to the digits that it states.
    for (const auto& [eta, value] : {std::pair{1.3, 2.94954}, {1.5, 2.85326}, {1.0, std::numbers::pi}}) {
        double sum = 0;
        constexpr int steps = 200000;
        for (int i = 0; i < steps; ++i) sum += transmittedCosine((i + 0.5) / steps, eta) / steps;
        EXPECT_NEAR(2 * std::numbers::pi * sum, value, 5e-6);
    }
}

TEST(TransmittedCosine, IsZeroFromBehindAndBeyondTheCriticalAngle) {
    EXPECT_EQ(transmittedCosine(-0.5, 1.3), 0);
    const double critical = std::sqrt(1 - 0.64);
    EXPECT_EQ(transmittedCosine(critical - 0.01, 0.8), 0);
    EXPECT_GT(transmittedCosine(critical + 0.01, 0.8), 0);
    EXPECT_EQ(TransmittedCosine(0.8)(static_cast<float>(critical - 0.01)), 0);
    EXPECT_EQ(TransmittedCosine(1.3)(-1), 0);
}

TEST(TransmittedCosine, AtNormalIncidenceIsTheClosedForm) {
    for (const double eta : {0.7, 1.3, 2.0}) {
        const double reflected = std::pow((eta - 1) / (eta + 1), 2);
        EXPECT_NEAR(transmittedCosine(1, eta), 1 - reflected, 1e-14);
        EXPECT_NEAR(TransmittedCosine(eta)(1), 1 - reflected, 1e-7);
    }
}

TEST(TransmittedCosine, TableIsWithinItsStatedError) {
    for (const double eta : {0.25, 0.75, 0.99, 1.0, 1.00001, 1.0001, 1.001, 1.05, 1.3, 1.5, 4.0}) {
        const TransmittedCosine table(eta);
        double largest = 0;
        for (int i = 0; i <= 100000; ++i) {
            const float mu = static_cast<float>(i) / 100000;
            largest = std::max(largest, std::abs(table(mu) - transmittedCosine(mu, eta)));
        }
        EXPECT_LT(largest, eta != 1 && std::abs(eta - 1) < 1e-3 ? 5e-5 : 1e-5) << eta;
    }
}

}  // namespace
}  // namespace searchlight
