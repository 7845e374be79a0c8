#include "draw/ticks.h"

#include <algorithm>
#include <cmath>

namespace searchlight {
namespace {

using testing::ElementsAre;

// "10^−3" for a power, the label otherwise.
std::vector<std::string> labels(const AxisTicks& axis) {
    std::vector<std::string> texts;
    for (const Tick& tick : axis.ticks)
        if (!tick.label.empty()) texts.push_back(tick.label + (tick.superscript.empty() ? "" : "^" + tick.superscript));
    return texts;
}

std::vector<double> values(const AxisTicks& axis, bool major) {
    std::vector<double> result;
    for (const Tick& tick : axis.ticks)
        if (tick.major == major) result.push_back(tick.value);
    return result;
}

TEST(Ticks, LinearStepsAreOneTwoOrFive) {
    EXPECT_THAT(labels(axisTicks(AxisScale::linear, 0, 1, 6)), ElementsAre("0.0", "0.2", "0.4", "0.6", "0.8", "1.0"));
    EXPECT_THAT(labels(axisTicks(AxisScale::linear, 0, 22, 7)),
                ElementsAre("0", "2", "4", "6", "8", "10", "12", "14", "16", "18", "20", "22"));
    EXPECT_THAT(labels(axisTicks(AxisScale::linear, 3, 27, 6)), ElementsAre("5", "10", "15", "20", "25"));
}

TEST(Ticks, LinearValuesAreTheDoublesTheirLabelsRead) {
    EXPECT_THAT(values(axisTicks(AxisScale::linear, 0, 0.35, 6), true),
                ElementsAre(0.0, 0.05, 0.10, 0.15, 0.20, 0.25, 0.30, 0.35));
}

TEST(Ticks, NegativeNumbersHaveATypographicMinusAndZeroHasNone) {
    EXPECT_THAT(labels(axisTicks(AxisScale::linear, -1, 1, 4)), ElementsAre("−1.0", "−0.5", "0.0", "0.5", "1.0"));
}

TEST(Ticks, MinorTicksDivideTheStep) {
    EXPECT_THAT(values(axisTicks(AxisScale::linear, 0, 2, 2), false),
                ElementsAre(0.2, 0.4, 3 * 0.2, 0.8, 6 * 0.2, 7 * 0.2, 8 * 0.2, 9 * 0.2));
}

TEST(Ticks, LargeAndSmallNumbersShareAFactor) {
    const AxisTicks small = axisTicks(AxisScale::linear, 0, 4e-5, 4);
    EXPECT_EQ(small.factor, -5);
    EXPECT_THAT(labels(small), ElementsAre("0", "1", "2", "3", "4"));
    const AxisTicks large = axisTicks(AxisScale::linear, 0, 2.5e7, 5);
    EXPECT_EQ(large.factor, 7);
    EXPECT_THAT(labels(large), ElementsAre("0.0", "0.5", "1.0", "1.5", "2.0", "2.5"));
}

TEST(Ticks, FewDecadesArePlainDecimals) {
    EXPECT_THAT(labels(axisTicks(AxisScale::logarithmic, 0.01, 100, 6)), ElementsAre("0.01", "0.1", "1", "10", "100"));
}

TEST(Ticks, ManyDecadesArePowersWithMinorTicksTwoToNine) {
    const AxisTicks axis = axisTicks(AxisScale::logarithmic, 1e-6, 1, 6);
    EXPECT_THAT(labels(axis), ElementsAre("10^−6", "10^−5", "10^−4", "10^−3", "10^−2", "10^−1", "10^0"));
    EXPECT_EQ(values(axis, false).size(), 6u * 8u);
    EXPECT_DOUBLE_EQ(values(axis, false).front(), 2e-6);
}

TEST(Ticks, VeryManyDecadesAreThinned) {
    const AxisTicks axis = axisTicks(AxisScale::logarithmic, 1e-300, 1e300, 6);
    EXPECT_LE(labels(axis).size(), 9u);
    EXPECT_GE(labels(axis).size(), 4u);
    EXPECT_THAT(labels(axis), testing::Contains("10^0"));
}

TEST(Ticks, AboutOneDecadeIsLabelledOneTwoFive) {
    EXPECT_THAT(labels(axisTicks(AxisScale::logarithmic, 0.3, 12, 6)), ElementsAre("0.5", "1", "2", "5", "10"));
    EXPECT_THAT(labels(axisTicks(AxisScale::logarithmic, 1e-7, 1.1e-6, 6)),
                ElementsAre("10^−7", "2×10^−7", "5×10^−7", "10^−6"));
}

TEST(Ticks, LessThanADecadeFallsBackToEqualSteps) {
    EXPECT_THAT(labels(axisTicks(AxisScale::logarithmic, 6, 9, 3)), ElementsAre("6", "7", "8", "9"));
}

TEST(Ticks, SquareRootAxisFillsTheFirstStepTowardsZero) {
    EXPECT_THAT(labels(axisTicks(AxisScale::square_root, 0, 40, 6)),
                ElementsAre("0", "0.5", "2", "5", "10", "20", "30", "40"));
    EXPECT_THAT(labels(axisTicks(AxisScale::square_root, 0, 0.16, 6)),
                ElementsAre("0", "0.002", "0.01", "0.02", "0.05", "0.1", "0.15"));
}

TEST(Ticks, SquareRootAxisMirrorsNegativeValues) {
    EXPECT_THAT(labels(axisTicks(AxisScale::square_root, -10, 10, 6)),
                ElementsAre("−10", "−5", "−2", "−0.5", "0", "0.5", "2", "5", "10"));
}

TEST(Ticks, EveryTickLiesInRangeAndTheyAscend) {
    const double ends[] = {1e-290, 3e-12, 0.02, 0.97, 1, 7, 1234.5, 3e9, 1e290};
    for (const AxisScale scale : {AxisScale::linear, AxisScale::logarithmic, AxisScale::square_root})
        for (const double min : ends)
            for (const double max : ends) {
                if (min >= max) continue;
                const AxisTicks axis = axisTicks(scale, min, max, 6);
                ASSERT_FALSE(axis.ticks.empty()) << min << ' ' << max;
                EXPECT_LT(axis.ticks.size(), 120u);
                for (size_t i = 0; i < axis.ticks.size(); ++i) {
                    // Ticks may leave the range by rounding, 1e-9 of a step (or of a decade).
                    EXPECT_GE(axis.ticks[i].value,
                              min * (1 - 1e-8) - 1e-8 * (scale == AxisScale::logarithmic ? 0 : max));
                    EXPECT_LE(axis.ticks[i].value, max * (1 + 1e-8));
                    if (i > 0) {
                        EXPECT_GT(axis.ticks[i].value, axis.ticks[i - 1].value);
                    }
                }
            }
}

TEST(Ticks, NamesStandAtWholeNumbers) {
    const AxisTicks axis = namedTicks({"near", "far"});
    EXPECT_THAT(labels(axis), ElementsAre("near", "far"));
    EXPECT_THAT(values(axis, true), ElementsAre(0, 1));
    EXPECT_EQ(axis.factor, 0);
}

}  // namespace
}  // namespace searchlight
