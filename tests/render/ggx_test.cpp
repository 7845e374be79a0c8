#include "render/ggx.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/random.h"

namespace searchlight {
namespace {

constexpr double pi = std::numbers::pi;

Vec3 direction(double cosine, double azimuth) {
    const double sine = std::sqrt(1 - cosine * cosine);
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

// Midpoint rule over the hemisphere, dense where the facets mirror wo: theta is that of the facet's normal.
double integral(const Ggx& ggx, Vec3 wo, double (*f)(const Ggx&, Vec3 wi, Vec3 wo)) {
    constexpr int steps = 250;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) / steps;
        const double slope = ggx.alpha * std::sqrt(t / (1 - t));  // inverts the distribution of slopes
        const double cosine = 1 / std::sqrt(1 + slope * slope);
        const double facet_pdf =
            1 / (pi * std::pow(ggx.alpha, 2) * std::pow(cosine, 4) * std::pow(1 + std::pow(slope / ggx.alpha, 2), 2)) *
            cosine;
        for (int k = 0; k < steps; ++k) {
            const Vec3 h = direction(cosine, 2 * pi * (k + 0.5) / steps);
            const double across = dot(h, wo);
            const Vec3 wi = (2 * across) * h - wo;
            // d wi = 4 (h.wo) d h
            if (across > 0 && wi.z > 0) sum += f(ggx, wi, wo) * 4 * across / facet_pdf;
        }
    }
    return sum / steps / steps;
}

double reflected(const Ggx& ggx, Vec3 wi, Vec3 wo) { return ggxValue(ggx, wi, wo) * wi.z; }

TEST(Ggx, IsReciprocal) {
    SplitMix64 random = streamOf(1, 1);
    for (int i = 0; i < 200; ++i) {
        const Ggx ggx{std::max(1e-3, random.uniform()), 1.1 + random.uniform(), false};
        const Vec3 a = direction(random.uniform(), 2 * pi * random.uniform());
        const Vec3 b = direction(random.uniform(), 2 * pi * random.uniform());
        EXPECT_NEAR(ggxValue(ggx, a, b), ggxValue(ggx, b, a), 1e-9 * ggxValue(ggx, a, b));
    }
}

// With alpha = 1 facets are spread evenly over the hemisphere, D = 1/pi; seen from straight above, the integral over wi
// is that of 2 mu / (1 + mu) over mu, halved: 1 - ln 2. The rest bounces between facets, which is left out.
TEST(Ggx, LossOfTheRoughestMirrorIsClosedForm) {
    EXPECT_NEAR(integral({1, 1.5, true}, {0, 0, 1}, reflected), 1 - std::numbers::ln2, 1e-4);
}

TEST(Ggx, MirrorsLoseLittleAndNeverGain) {
    for (const double alpha : {0.01, 0.1, 0.3, 0.7})
        for (const double cosine : {0.1, 0.4, 0.8, 1.0}) {
            const double albedo = integral({alpha, 1.5, true}, direction(cosine, 0), reflected);
            EXPECT_LT(albedo, 1 + 1e-4) << alpha << " " << cosine;  // the midpoint rule's error
            if (alpha == 0.01 && cosine > 0.3) {
                EXPECT_GT(albedo, 0.999) << cosine;
            }
        }
}

TEST(Ggx, NarrowFacetsReflectAsTheFlatBoundary) {
    for (const double cosine : {0.2, 0.5, 1.0}) {
        const Ggx ggx{0.005, 1.4, false};
        EXPECT_NEAR(integral(ggx, direction(cosine, 0), reflected) / ggxFresnel(ggx, cosine), 1, 2e-3);
    }
    // ((eta - 1)/(eta + 1))^2
    EXPECT_NEAR(ggxFresnel({0.1, 1.5, false}, 1), 0.04, 1e-12);
}

// Counts of samples in 8 x 8 cells of (cosine, azimuth) and below the surface, against the density's integrals: chi^2
// with 64 degrees of freedom stays below 119 with probability 1 - 4e-5.
TEST(Ggx, SamplesFollowTheirDensity) {
    constexpr int cells = 8, samples = 100000, fine = 40;
    for (const double alpha : {0.2, 0.8}) {
        for (const double cosine : {0.3, 0.9}) {
            const Ggx ggx{alpha, 1.5, false};
            const Vec3 wo = direction(cosine, 0.4);
            std::array<double, cells * cells + 1> expected{}, counts{};
            expected.back() = samples;
            for (int i = 0; i < cells * fine; ++i)
                for (int k = 0; k < cells * fine; ++k) {
                    const Vec3 wi = direction((i + 0.5) / (cells * fine), 2 * pi * (k + 0.5) / (cells * fine));
                    const double share = ggxPdf(ggx, wi, wo) * 2 * pi / std::pow(cells * fine, 2) * samples;
                    expected[static_cast<std::size_t>(i / fine * cells + k / fine)] += share;
                    expected.back() -= share;
                }
            SplitMix64 random = streamOf(7, 3);
            for (int i = 0; i < samples; ++i) {
                const double u = random.uniform(), v = random.uniform();
                const Vec3 wi = ggxSample(ggx, wo, u, v);
                EXPECT_NEAR(length(wi), 1, 1e-9);
                double azimuth = std::atan2(wi.y, wi.x);
                if (azimuth < 0) azimuth += 2 * pi;
                const int row = std::min(cells - 1, static_cast<int>(wi.z * cells));
                const int column = std::min(cells - 1, static_cast<int>(azimuth / (2 * pi) * cells));
                ++counts[wi.z <= 0 ? counts.size() - 1 : static_cast<std::size_t>(row * cells + column)];
            }
            double chi2 = 0;
            for (std::size_t i = 0; i < counts.size(); ++i)
                if (expected[i] > 5) chi2 += std::pow(counts[i] - expected[i], 2) / expected[i];
            EXPECT_LT(chi2, 119) << alpha << " " << cosine;
        }
    }
}

}  // namespace
}  // namespace searchlight
