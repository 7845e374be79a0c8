#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "model/evaluator.h"
#include "model/native_models.h"
#include "model/physics.h"

namespace searchlight {

namespace {

Medium skin() { return {{0.032, 0.17, 0.48}, {0.74, 0.88, 1.01}, {0, 0, 0}, 1.3, 3}; }

Model shipped(const std::string& id) {
    for (const Model& model : shippedModels())
        if (model.id == id) return model;
    throw usageError("no model " + id);
}

std::vector<Query> plane(std::size_t count, double r_min, double r_max) {
    std::vector<Query> queries;
    for (std::size_t i = 0; i < count; ++i) {
        const double t = count == 1 ? 0 : static_cast<double>(i) / static_cast<double>(count - 1);
        const double r = r_min * std::pow(r_max / r_min, t);
        queries.push_back({{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, {r, 0, 0}, {0, 0, 1}, {0, 0, 1}});
    }
    return queries;
}

std::vector<Rgb> evaluate(Evaluator& evaluator, const std::vector<Query>& queries) {
    std::vector<Rgb> values(queries.size());
    evaluator.evaluate(queries, values);
    return values;
}

}  // namespace

TEST(NativeEvaluator, EveryShippedModelHasOne) {
    ASSERT_FALSE(shippedModels().empty());
    for (const Model& model : shippedModels()) EXPECT_TRUE(hasNativeEvaluator(model)) << model.id;
}

TEST(NativeEvaluator, EveryShippedModelIsInThePortableSubset) {
    for (const Model& model : shippedModels()) EXPECT_FALSE(portabilityError(model.file)) << model.id;
}

TEST(NativeEvaluator, AModelOfAUserHasNoneEvenUnderAShippedName) {
    Model model = shipped("dipole");
    model.shipped = false;
    EXPECT_FALSE(hasNativeEvaluator(model));
}

TEST(NativeEvaluator, DipoleMatchesTheFormulaOfThePaper) {
    // [Jensen2001] Eq. 4 with the published Fresnel fit, written out by hand.
    const double sigma_a = 0.0041, sigma_sp = 2.62, eta = 1.5, r = 1;
    const double sigma_tp = sigma_a + sigma_sp, fdr = -1.44 / (eta * eta) + 0.71 / eta + 0.668 + 0.0636 * eta;
    const double a = (1 + fdr) / (1 - fdr), zr = 1 / sigma_tp, zv = zr * (1 + 4 * a / 3);
    const double s = std::sqrt(3 * sigma_a * sigma_tp), dr = std::hypot(r, zr), dv = std::hypot(r, zv);
    const auto flux = [&](double z, double d) { return z * (1 + s * d) * std::exp(-s * d) / (d * d * d); };
    const double expected = sigma_sp / sigma_tp / (4 * std::numbers::pi) * (flux(zr, dr) + flux(zv, dv));

    const auto evaluator = makeNativeEvaluator(shipped("dipole"));
    evaluator->set({{sigma_a, sigma_a, sigma_a}, {sigma_sp, sigma_sp, sigma_sp}, {}, eta, 1}, {});
    const Rgb value = evaluate(*evaluator, plane(1, r, r))[0];
    // The published fit may carry more digits than the one above: 1e-3 of F is 5e-4 of R_d here.
    EXPECT_NEAR(value.r / expected, 1, 5e-4);
    EXPECT_EQ(value.r, value.b);
    EXPECT_EQ(evaluator->backend(), "cpu double");
}

TEST(NativeEvaluator, FloatAgreesWithDouble) {
    for (const Model& model : shippedModels()) {
        const auto in_double = makeNativeEvaluator(model), in_float = makeNativeEvaluator(model, Precision::single_);
        in_double->set(skin(), {});
        in_float->set(skin(), {});
        EXPECT_EQ(in_float->backend(), "cpu float");
        const std::vector<Query> queries = plane(40, 1e-3, 30);
        const std::vector<Rgb> exact = evaluate(*in_double, queries), rounded = evaluate(*in_float, queries);
        for (std::size_t i = 0; i < queries.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                // Far out, exp(-x) in float has a relative error of x 2^-24; x is below 45 here. What is
                // below the smallest normal float may vanish.
                EXPECT_NEAR(rounded[i][c], exact[i][c], 1e-5 * std::abs(exact[i][c]) + 1e-37)
                    << model.id << " at " << queries[i].xo.x << " mm, channel " << c;
            }
    }
}

TEST(NativeEvaluator, ManyQueriesGiveTheSameValuesAsFew) {
    // Above 16k queries work goes to threads; models with normals then copy themselves.
    for (const char* id : {"dipole", "directional_dipole"}) {
        const auto evaluator = makeNativeEvaluator(shipped(id));
        evaluator->set(skin(), {});
        std::vector<Query> queries = plane(20'000, 1e-2, 10);
        for (std::size_t i = 0; i < queries.size(); i += 2) queries[i].no = {0.6, 0, 0.8};
        const std::vector<Rgb> together = evaluate(*evaluator, queries);
        for (const std::size_t i : {std::size_t{0}, std::size_t{4095}, std::size_t{4096}, std::size_t{19'999}})
            EXPECT_EQ(evaluate(*evaluator, {queries[i]})[0], together[i]) << id << ' ' << i;
    }
}

TEST(NativeEvaluator, ParametersReachTheModel) {
    const auto evaluator = makeNativeEvaluator(shipped("dipole"));
    evaluator->set(skin(), {});
    const Rgb published = evaluate(*evaluator, plane(1, 1, 1))[0];
    evaluator->set(skin(), {{"Fresnel", std::string("exact")}});
    const Rgb exact = evaluate(*evaluator, plane(1, 1, 1))[0];
    EXPECT_NE(published.r, exact.r);
    EXPECT_NEAR(published.r / exact.r, 1, 1e-2);  // the fit of F is good to 1e-3
    EXPECT_THROW(evaluator->set(skin(), {{"Fresnel", std::string("guessed")}}), Error);
}

TEST(NativeEvaluator, DiffuseReflectanceIsRefusedWhereTheModelHasNone) {
    const auto evaluator = makeNativeEvaluator(shipped("directional_dipole"));
    evaluator->set(skin(), {});
    EXPECT_THROW(evaluator->diffuseReflectance({0.5, 0.5, 0.5}), Error);
}

TEST(NativeEvaluator, DiffuseReflectanceFollowsTheClosedForm) {
    const auto evaluator = makeNativeEvaluator(shipped("dipole"));
    Medium matched = skin();
    matched.eta = 1;
    evaluator->set(matched, {{"Fresnel", std::string("exact")}});
    // A = 1 without a boundary: R_d = a'/2 (1 + exp(-4/3 q)) exp(-q), q = sqrt(3 (1 - a')).
    for (const double albedo : {0.1, 0.5, 0.9, 1.0}) {
        const double q = std::sqrt(3 * (1 - albedo));
        const double expected = albedo / 2 * (1 + std::exp(-4 * q / 3)) * std::exp(-q);
        EXPECT_NEAR(evaluator->diffuseReflectance({albedo, 0.5, 0.5}).r, expected, 1e-15);  // rounding
    }
}

TEST(Physics, IsCallableFromCpp) {
    // Total reflection: beyond the critical angle of 1.5 every cosine below 0.745 reflects all.
    EXPECT_EQ(Physics<double>::fresnelReflectance(0.5, 1.5), 1);
    EXPECT_NEAR(Physics<double>::fresnelReflectance(1, 1.5), 0.04, 1e-15);  // rounding
    EXPECT_NEAR(Physics<float>::fresnelReflectance(1, 1.5f), 0.04f, 1e-7f);
}

}  // namespace searchlight
