// The elementary functions of the walk, in the instruction set that every machine has.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "transport/walk/fresnel.h"
#include "transport/walk/lane_scatter-inl.h"

namespace searchlight {
namespace HWY_NAMESPACE {
namespace {

constexpr Float d;
constexpr Int di;

float exponentialOf(std::uint32_t bits) { return hn::GetLane(exponential(hn::Set(di, static_cast<int>(bits)))); }

TEST(LaneMath, ExponentialIsMinusTheLogarithm) {
    std::mt19937 random(1);
    for (int i = 0; i < 200'000; ++i) {
        const std::uint32_t k = (random() & 0x7FFFFFFF) >> (i % 31);
        const float u = (static_cast<float>(k) + 0.5f) * 0x1p-31f;  // the rounding to float is part of the definition
        const double truth = -std::log(static_cast<double>(u));
        ASSERT_NEAR(exponentialOf(k), truth, 2e-7 * truth + 1e-12) << k;
    }
    EXPECT_NEAR(exponentialOf(0), 32 * std::numbers::ln2, 1e-5);  // half of 2^-31
    EXPECT_EQ(exponentialOf(0x7FFFFFFF), 0);
    EXPECT_EQ(exponentialOf(0x80000005u), exponentialOf(5));  // the top bit is not used
}

// First four moments over a fine lattice of uniform numbers: 1, 2, 6, 24. A crude logarithm biases a walk.
TEST(LaneMath, ExponentialHasTheMomentsOfTheDistribution) {
    constexpr std::uint32_t step = 4099;
    double moments[4] = {}, count = 0;
    for (std::uint32_t k = step / 2; k < 0x7FFFFFFF - step; k += step, ++count) {
        const double s = exponentialOf(k);
        for (double power = s; double& moment : moments) moment += power, power *= s;
    }
    const double truth[4] = {1, 2, 6, 24};
    // The lattice cuts the last 2e-6 of probability in halves: 1e-5 to 3e-2 of the moments.
    const double tolerance[4] = {1e-5, 2e-4, 3e-3, 6e-2};
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(moments[i] / count, truth[i], tolerance[i]);
}

// Also where nothing is left of the cosine: a matched interface that is grazed reflects nothing, and is no NaN.
TEST(LaneMath, ReflectanceFollowsFresnelDownToGrazing) {
    for (const float eta : {0.75f, 1.0f, 1.3f, 2.0f})
        for (const float c : {1.0f, 0.9f, 0.5f, 0.1f, 1e-3f}) {
            const float lane = hn::GetLane(fresnel(hn::Set(d, c), hn::Set(d, eta)).reflectance);
            // Near the critical angle the root loses half of its digits.
            EXPECT_NEAR(lane, internalReflectance(eta, c), 1e-4) << eta << ", " << c;
        }
    EXPECT_EQ(hn::GetLane(fresnel(hn::Zero(d), hn::Set(d, 1.0f)).reflectance), 0);
}

TEST(LaneMath, AzimuthIsAUniformPointOnTheCircle) {
    std::mt19937 random(2);
    double sums[4] = {};
    constexpr int count = 400'000;
    for (int i = 0; i < count; ++i) {
        const std::uint32_t bits = random();
        const Azimuth a = azimuth(hn::Set(di, static_cast<int>(bits)));
        const double c = hn::GetLane(a.cos), s = hn::GetLane(a.sin);
        ASSERT_NEAR(c * c + s * s, 1, 5e-7);
        const double angle = (static_cast<double>(bits >> 8) * 0x1p-24 - 0.5) * std::numbers::pi;
        ASSERT_NEAR(s, std::sin(angle), 2e-7);
        ASSERT_NEAR(std::abs(c), std::abs(std::cos(angle)), 2e-7);
        sums[0] += c, sums[1] += s, sums[2] += c * c - s * s, sums[3] += c * s;
    }
    // Five standard errors of means with variance 1/2, 1/2, 1/2, 1/8.
    for (const double sum : sums) EXPECT_NEAR(sum / count, 0, 5 * std::sqrt(0.5 / count));
}

TEST(LaneMath, NeighboursShareAGeneratorButNotItsBits) {
    alignas(64) std::uint64_t s0[8], s1[8];
    std::mt19937_64 random(3);
    for (int i = 0; i < 8; ++i) s0[i] = random(), s1[i] = random();
    const Word dw;
    Generator generator{hn::Load(dw, s0), hn::Load(dw, s1)};
    const IntV first = generator.next();
    // xoroshiro128++ of the first lane, by hand.
    const std::uint64_t expected = std::rotl(s0[0] + s1[0], 17) + s0[0];
    const std::uint64_t x = s1[0] ^ s0[0];
    alignas(64) std::int32_t lanes[16];
    hn::Store(first, di, lanes);
    EXPECT_EQ(static_cast<std::uint32_t>(lanes[0]), static_cast<std::uint32_t>(expected));
    EXPECT_EQ(static_cast<std::uint32_t>(lanes[1]), static_cast<std::uint32_t>(expected >> 32));
    alignas(64) std::uint64_t state[8];
    hn::Store(generator.s0, dw, state);
    EXPECT_EQ(state[0], std::rotl(s0[0], 49) ^ x ^ (x << 21));
    hn::Store(generator.s1, dw, state);
    EXPECT_EQ(state[0], std::rotl(x, 28));

    // Only the pairs that want a number move on.
    const Generator before = generator;
    generator.nextWhere(hn::FirstN(d, 1));
    alignas(64) std::uint64_t old_state[8];
    hn::Store(before.s0, dw, old_state);
    hn::Store(generator.s0, dw, state);
    EXPECT_NE(state[0], old_state[0]);
    EXPECT_EQ(state[1], old_state[1]);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace searchlight
