// physics/fresnel.glsl, through its double-precision twin.
#include <numbers>

#include "model/physics.h"

namespace searchlight {
namespace {

using Fresnel = Physics<double>;

// The moment by another road: tanh-sinh in the cosine itself, below and above the critical cosine.
double momentByQuadrature(int k, double eta) {
    const double critical = eta > 1 ? std::sqrt(1 - 1 / (eta * eta)) : 0;
    double sum = 0;
    const double h = 1 / 64.0;
    for (int i = -256; i <= 256; ++i) {
        const double u = 0.5 * std::numbers::pi * std::sinh(h * i);
        const double mu = critical + (1 - critical) / (1 + std::exp(-2 * u));
        const double weight = 0.5 * std::numbers::pi * std::cosh(h * i) / std::pow(std::cosh(u), 2);
        sum += 0.5 * h * (1 - critical) * weight * Fresnel::fresnelReflectance(mu, eta) * std::pow(mu, k);
    }
    return sum + std::pow(critical, k + 1) / (k + 1);
}

// 2 C_1 for light from outside, n > 1: [Walsh1926], also in [Duntley1942].
double walsh(double n) {
    const double n2 = n * n, n4 = n2 * n2;
    return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
           n2 * std::pow(n2 - 1, 2) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
           2 * n2 * n * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
           8 * n4 * (n4 + 1) / ((n2 + 1) * std::pow(n4 - 1, 2)) * std::log(n);
}

TEST(Fresnel, NormalIncidenceIsTheSquareOfTheIndexContrast) {
    EXPECT_NEAR(Fresnel::fresnelReflectance(1, 1.5), 0.04, 1e-15);
    EXPECT_NEAR(Fresnel::fresnelReflectance(1, 1 / 1.5), 0.04, 1e-15);
}

TEST(Fresnel, BrewsterAngleLeavesHalfOfTheSPolarisation) {
    const double n = 1.5, mu = 1 / std::sqrt(1 + n * n);
    const double r_s = (n * n - 1) / (n * n + 1);
    EXPECT_NEAR(Fresnel::fresnelReflectance(mu, 1 / n), 0.5 * r_s * r_s, 1e-15);
}

TEST(Fresnel, ReflectanceIsTheSameAlongBothEndsOfARay) {
    for (const double mu : {0.05, 0.3, 0.8, 0.99}) {
        const double mu_inside = std::sqrt(1 - (1 - mu * mu) / (1.33 * 1.33));
        EXPECT_NEAR(Fresnel::fresnelReflectance(mu, 1 / 1.33), Fresnel::fresnelReflectance(mu_inside, 1.33), 1e-14);
    }
}

TEST(Fresnel, ReflectionIsTotalBeyondTheCriticalAngle) {
    const double critical = std::sqrt(1 - 1 / (1.3 * 1.3));
    EXPECT_EQ(Fresnel::fresnelReflectance(0.999 * critical, 1.3), 1);
    EXPECT_LT(Fresnel::fresnelReflectance(1.001 * critical, 1.3), 1);
    EXPECT_EQ(Fresnel::fresnelReflectance(0, 1.0), 1);
}

TEST(FresnelMoments, VanishExactlyAtMatchedIndices) {
    for (const int k : {1, 2}) {
        EXPECT_EQ(Fresnel::fresnelMoment(k, 1), 0);
        EXPECT_EQ(Fresnel::fresnelMomentPublished(k, 1), 0);
    }
    EXPECT_EQ(Fresnel::fresnelDiffusePublished(1), 0);
    EXPECT_EQ(Fresnel::reflectionParameter(0, 0), 1);
}

TEST(FresnelMoments, AreContinuousAtMatchedIndices) {
    for (const double eta : {1 - 1e-6, 1 + 1e-6})
        for (const int k : {1, 2}) EXPECT_LT(Fresnel::fresnelMoment(k, eta), 2e-6);
}

TEST(FresnelMoments, AgreeWithAnotherQuadrature) {
    for (const double eta : {1.0001, 1.01, 1.1, 1.33, 1.5, 2.0, 3.0, 4.0, 0.99, 1 / 1.1, 1 / 1.33, 0.5, 0.25})
        for (const int k : {1, 2})
            EXPECT_NEAR(Fresnel::fresnelMoment(k, eta), momentByQuadrature(k, eta), 1e-12) << eta;
}

// Cancellation in the closed form grows towards n = 1, hence 1e-11.
TEST(FresnelMoments, FirstFromOutsideIsWalshsClosedForm) {
    for (const double n : {1.2, 1.3, 1.5, 2.0, 3.0}) EXPECT_NEAR(2 * Fresnel::fresnelMoment(1, 1 / n), walsh(n), 1e-11);
}

// 5 published digits.
TEST(FresnelMoments, AreAsPublishedForIndex1_3) {
    EXPECT_NEAR(2 * Fresnel::fresnelMoment(1, 1.3), 0.44446, 0.5e-5);
    EXPECT_NEAR(3 * Fresnel::fresnelMoment(2, 1.3), 0.30027, 0.5e-5);
}

TEST(FresnelMoments, TransmissionIsReciprocal) {
    for (const double n : {1.05, 1.3, 1.5, 2.5})
        EXPECT_NEAR(n * n * (1 - 2 * Fresnel::fresnelMoment(1, n)), 1 - 2 * Fresnel::fresnelMoment(1, 1 / n), 1e-12);
}

// Integral of T21 cos over the hemisphere outside, pi 4 C_phi(1/eta).
TEST(FresnelMoments, GiveTheNormalizerOfTheExitTerm) {
    const auto normalizer = [](double eta) {
        return std::numbers::pi * 4 * Fresnel::fluenceWeight(Fresnel::fresnelMoment(1, 1 / eta));
    };
    EXPECT_NEAR(normalizer(1.3), 2.94954, 0.5e-5);
    EXPECT_NEAR(normalizer(1.5), 2.85326, 0.5e-5);
}

// The rearranged polynomials against the printed ones, [dEonIrving2011] appendix; 1e-12 is the rounding of the latter.
TEST(FresnelMoments, PublishedPolynomialsAreAsPrinted) {
    for (const double e : {1.05, 1.3, 1.5, 2.0, 2.5}) {
        const double first = -9.23372 + 22.2272 * e - 20.9292 * std::pow(e, 2) + 10.2291 * std::pow(e, 3) -
                             2.54396 * std::pow(e, 4) + 0.254913 * std::pow(e, 5);
        const double second = -1641.1 + 135.926 / std::pow(e, 3) - 656.175 / std::pow(e, 2) + 1376.53 / e +
                              1213.67 * e - 568.556 * std::pow(e, 2) + 164.798 * std::pow(e, 3) -
                              27.0181 * std::pow(e, 4) + 1.91826 * std::pow(e, 5);
        EXPECT_NEAR(2 * Fresnel::fresnelMomentPublished(1, e), first, 1e-12);
        EXPECT_NEAR(3 * Fresnel::fresnelMomentPublished(2, e), second, 1e-12);
    }
}

// docs/errata.md quotes these.
TEST(FresnelMoments, PublishedPolynomialsAreOffByWhatTheErrataSay) {
    double first = 0, second = 0;
    for (double eta = 1.1; eta <= 2; eta += 0.01) {
        const auto off = [eta](int k) {
            return (k + 1) * std::abs(Fresnel::fresnelMomentPublished(k, eta) - Fresnel::fresnelMoment(k, eta));
        };
        first = std::max(first, off(1));
        second = std::max(second, off(2));
    }
    EXPECT_NEAR(first, 0.0016, 0.5e-4);
    EXPECT_NEAR(second, 0.0047, 0.8e-4);
}

TEST(FresnelMoments, EganAndHilgemansFitIsNearTheIntegral) {
    for (double eta = 1.1; eta <= 2; eta += 0.05)
        EXPECT_NEAR(Fresnel::fresnelDiffusePublished(eta), 2 * Fresnel::fresnelMoment(1, eta), 0.0015) << eta;
    for (const double eta : {1 / 1.1, 1 / 1.3, 1 / 1.5})
        EXPECT_NEAR(Fresnel::fresnelDiffusePublished(eta), 2 * Fresnel::fresnelMoment(1, eta), 0.0015) << eta;
}

TEST(HenyeyGreenstein, IsNormalisedAndHasItsMeanCosine) {
    for (const double g : {-0.5, 0.0, 0.3, 0.9}) {
        double total = 0, mean = 0;
        constexpr int n = 200000;
        for (int i = 0; i < n; ++i) {
            const double mu = -1 + (2 * i + 1.0) / n;
            const double p = 2 * std::numbers::pi * Fresnel::henyeyGreenstein(mu, g) * 2 / n;
            total += p;
            mean += mu * p;
        }
        // Midpoint rule: error about (peak's curvature) / n^2.
        EXPECT_NEAR(total, 1, 1e-6);
        EXPECT_NEAR(mean, g, 1e-6);
    }
}

TEST(DecayMean, IsExactOnBothSidesOfItsSeam) {
    for (const double x : {0.0, 1e-12, 1e-3, 0.3, 0.999999, 1.0, 1.000001, 5.0, 50.0}) {
        const double expected = x == 0 ? 1 : -std::expm1(-x) / x;
        EXPECT_NEAR(Fresnel::decayMean(x), expected, 4e-16 * (1 + expected)) << x;
    }
}

}  // namespace
}  // namespace searchlight
