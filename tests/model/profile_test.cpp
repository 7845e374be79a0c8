#include "model/profile.h"

#include <numbers>

#include "base/error.h"

namespace searchlight {
namespace {

constexpr double pi = std::numbers::pi;

Rgb grey(double value) { return {value, value, value}; }

template <class Function>
Profile sampled(const std::vector<double>& radii, Function f) {
    std::vector<Rgb> values;
    for (const double r : radii) values.push_back(grey(f(r)));
    return {radii, values};
}

std::vector<double> evenRadii(double last, int n) {
    std::vector<double> radii;
    for (int i = 0; i <= n; ++i) radii.push_back(last * i / n);
    return radii;
}

double largestError(int n) {
    const auto f = [](double r) { return std::exp(-r); };
    const Profile profile = sampled(evenRadii(4, n), f);
    double largest = 0;
    for (double r = 0; r < 4; r += 0.001) largest = std::max(largest, std::abs(profile(r).r - f(r)));
    return largest;
}

TEST(Profile, PassesThroughItsSamples) {
    const std::vector<double> radii = {0.1, 0.2, 0.5, 2};
    const Profile profile = sampled(radii, [](double r) { return 1 / r; });
    for (const double r : radii) EXPECT_DOUBLE_EQ(profile(r).g, 1 / r);
}

TEST(Profile, InterpolatesToFourthOrder) {
    // Twice the samples, a sixteenth of the error; the ends count less than the fifth that is left open.
    EXPECT_NEAR(largestError(40) / largestError(80), 16, 3);
}

TEST(Profile, IsConstantBelowTheFirstRadiusAndZeroBeyondTheLast) {
    const Profile profile({0.5, 1}, {grey(3), grey(2)});
    EXPECT_EQ(profile(0).r, 3);
    EXPECT_EQ(profile(0.4).r, 3);
    EXPECT_EQ(profile(1).r, 2);
    EXPECT_EQ(profile(1.01).r, 0);
}

TEST(Profile, StaysBetweenNeighbouringSamples) {
    const Profile profile({0, 1, 1.1, 2, 2.05, 5}, {grey(1), grey(1), grey(0.01), grey(0.009), grey(0), grey(0)});
    for (double r = 0; r < 5; r += 0.01) {
        const double low = r < 1.1 ? 0.01 : r < 2 ? 0.009 : 0, high = r <= 1 ? 1 : r <= 1.1 ? 1 : 0.01;
        EXPECT_GE(profile(r).r, low * (1 - 1e-12)) << r;
        EXPECT_LE(profile(r).r, high * (1 + 1e-12)) << r;
    }
}

TEST(Profile, EncirclesTheIntegralOfItsCurve) {
    const Profile profile = sampled({0.2, 0.5, 1, 3}, [](double r) { return std::exp(-r) / r; });
    double sum = pi * 0.2 * 0.2 * profile(0).r;
    // Simpson is exact for r times a cubic on each interval up to its fifth-order term: 2000 steps leave 1e-12.
    for (const auto& [a, b] : {std::pair{0.2, 0.5}, {0.5, 1.0}, {1.0, 3.0}}) {
        constexpr int n = 2000;
        const double h = (b - a) / n;
        const auto f = [&](double r) { return 2 * pi * r * profile(r).b; };
        for (int i = 0; i < n; ++i) sum += h / 6 * (f(a + i * h) + 4 * f(a + (i + 0.5) * h) + f(a + (i + 1) * h));
        EXPECT_NEAR(profile.encircled(b).b, sum, 1e-10);
    }
    EXPECT_EQ(profile.total().b, profile.encircled(3).b);
    EXPECT_EQ(profile.total().b, profile.encircled(1e9).b);
    EXPECT_NEAR(profile.encircled(0.1).b, pi * 0.01 * profile(0).b, 1e-15);
}

TEST(Profile, TotalOfAGaussianIsKnown) {
    const double variance = 0.3;
    const Profile profile =
        sampled(evenRadii(3, 200), [=](double r) { return std::exp(-r * r / (2 * variance)) / (2 * pi * variance); });
    // (h / sigma)^4 / 384 with h = 0.015, sigma = 0.55 is 1e-9.
    EXPECT_NEAR(profile.total().r, 1 - std::exp(-9 / (2 * variance)), 1e-8);
}

TEST(Profile, AnnulusMeanTimesAreaIsEncircledFlux) {
    const Profile profile = sampled({0, 0.5, 1, 3}, [](double r) { return std::exp(-r); });
    EXPECT_NEAR(profile.annulusMean(0.4, 2).r * pi * (4 - 0.16), profile.encircled(2).r - profile.encircled(0.4).r,
                1e-14);
    EXPECT_NEAR(profile.annulusMean(1 - 1e-6, 1 + 1e-6).r, profile(1).r, 1e-6);
}

TEST(Profile, SampledRadiusEnclosesTheFractionAsked) {
    const Profile profile({0.1, 0.5, 1, 1.5, 3}, {{5, 1, 3}, {2, 1, 0}, {1, 1, 0}, {0, 1, 2}, {0, 1, 0}});
    for (int c = 0; c < 3; ++c)
        for (double u = 0; u < 1; u += 1.0 / 257) {
            const double r = profile.sampleRadius(u, c);
            EXPECT_NEAR(profile.encircled(r)[c] / profile.total()[c], u, 1e-12) << c;
        }
}

TEST(Profile, SampledRadiiDoNotFallWhereTheProfileIsZero) {
    const Profile profile({0, 1, 2, 3}, {grey(1), grey(0), grey(0), grey(1)});
    for (double u = 0; u < 1; u += 1e-3) {
        const double r = profile.sampleRadius(u, 0);
        EXPECT_TRUE(r <= 1 + 1e-6 || r >= 2 - 1e-6) << r;
    }
}

TEST(Profile, RefusesWhatIsNoProfile) {
    const auto message = [](std::vector<double> radii, std::vector<Rgb> values) -> std::string {
        try {
            Profile profile(std::move(radii), std::move(values));
        } catch (const Error& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_EQ(message({1}, {grey(1)}), "a profile needs at least 2 radii");
    EXPECT_EQ(message({-1, 1}, {grey(1), grey(1)}), "the first radius of a profile is negative");
    EXPECT_EQ(message({1, 1}, {grey(1), grey(1)}), "the radii of a profile must ascend: 1 mm after 1 mm");
    EXPECT_EQ(message({0, 1}, {grey(1), {1, NAN, 1}}), "the profile is not finite at r = 1 mm");
}

}  // namespace
}  // namespace searchlight
