// Walks led back to the surface.
#include "transport/half_space/guided_walk.h"

#include <gtest/gtest.h>

#include <cmath>

#include "judge.h"
#include "transport/walk/tally.h"

namespace searchlight {
namespace {

// Isotropic: albedo = kappa / atanh(kappa), and psi is 1 / (1 + kappa w), here to the third Legendre order.
TEST(GuidedWalk, KappaSolvesTheDispersionRelation) {
    for (const double absorbed : {1e-6, 0.001, 0.05, 0.2, 0.4}) {
        const GuidedWalk guided({.absorbed = absorbed});
        EXPECT_NEAR(guided.kappa / std::atanh(guided.kappa), 1 - absorbed, 1e-12);
    }
    EXPECT_LT(GuidedWalk({.absorbed = 0}).kappa, 1e-12);
}

// Diffusion: kappa^2 = 3 (1 - a) (1 - a g), psi = 1 - 3 D kappa w with D = 1 / (3 (1 - a g)); to second order.
TEST(GuidedWalk, IsThatOfDiffusionWithLittleAbsorption) {
    for (const double g : {-0.5, 0.3, 0.9}) {
        const double absorbed = 1e-8, transport = 1 - (1 - absorbed) * g;
        const GuidedWalk guided({.absorbed = absorbed, .g = g});
        EXPECT_NEAR(guided.kappa / std::sqrt(3 * absorbed * transport), 1, 1e-6);
        EXPECT_NEAR(guided.psi[1] / guided.psi[0], -guided.kappa / transport, 1e-6 * guided.kappa / transport);
        EXPECT_NEAR(guided.after[1], g * guided.psi[1], 1e-6 * guided.kappa);
    }
}

TEST(GuidedWalk, PsiIsPositiveAndBounded) {
    for (const double g : {-0.9, 0.0, 0.5, 0.95})
        for (const double absorbed : {1e-9, 0.01, 0.3, 0.9}) {
            const GuidedWalk guided({.absorbed = absorbed, .g = g});
            for (int i = 0; i <= 1000; ++i) {
                const double w = -1 + i / 500.0;
                const auto& p = guided.psi;
                const double psi = p[0] + w * (p[1] + w * (p[2] + w * p[3]));
                EXPECT_GT(psi, 0.09);
                EXPECT_LE(psi, guided.most);
            }
        }
}

// 1 - H(1) sqrt(1 - albedo) with H(1) = 1.850099 (tests/data/transport/halfspace_isotropic_matched.csv). All walks
// leave, with weights that differ by 20 % or so: 1e4 of them know the total within 1e-3; that is 2 % of the spread of
// counts.
TEST(GuidedWalk, KnowsTheTotalOfTheMatchedHalfSpace) {
    const GuidedSums sums = walkGuidedChunk(GuidedWalk({.absorbed = 0.1}), 1, 0, 10'000);
    EXPECT_NEAR(sums.total / 1e4, 1 - 1.850099 * std::sqrt(0.1), 2e-3);
}

// Their means are what optional stopping says, and they follow the moments: correlations are .93 to .999, but .7 where
// forward scattering meets a surface that reflects much.
TEST(GuidedWalk, ControlsHaveTheirMeansAndFollowTheMoments) {
    Judge judge;
    std::uint64_t seed = 70;
    for (const double g : {-0.4, 0.0, 0.3, 0.9})
        for (const double eta : {1.0, 1.5})
            for (const double sine : {0.0, 0.5}) {
                const GuidedWalk guided(
                    {.absorbed = 0.02, .g = g, .eta = eta, .sin_beam = sine, .cos_beam = std::sqrt(1 - sine * sine)});
                ASSERT_GT(guided.inverse_kappa, 0);
                constexpr int chunks = 64;
                constexpr std::uint64_t walks = 2000;
                BatchRatios sums(2);
                double rr = 0, rc = 0, cc = 0, r = 0, c = 0;
                for (std::uint64_t chunk = 0; chunk < chunks; ++chunk) {
                    const GuidedSums all = walkGuidedChunk(guided, seed, chunk, walks);
                    const double controls[] = {all.x_control, all.r2_control};
                    sums.add(controls, static_cast<double>(walks));
                    r += all.r2 / chunks, c += all.r2_control / chunks;
                    rr += all.r2 * all.r2 / chunks, cc += all.r2_control * all.r2_control / chunks;
                    rc += all.r2 * all.r2_control / chunks;
                }
                ++seed;
                if (g != 0) judge.compare("control of x", sums.estimate(0, chunks * walks), 0);
                judge.compare("control of r^2", sums.estimate(1, chunks * walks), 0);
                const double correlation = (rc - r * c) / std::sqrt((rr - r * r) * (cc - c * c));
                EXPECT_GT(correlation, 0.6) << "g " << g << ", eta " << eta;
            }
    judge.expectAgreement();
}

}  // namespace
}  // namespace searchlight
