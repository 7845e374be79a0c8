#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "gl_test_model.h"
#include "limits.h"
#include "scene/materials.h"

namespace searchlight {
namespace {

// As GL gets it: at exponents of 70 the rounding of the input alone would show.
double rounded(double value) { return static_cast<float>(value); }
Rgb rounded(const Rgb& value) { return {rounded(value.r), rounded(value.g), rounded(value.b)}; }

constexpr std::array azimuths_deg = {0.0, 65.0, 90.0, 180.0};

// What the error of value i is relative to: the value. A model that is not radial subtracts an image from a source and
// passes through 0 on its way upstream; rounding is then relative to the parts, as large as the largest value at that
// r. Near a radius where a radial model changes its sign it is relative to the largest value around.
double scaleAt(const std::vector<Rgb>& values, std::size_t i, int channel, bool radial) {
    const std::size_t azimuths = azimuths_deg.size(), first = i / azimuths * azimuths;
    // Radii within a factor of two of a radial model that changes its sign.
    const std::size_t reach = radial ? 7 * azimuths : 0;
    const std::size_t begin = first - std::min(first, reach);
    const std::size_t end = std::min(first + azimuths + reach, values.size());
    double least = 0, largest = 0;
    for (std::size_t k = begin; k < end; ++k) {
        least = std::min(least, values[k][channel]);
        largest = std::max(largest, values[k][channel]);
    }
    if (radial && (least == 0 || largest == 0)) return std::abs(values[i][channel]);
    return std::max(largest, -least);
}

// From 1e-3 to 30 mean free paths of every channel, downstream, upstream and aside of the beam.
std::vector<Query> queriesFor(const Medium& medium, double angle_deg) {
    const double angle = angle_deg * M_PI / 180;
    const Rgb sigma_t = medium.sigmaT(), sigma_tp = medium.sigmaTp();
    const double nearest = 1e-3 / std::max({sigma_t.r, sigma_t.g, sigma_t.b});
    const double farthest = 30 / std::min({sigma_tp.r, sigma_tp.g, sigma_tp.b});
    std::vector<Query> queries;
    for (const double r : ratioSteps(nearest, farthest, 120)) {
        for (const double azimuth_deg : azimuths_deg) {
            const double azimuth = azimuth_deg * M_PI / 180;
            Query query = queryAt(0);
            query.xo = {rounded(r * std::cos(azimuth)), rounded(r * std::sin(azimuth)), 0};
            query.wi = {rounded(-std::sin(angle)), 0, rounded(std::cos(angle))};
            queries.push_back(query);
        }
    }
    return queries;
}

struct Case {
    std::string material;
    Medium medium;
};

std::vector<Case> cases() {
    std::vector<Case> all;
    for (const char* id : {"jensen2001:marble", "jensen2001:skin1", "jensen2001:ketchup"})
        all.push_back({id, findMaterial(id).medium});
    all.push_back({"g = 0.9", {{0.01, 0.1, 0.001}, {10, 20, 5}, {0.9, 0.9, 0.9}, 1.33}});
    all.push_back({"matched", {{0.01, 0.1, 1}, {1, 1, 1}, {0, 0, 0.5}, 1}});
    for (const LimitCase& each : limitCases()) all.push_back({each.name, each.medium});
    for (auto& [name, medium] : all)
        medium = {rounded(medium.sigma_a), rounded(medium.sigma_s), rounded(medium.g), rounded(medium.eta)};
    return all;
}

// An exponent of 80 multiplies the rounding of its factors by 80: 3 of them are 1e-5 (media of an albedo of .02 have
// one more). The exponent of single scattering is made of six: along, across, the end of the angles, their quotient,
// their sum, and its product with the extinction; that of a slab's mode of four. The init() of two_layers integrates in
// single precision, where slabs let 1e-8 through.
double tolerance(const Model& model) {
    if (model.id == "two_layers") return 1e-4;
    return model.id.starts_with("single") || model.id == "multipole" ? 2e-5 : 1e-5;
}

class GlNativeAgreement : public testing::TestWithParam<std::string> {};

std::vector<std::string> shippedIds() {
    std::vector<std::string> ids;
    for (const Model& model : shippedModels()) ids.push_back(model.id);
    return ids;
}

TEST_P(GlNativeAgreement, IsWithinRoundingFrom1em3To30MeanFreePaths) {
    const Model model = loadModel(GetParam());
    ASSERT_TRUE(hasNativeEvaluator(model));
    gl::Context context;
    const auto on_gl = makeGlEvaluator(model, context);
    const auto native = makeNativeEvaluator(model, Precision::double_);
    for (const ParamValues& parameters : settings(model)) {
        for (const Case& test : cases()) {
            on_gl->set(test.medium, parameters);
            native->set(test.medium, parameters);
            for (const double angle_deg : {0.0, 60.0}) {
                const std::vector<Query> queries = queriesFor(test.medium, angle_deg);
                std::vector<Rgb> values(queries.size()), expected(queries.size());
                on_gl->evaluate(queries, values);
                native->evaluate(queries, expected);
                double worst = 0;
                std::string where;
                for (std::size_t i = 0; i < queries.size(); ++i) {
                    for (int c = 0; c < 3; ++c) {
                        if (length(queries[i].xo) * test.medium.sigmaTp()[c] > 30) continue;
                        const double scale = scaleAt(expected, i, c, model.file.radial);
                        if (scale < 1e-35 && std::abs(values[i][c]) < 1e-35) continue;
                        const double rounding = test.medium.alphaPrime()[c] < 0.05 ? 4.0 / 3 : 1;
                        const double error = std::abs(values[i][c] - expected[i][c]) / (rounding * scale);
                        if (error <= worst) continue;
                        worst = error;
                        where = fmt::format("x = ({}, {}) mm, channel {}: GL {}, double {}", queries[i].xo.x,
                                            queries[i].xo.y, c, values[i][c], expected[i][c]);
                    }
                }
                EXPECT_LE(worst, tolerance(model))
                    << test.material << settingText(parameters) << ", " << angle_deg << " deg, " << where;
            }
        }
    }
}

TEST_P(GlNativeAgreement, GlGivesNumbersAtTheLimits) {
    const Model model = loadModel(GetParam());
    gl::Context context;
    expectNumbers(*makeGlEvaluator(model, context), model);
}

TEST_P(GlNativeAgreement, OfDiffuseReflectanceIsWithin1em5) {
    const Model model = loadModel(GetParam());
    if (!model.file.diffuse_reflectance.present()) GTEST_SKIP() << "the model has no DiffuseReflectance";
    gl::Context context;
    const auto on_gl = makeGlEvaluator(model, context);
    const auto native = makeNativeEvaluator(model, Precision::double_);
    for (const ParamValues& parameters : settings(model)) {
        for (const Case& test : cases()) {
            on_gl->set(test.medium, parameters);
            native->set(test.medium, parameters);
            for (const double a : {0.05, 0.3, 0.7, 0.95, 0.999, 1.0}) {
                const Rgb value = on_gl->diffuseReflectance({a, a, a});
                const Rgb expected = native->diffuseReflectance({a, a, a});
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(value[c], expected[c], 1e-5 * expected[c])
                        << test.material << settingText(parameters) << ", alpha' = " << a;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Shipped, GlNativeAgreement, testing::ValuesIn(shippedIds()),
                         [](const auto& id) { return id.param; });

}  // namespace
}  // namespace searchlight
