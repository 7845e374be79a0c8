// The dual tree against the sum in double, point by point.
#include "render/exitance_sum.h"

#include <gtest/gtest.h>

#include <hwy/targets.h>

#include "instruction_sets.h"
#include "render/exitance/dual_tree.h"
#include "render/exitance_scene.h"

namespace searchlight {
namespace {

// What the float table itself is off by: of bins of 1/32 octave with three terms, and of rounding.
constexpr double table_error = 1e-4;

struct Checked {
    SumError error;
    SumStatistics statistics;
};

// All receivers are summed, as for a picture; every `stride`-th is compared.
Checked check(const LitCloud& points, const Profile& profile, std::span<const Vec3f> receivers, double error,
              std::size_t stride, std::span<const Rgb> truth) {
    PointTree tree(points.cloud);
    tree.setTransmitted(points.transmitted);
    const RadialTable table(profile, tree.meanArea());
    Checked checked;
    const std::vector<Rgbf> sum = sumExitance(tree, table, receivers, {.error = error}, &checked.statistics);
    checked.error = errorOf(everyNth<Rgbf>(sum, stride), truth);
    return checked;
}

void expectKept(const LitCloud& points, const Profile& profile, std::span<const Vec3f> receivers,
                std::span<const double> errors, std::size_t stride) {
    const std::vector<Vec3f> compared = everyNth<Vec3f>(receivers, stride);
    const std::vector<Rgb> truth = sumExitanceDirectly(points.cloud, points.transmitted, profile, compared);
    for (const double error : errors) {
        SCOPED_TRACE(error);
        const Checked checked = check(points, profile, receivers, error, stride, truth);
        EXPECT_LE(checked.statistics.error_bound, error);
        EXPECT_LE(checked.error.rmse, error + table_error);
        EXPECT_LE(checked.error.largest, checked.statistics.largest_error_bound + 10 * table_error);
    }
}

constexpr std::array errors{0.001, 0.01, 0.05};
constexpr std::size_t some_points = 6000, stride = 41;
constexpr int side = 160;

TEST(ExitanceSum, KeepsTheErrorForThinAndDenseMedia) {
    for (const char* material : {"skin1", "marble", "ketchup", "whole_milk"})
        for (const double radius : {2.5, 10.0}) {
            SCOPED_TRACE(testing::Message() << material << " " << radius << " mm");
            expectKept(dentedSphere(some_points, radius, lambert), dipoleProfile(material),
                       pixelsOfDentedSphere(side, radius), errors, stride);
        }
}

// Groups of points may stand further apart than the profile reaches, and still hold neighbours.
TEST(ExitanceSum, KeepsTheErrorWhereTheProfileIsShortBesideTheObject) {
    std::vector<double> radii;
    std::vector<Rgb> values;
    for (int i = 0; i <= 40; ++i) {
        radii.push_back(0.05 * i);
        values.push_back(std::exp(-2 * radii.back()) * Rgb{1, 0.5, 0.25});
    }
    expectKept(dentedSphere(40'000, 40, lambert), Profile(radii, values), pixelsOfDentedSphere(side, 40), errors,
               stride);
}

TEST(ExitanceSum, KeepsTheErrorUnderAnyLight) {
    const Profile profile = dipoleProfile("skin1");
    for (const LightAt& light : {LightAt(halfDark), LightAt(checker)})
        expectKept(dentedSphere(some_points, 10, light), profile, pixelsOfDentedSphere(side, 10), errors, stride);
}

TEST(ExitanceSum, KeepsTheErrorForOneLitPoint) {
    LitCloud points = dentedSphere(some_points, 10, [](Vec3) { return Rgbf{}; });
    points.transmitted[some_points / 5] = {1, 2, 3};
    // All receivers are compared: most are far from the light.
    expectKept(points, dipoleProfile("ketchup"), pixelsOfDentedSphere(side, 10), errors, 1);
}

TEST(ExitanceSum, IsTheDirectSumForFewPoints) {
    const LitCloud points = dentedSphere(40, 10, lambert);
    const std::vector<Vec3f> receivers = pixelsOfDentedSphere(48, 10);
    const Profile profile = dipoleProfile("skin1");
    const std::vector<Rgb> truth = sumExitanceDirectly(points.cloud, points.transmitted, profile, receivers);
    const Checked checked = check(points, profile, receivers, 0.05, 1, everyNth<Rgb>(truth, 1));
    EXPECT_LE(checked.error.rmse, table_error);
    EXPECT_EQ(checked.statistics.expansions, 0u);
}

TEST(ExitanceSum, TakesOnePointAndCoincidentPoints) {
    const Profile profile = dipoleProfile("skin1");
    const std::vector<Vec3f> receivers = pixelsOfDentedSphere(32, 3);
    LitCloud points;
    points.cloud = {.positions = {{1, 2, 3}}, .areas = {0.01f}};
    points.transmitted = {{1, 1, 1}};
    expectKept(points, profile, receivers, errors, 1);
    for (int i = 1; i < 500; ++i) {
        points.cloud.positions.push_back(points.cloud.positions[0]);
        points.cloud.areas.push_back(0.01f);
        points.transmitted.push_back({1, 1, 1});
    }
    expectKept(points, profile, receivers, errors, 1);
}

TEST(ExitanceSum, TakesReceiversThatAreEqualFewOrNone) {
    const LitCloud points = dentedSphere(some_points, 10, lambert);
    const Profile profile = dipoleProfile("skin1");
    expectKept(points, profile, std::vector<Vec3f>(1000, Vec3f{3, 4, 8}), errors, 500);
    expectKept(points, profile, std::vector<Vec3f>{{3, 4, 8}}, errors, 1);
    PointTree tree(points.cloud);
    tree.setTransmitted(points.transmitted);
    EXPECT_TRUE(sumExitance(tree, RadialTable(profile, tree.meanArea()), std::span<const Vec3f>{}, {}).empty());
}

TEST(ExitanceSum, DoesNotDependOnTheOrderOfReceivers) {
    const LitCloud points = dentedSphere(some_points, 10, lambert);
    std::vector<Vec3f> receivers = pixelsOfDentedSphere(side, 10);
    std::shuffle(receivers.begin(), receivers.end(), std::mt19937(7));
    expectKept(points, dipoleProfile("marble"), receivers, errors, stride);
}

TEST(ExitanceSum, IsDarkWithoutLight) {
    const LitCloud points = dentedSphere(some_points, 10, [](Vec3) { return Rgbf{}; });
    PointTree tree(points.cloud);
    const RadialTable table(dipoleProfile("skin1"), tree.meanArea());
    for (const Rgbf& value : sumExitance(tree, table, pixelsOfDentedSphere(32, 10), {})) EXPECT_EQ(value, Rgbf{});
}

TEST(ExitanceSum, IsDarkAtOnceWhereNoLightArrives) {
    const LitCloud points = dentedSphere(100'000, 10, lambert);
    std::vector<Vec3f> far = pixelsOfDentedSphere(400, 10);
    for (Vec3f& p : far) p.x += 1e6f;
    PointTree tree(points.cloud);
    tree.setTransmitted(points.transmitted);
    const Profile dark({0, 1}, {{}, {}});
    for (const Profile& profile : {dipoleProfile("skin1"), dark}) {
        SumStatistics statistics;
        for (const Rgbf& value : sumExitance(tree, RadialTable(profile, tree.meanArea()), far, {}, &statistics))
            EXPECT_EQ(value, Rgbf{});
        // Point by point it would be 1e10.
        EXPECT_EQ(statistics.interactions, 0u);
    }
}

TEST(ExitanceSum, KeepsTheErrorFarFromTheOrigin) {
    // Positions of 1e4 mm are known to 1e-3 mm; the sum is of these positions as they are.
    LitCloud points = dentedSphere(some_points, 10, lambert);
    std::vector<Vec3f> receivers = pixelsOfDentedSphere(side, 10);
    for (auto* list : {&points.cloud.positions, &receivers})
        for (Vec3f& p : *list) p = {p.x + 1e4f, p.y - 2e4f, p.z + 3e4f};
    expectKept(points, dipoleProfile("skin1"), receivers, errors, stride);
}

TEST(ExitanceSum, KeepsTheErrorOfEveryChannelHoweverTheyDiffer) {
    Medium medium = findMaterial("skin1").medium;
    medium.sigma_s.g = 50;  // a range of microns
    medium.sigma_s.b = 0;   // no scattering, so no R_d
    medium.sigma_a.b = 0.1;
    LitCloud points = dentedSphere(some_points, 10, lambert);
    for (Rgbf& flux : points.transmitted) flux = {1e-20f * flux.r, 1e20f * flux.g, flux.b};
    const std::vector<Vec3f> receivers = pixelsOfDentedSphere(side, 10);
    const Profile profile = dipoleProfile(medium);
    expectKept(points, profile, receivers, errors, stride);
    PointTree tree(points.cloud);
    tree.setTransmitted(points.transmitted);
    for (const Rgbf& value : sumExitance(tree, RadialTable(profile, tree.meanArea()), receivers, {}))
        EXPECT_EQ(value.b, 0);
}

TEST(ExitanceSum, DoesNotDependOnThreads) {
    const LitCloud points = dentedSphere(some_points, 10, checker);
    const std::vector<Vec3f> receivers = pixelsOfDentedSphere(side, 10);
    const Profile profile = dipoleProfile("skin1");
    const auto sum = [&](int threads) {
        PointTree tree(points.cloud, threads);
        tree.setTransmitted(points.transmitted, threads);
        return sumExitance(tree, RadialTable(profile, tree.meanArea()), receivers, {.threads = threads});
    };
    const std::vector<Rgbf> alone = sum(1);
    EXPECT_EQ(sum(2), alone);
    EXPECT_EQ(sum(0), alone);
}

TEST(ExitanceSum, InstructionSetsDifferByLessThanTheError) {
    const LitCloud points = dentedSphere(some_points, 10, lambert);
    const std::vector<Vec3f> receivers = pixelsOfDentedSphere(side, 10);
    PointTree tree(points.cloud);
    tree.setTransmitted(points.transmitted);
    const RadialTable table(dipoleProfile("skin1"), tree.meanArea());
    const ReceiverTree receiver_tree(receivers);
    SumCalibration calibration;
    const auto sum = [&] {
        return sumExitance(tree, table, receiver_tree, {.error = 0.001, .calibration = &calibration});
    };
    const std::vector<Rgbf> best = sum();
    std::vector<Rgb> truth;
    for (const Rgbf& value : best) truth.push_back(toDouble(value));
    for (const std::int64_t target : {HWY_AVX3, HWY_AVX2, HWY_SSE4}) {
        if (!hasInstructionSet(target)) continue;
        hwy::SetSupportedTargetsForTest(target);
        SCOPED_TRACE(dualTreeInstructionSet());
        const std::vector<Rgbf> other = sum();
        hwy::SetSupportedTargetsForTest(0);
        // Fewer lanes ask for the nearest of fewer receivers, so they take a few more moments in the place of points:
        // a part of the error that is allowed.
        EXPECT_LE(errorOf(other, truth).rmse, 0.0003);
    }
}

TEST(ExitanceSum, CalibratesOnlyAfterAChange) {
    LitCloud points = dentedSphere(some_points, 10, lambert);
    PointTree tree(points.cloud);
    tree.setTransmitted(points.transmitted);
    const RadialTable table(dipoleProfile("skin1"), tree.meanArea());
    const ReceiverTree receivers(pixelsOfDentedSphere(side, 10));
    SumCalibration calibration;
    SumStatistics first, second, third;
    const SumOptions options{.calibration = &calibration};
    const std::vector<Rgbf> sum = sumExitance(tree, table, receivers, options, &first);
    EXPECT_EQ(sumExitance(tree, table, receivers, options, &second), sum);
    EXPECT_TRUE(first.calibrated);
    EXPECT_FALSE(second.calibrated);
    EXPECT_EQ(second.error_bound, first.error_bound);
    for (Rgbf& flux : points.transmitted) flux.g *= 0.5f;
    points.transmitted[100] = {};
    tree.setTransmitted(points.transmitted);
    sumExitance(tree, table, receivers, options, &third);
    EXPECT_TRUE(third.calibrated);
}

// On a sphere the area within a chord d of a point is pi d^2, as in the plane: the sum is the encircled flux.
TEST(ExitanceSum, OfASphereUnderEvenLightIsTheEncircledFlux) {
    constexpr double radius = 4;
    LitCloud points;
    for (const Vec3 unit : spiral(40'000)) {
        points.cloud.positions.push_back(toFloat(radius * unit));
        points.cloud.areas.push_back(static_cast<float>(4 * std::numbers::pi * radius * radius / 40'000));
        points.transmitted.push_back({1, 1, 1});
    }
    std::vector<Vec3f> receivers;
    for (const Vec3 unit : spiral(3001)) receivers.push_back(toFloat(radius * unit));
    for (const char* material : {"skin1", "marble"}) {
        const Profile profile = dipoleProfile(material);
        PointTree tree(points.cloud);
        tree.setTransmitted(points.transmitted);
        const std::vector<Rgbf> sum =
            sumExitance(tree, RadialTable(profile, tree.meanArea()), receivers, {.error = 0.001});
        const std::vector<Rgb> truth(receivers.size(), profile.encircled(2 * radius));
        // The spiral's own unevenness is a few 1e-4 here.
        EXPECT_LE(errorOf(sum, truth).rmse, 0.0015) << material;
    }
}

// Light that ends at a straight edge, spread by a Gaussian: an error function.
TEST(ExitanceSum, OfAnEdgeIsTheIntegralOfTheProfile) {
    constexpr double sigma = 0.5, spacing = 0.05;
    std::vector<double> radii;
    std::vector<Rgb> values;
    for (int i = 0; i <= 400; ++i) {
        radii.push_back(0.01 * i);
        const double R =
            std::exp(-radii.back() * radii.back() / (2 * sigma * sigma)) / (2 * std::numbers::pi * sigma * sigma);
        values.push_back({R, R, R});
    }
    LitCloud points;
    for (int y = -100; y < 100; ++y)
        for (int x = -100; x < 100; ++x) {
            points.cloud.positions.push_back(toFloat(Vec3{(x + 0.5) * spacing, (y + 0.5) * spacing, 0}));
            points.cloud.areas.push_back(spacing * spacing);
            points.transmitted.push_back(x < 0 ? Rgbf{1, 1, 1} : Rgbf{});
        }
    std::vector<Vec3f> receivers;
    std::vector<Rgb> truth;
    // The mean over a point's disc widens the Gaussian by the disc's own variance.
    const double width = std::sqrt(sigma * sigma + spacing * spacing / (4 * std::numbers::pi));
    for (int i = 0; i < 2000; ++i) {
        const double x = -2 + 0.002 * i;
        receivers.push_back(toFloat(Vec3{x, 0.013, 0}));
        const double M = 0.5 * std::erfc(x / (width * std::numbers::sqrt2));
        truth.push_back({M, M, M});
    }
    PointTree tree(points.cloud);
    tree.setTransmitted(points.transmitted);
    const RadialTable table(Profile(radii, values), tree.meanArea());
    EXPECT_LE(errorOf(sumExitance(tree, table, receivers, {.error = 0.001}), truth).rmse, 0.001 + table_error);
}

}  // namespace
}  // namespace searchlight
