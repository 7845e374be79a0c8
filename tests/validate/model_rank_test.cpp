#include "validate/model_rank.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace searchlight {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// Sums of a few products; double keeps 15 digits of them.
constexpr double rounding = 1e-14;

// Annuli whose areas are pi and 3 pi, so that a density of 1 / pi is a light of 1 and of 3.
std::vector<Rgb> densities(double inner, double outer) {
    const double a = inner / std::numbers::pi, b = outer / std::numbers::pi;
    return {{a, a, a}, {b, b, b}};
}

// Light 2 near the beam and 3 away from it.
RankReference twoAnnuli(double noise_inner = 0, double noise_outer = 0) {
    return {.edges_mm = {0, 1, 2},
            .Rd = densities(2, 1),
            .standard_error = densities(noise_inner, noise_outer),
            .total = {5, 0},
            .split_mm = 1,
            .mean_x_mm = {0.5, 0.01}};
}

RankAnswer answer(double inner, double outer) {
    return {.bin_means = densities(inner, outer), .total = inner + 3 * outer, .mean_x_mm = 0};
}

TEST(ModelRank, ErrorsOfKnownCurvesAreExact) {
    // Off by 1 of 2 near the beam and by 0.9 of 3 away from it.
    const RankScore score = rankScore(twoAnnuli(), answer(1, 1.3));
    EXPECT_THAT(score.curve.weighted, DoubleNear(1.9 / 5, rounding));
    EXPECT_THAT(score.curve.near, DoubleNear(0.5, rounding));
    EXPECT_THAT(score.curve.far, DoubleNear(0.3, rounding));
    EXPECT_THAT(score.total.mean, DoubleNear(-0.1 / 5, rounding));
    EXPECT_EQ(score.shift.mean, -1) << "a model that does not shift is off by all of the shift";
    EXPECT_EQ(score.standard_error, 0);
    EXPECT_EQ(score.inflation, 0);
}

TEST(ModelRank, NearAndFarWeighedByTheirLightAreTheWhole) {
    const RankScore score = rankScore(twoAnnuli(), answer(1.7, 0.2));
    EXPECT_THAT(score.near_weight, DoubleNear(2.0 / 5, rounding));
    EXPECT_THAT(score.near_weight * score.curve.near + (1 - score.near_weight) * score.curve.far,
                DoubleNear(score.curve.weighted, rounding));
}

TEST(ModelRank, PlacesOfErrorAddUpAndHaveASign) {
    const RankScore score = rankScore(twoAnnuli(), answer(1, 2));
    EXPECT_THAT(score.place.near_share, DoubleNear(1.0 / 4, rounding));
    EXPECT_EQ(score.place.near_sign, -1);
    EXPECT_EQ(score.place.far_sign, 1);
    // Half of 4: all of 1, and 1 of the 3 that are spread over an area of 3 pi.
    EXPECT_THAT(score.place.half_mm, DoubleNear(std::numbers::sqrt2, rounding));
}

TEST(ModelRank, NoiseOfAnErrorFollowsFromThatOfTheReference) {
    // Far below the reference: d(error)/d(light) = (1 - error) / 5, and nothing is folded.
    const RankScore low = rankScore(twoAnnuli(0.01, 0), answer(0, 0));
    EXPECT_THAT(low.curve.weighted, DoubleNear(1, rounding));
    EXPECT_THAT(low.standard_error, DoubleNear(0, rounding)) << "no light at all is off by 100 % whatever the truth";
    const RankScore high = rankScore(twoAnnuli(0.01, 0), answer(4, 2));
    EXPECT_THAT(high.curve.weighted, DoubleNear(1, rounding));
    EXPECT_THAT(high.standard_error, DoubleNear(2 * 0.01 / 5, rounding));
    EXPECT_THAT(high.inflation, DoubleNear(0, rounding));
    EXPECT_THAT(high.near_error, DoubleNear(2 * 0.01 / 2, rounding)) << "its light is 2";
    EXPECT_EQ(high.far_error, 0);
}

TEST(ModelRank, APerfectModelShowsTheNoise) {
    const RankScore score = rankScore(twoAnnuli(0.1, 0.1), answer(2, 1));
    EXPECT_EQ(score.curve.weighted, 0);
    // Mean absolute deviations of 0.1 and of 0.3.
    EXPECT_THAT(score.inflation, DoubleNear(std::sqrt(2 / std::numbers::pi) * 0.4 / 5, rounding));
    EXPECT_THAT(score.inflation, DoubleNear(score.curve.noise, rounding));
}

TEST(ModelRank, GapsKnowWhatModelsShare) {
    const RankReference noisy = twoAnnuli(0.2, 0);
    // Both too high near the beam: whatever the reference is, a is 0.5 of 5 worse but for the scale of the light.
    const RankGap same = rankGap(noisy, answer(4.5, 1), answer(4, 1));
    EXPECT_THAT(same.gap, DoubleNear(0.1, rounding));
    EXPECT_THAT(same.noise, DoubleNear(2 * 0.1 / 5 * 0.2, rounding));
    // On either side of it, what one gains the other loses.
    const RankGap opposite = rankGap(noisy, answer(4.5, 1), answer(0, 1));
    EXPECT_THAT(opposite.noise, DoubleNear(2 * 2.1 / 5 * 0.2, rounding));
    EXPECT_THAT(opposite.gap, DoubleNear(0.1, rounding));
}

TEST(ModelRank, SortsAndCallsTiesWhatNoiseCouldTurn) {
    const std::vector<RankReference> reference{twoAnnuli(0.2, 0)};
    const std::vector<std::vector<RankAnswer>> answers{
        {answer(6, 1)},    // error 4 / 5
        {answer(4.5, 1)},  // 2.5 / 5
        {answer(0, 1)},    // 2 / 5, to the other side: its gap of 0.1 is below the noise of 0.168
    };
    const std::vector<RankedModel> ranked = rankModels(reference, answers);
    ASSERT_EQ(ranked.size(), 3u);
    EXPECT_EQ(ranked[0].model, 2u);
    EXPECT_EQ(ranked[1].model, 1u);
    EXPECT_EQ(ranked[2].model, 0u);
    EXPECT_THAT(ranked[0].ties, ElementsAre(1u));
    EXPECT_THAT(ranked[1].ties, ElementsAre(2u));
    EXPECT_THAT(ranked[2].ties, IsEmpty());
    EXPECT_EQ(ranked[0].rank, 1);
    EXPECT_EQ(ranked[1].rank, 1);
    EXPECT_EQ(ranked[2].rank, 3);
}

TEST(ModelRank, EqualModelsTieAlsoWithoutNoise) {
    const std::vector<RankReference> reference{twoAnnuli()};
    const std::vector<std::vector<RankAnswer>> answers{{answer(1, 1)}, {answer(1, 1)}, {answer(2, 1)}};
    const std::vector<RankedModel> ranked = rankModels(reference, answers);
    EXPECT_EQ(ranked[0].model, 2u);
    EXPECT_THAT(ranked[0].ties, IsEmpty());
    EXPECT_EQ(ranked[1].rank, 2);
    EXPECT_EQ(ranked[2].rank, 2);
}

TEST(ModelRank, ChannelsAreAveraged) {
    const std::vector<RankReference> reference{twoAnnuli(), twoAnnuli()};
    const std::vector<std::vector<RankAnswer>> answers{{answer(1, 1), answer(2, 2)}};
    const RankedModel ranked = rankModels(reference, answers).front();
    EXPECT_THAT(ranked.profile, DoubleNear((1.0 / 5 + 3.0 / 5) / 2, rounding));
    EXPECT_THAT(ranked.total, DoubleNear((1.0 / 5 + 3.0 / 5) / 2, rounding)) << "signs do not cancel";
    EXPECT_EQ(ranked.shift, 1);
    EXPECT_EQ(ranked.worst_channel, 1u);
}

TEST(ModelRank, WhatIsNotFiniteComesLast) {
    const std::vector<RankReference> reference{twoAnnuli()};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<RankedModel> ranked =
        rankModels(reference, std::vector<std::vector<RankAnswer>>{{answer(nan, 1)}, {answer(100, 100)}});
    EXPECT_EQ(ranked[0].model, 1u);
    EXPECT_EQ(ranked[1].rank, 2);
    EXPECT_THAT(ranked[1].ties, IsEmpty());
    EXPECT_EQ(failureText(reference[0], ranked[1].channels[0], 45), "not finite on this medium");
}

TEST(ModelRank, AShiftThatIsLostInNoiseIsNotCompared) {
    RankReference reference = twoAnnuli();
    reference.mean_x_mm = {0.02, 0.01};
    const RankScore score = rankScore(reference, answer(1, 1));
    EXPECT_TRUE(std::isnan(score.shift.mean));
    EXPECT_THAT(failureText(reference, score, 45), Not(HasSubstr("shift")));
}

TEST(ModelRank, PlanesAreComparedAsTheyAreAndInShape) {
    RankReference reference = twoAnnuli();
    reference.plane = {1, 2, 3, 4};
    reference.plane_error = {0.1, 0.1, 0.1, 0.1};
    RankAnswer model = answer(1, 1);
    model.plane = {2, 4, 6, 8};
    const RankScore twice = rankScore(reference, model);
    EXPECT_THAT(twice.oblique, DoubleNear(1, rounding));
    EXPECT_THAT(twice.shape, DoubleNear(0, rounding));
    EXPECT_THAT(twice.oblique_noise, DoubleNear(std::sqrt(2 / std::numbers::pi) * 0.4 / 10, rounding));
    model.plane = {4, 3, 2, 1};
    const RankScore mirrored = rankScore(reference, model);
    EXPECT_THAT(mirrored.oblique, DoubleNear(0.8, rounding));
    EXPECT_THAT(mirrored.shape, DoubleNear(0.8, rounding));
    EXPECT_TRUE(std::isnan(rankScore(twoAnnuli(), answer(1, 1)).oblique)) << "there is nothing to compare with";
}

// The sentence about a model whose light is `inner` near the beam and 3 `outer` away from it.
std::string sentence(double inner, double outer, double mean_x = 0.5, const RankReference& reference = twoAnnuli()) {
    RankAnswer model = answer(inner, outer);
    model.mean_x_mm = mean_x;
    return failureText(reference, rankScore(reference, model), 45);
}

TEST(ModelRank, SentencesFollowFromTheNumbers) {
    EXPECT_EQ(sentence(1, 1.1), "too low near the beam: 77 % of its error lies within 1 mm; total -14 %");
    EXPECT_EQ(sentence(2.9, 1.02), "too high near the beam: 94 % of its error lies within 1 mm; total +19 %");
    EXPECT_EQ(sentence(1.95, 0.9), "too low away from the beam: 86 % of its error lies beyond 1 mm");
    EXPECT_EQ(sentence(1.7, 1.1),
              "too low near the beam and too high away from it: 50 % and 50 % of its error, on either side of 1 mm");
    EXPECT_EQ(sentence(2.3, 1.1), "too high at all distances: half of its error lies within 1 mm; total +12 %");
    EXPECT_EQ(sentence(2, 1), "no error beyond the noise of the reference");
}

TEST(ModelRank, SentencesSpeakOfTheShift) {
    EXPECT_THAT(sentence(1, 1.3, 0), HasSubstr("; does not shift light that comes at 45°"));
    EXPECT_THAT(sentence(1, 1.3, 0.3), HasSubstr("; shift at 45° -40 %"));
    EXPECT_THAT(sentence(1, 1.3, 0.52), Not(HasSubstr("shift"))) << "4 %, at a noise of 2 %";
}

TEST(ModelRank, ErrorsOfBothSignsInOneFieldAreSaidToBe) {
    RankReference reference = twoAnnuli();
    reference.split_mm = 2;  // both annuli are near
    EXPECT_THAT(sentence(1, 1.2, 0.5, reference), HasSubstr("off to both sides near the beam: 100 %"));
}

}  // namespace
}  // namespace searchlight
