#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/files.h"
#include "gl_test_model.h"

namespace searchlight {
namespace {

using testing::HasSubstr;

// The listing of the thesis: plain globals that init() fills, one of which a parameter of DiffuseReflectance hides.
Model thesisDipole() {
    const std::string path = SEARCHLIGHT_SOURCE_DIR "/tests/language/data/listing_a2.bssrdf";
    return modelOf(readFile(path), path);
}

// [Jensen2001] Eq. 4 in double, without the arrangement of the listing.
double dipole(double sigma_a, double sigma_sp, double eta, double r) {
    const double sigma_tp = sigma_a + sigma_sp, sigma_tr = std::sqrt(3 * sigma_a * sigma_tp);
    const double fdr = -1.44 / (eta * eta) + 0.71 / eta + 0.668 + 0.0636 * eta;
    const double zr = 1 / sigma_tp, zv = zr * (1 + 4.0 / 3 * (1 + fdr) / (1 - fdr));
    const auto flux = [&](double z) {
        const double d = std::hypot(r, z);
        return z * (1 + sigma_tr * d) * std::exp(-sigma_tr * d) / (d * d * d);
    };
    return sigma_sp / sigma_tp / (4 * M_PI) * (flux(zr) + flux(zv));
}

class GlEvaluator : public testing::Test {
protected:
    gl::Context context_;
};

TEST_F(GlEvaluator, ThesisDipoleAgreesWithDouble) {
    const Model model = thesisDipole();
    const auto evaluator = makeGlEvaluator(model, context_);
    const Medium marble{{0.0021, 0.0041, 0.0071}, {2.19, 2.62, 3.00}, {0, 0, 0}, 1.5};
    evaluator->set(marble, {});
    for (const double r : ratioSteps(1e-3 / 3, 30 / 2.19, 200)) {
        const Rgb value = evaluateAt(*evaluator, queryAt(r));
        for (int c = 0; c < 3; ++c) {
            const double expected = dipole(marble.sigma_a[c], marble.sigma_s[c], marble.eta, r);
            // Rounding of float: about ten operations, and an exponent of up to 6 that doubles the error of sigma_tr.
            EXPECT_NEAR(value[c] / expected, 1, 1e-5) << "r = " << r << " mm, channel " << c;
        }
    }
}

TEST_F(GlEvaluator, ParameterThatShadowsStateIsTheParameter) {
    const Model model = thesisDipole();
    const auto evaluator = makeGlEvaluator(model, context_);
    evaluator->set({{0.1, 0.1, 0.1}, {1, 1, 1}, {0, 0, 0}, 1.5}, {});
    const Rgb value = evaluator->diffuseReflectance({0.5, 0.9, 1});
    const double a = (1 + 0.5964) / (1 - 0.5964);  // Fdr(1.5) = -.64 + .473333 + .668 + .0954 = .596733
    EXPECT_NEAR(value.r, 0.25 * (1 + std::exp(-4.0 / 3 * a * std::sqrt(1.5))) * std::exp(-std::sqrt(1.5)), 1e-4);
    EXPECT_NEAR(value.b, 1, 1e-6);
}

TEST_F(GlEvaluator, NewMediumRunsInitAgain) {
    const Model model = thesisDipole();
    const auto evaluator = makeGlEvaluator(model, context_);
    evaluator->set({{0.1, 0.1, 0.1}, {1, 1, 1}, {0, 0, 0}, 1.3}, {});
    evaluateAt(*evaluator, queryAt(1));
    evaluator->set({{1, 1, 1}, {2, 2, 2}, {0, 0, 0}, 1.5}, {{"Multiplier", 2.0}});
    EXPECT_NEAR(evaluateAt(*evaluator, queryAt(1)).g / (2 * dipole(1, 2, 1.5, 1)), 1, 1e-5);
}

TEST_F(GlEvaluator, LargeBatchesAreSlicedInOrder) {
    const Model model = modelOf(
        "analytic\n::begin shader\nvec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {\n"
        "return vec3(Xi.x, Xo.y, Wo.z); }\n::end shader\n");
    const auto evaluator = makeGlEvaluator(model, context_);
    evaluator->set({{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, 1}, {});
    std::vector<Query> queries(40'001);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const auto number = static_cast<double>(i);
        queries[i].xi.x = number;
        queries[i].xo.y = number + 0.5;
        queries[i].wo.z = -number;
    }
    std::vector<Rgb> values(queries.size());
    evaluator->evaluate(queries, values);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const auto number = static_cast<double>(i);
        ASSERT_EQ(values[i], (Rgb{number, number + 0.5, -number}));
    }
    evaluator->evaluate({}, {});
}

TEST_F(GlEvaluator, MediumReachesTheShader) {
    const auto text = [](std::string_view value) {
        return std::string("analytic\n::begin shader\nvec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return ") +
               std::string(value) + "; }\n::end shader\n";
    };
    const auto floats = [](double r, double g, double b) { return Rgb{float(r), float(g), float(b)}; };
    EXPECT_EQ(evaluateText(text("SigmaA"), context_), floats(0.1, 0.2, 0.3));
    EXPECT_EQ(evaluateText(text("SigmaS"), context_), floats(1, 2, 3));
    EXPECT_EQ(evaluateText(text("G"), context_), floats(0, 0.5, 0.9));
    EXPECT_EQ(evaluateText(text("vec3(IOR, PI, 0)"), context_), floats(1.5, M_PI, 0));
}

TEST_F(GlEvaluator, NormalsReachTheShader) {
    const Model model = modelOf(
        "analytic normals\n::begin shader\n"
        "vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return vec3(Ni.x, No.y, Wi.z); }\n"
        "::end shader\n");
    const auto evaluator = makeGlEvaluator(model, context_);
    evaluator->set({}, {});
    EXPECT_EQ(evaluateAt(*evaluator, {{}, {0, 0, 3}, {1, 9, 9}, {}, {}, {9, 2, 9}}), (Rgb{1, 2, 3}));
}

constexpr std::string_view all_parameters = R"(analytic
::begin parameters
float Scale 0 10 2
bool Flag true
color Tint 0.25 0.5 0.75
choice Mode first|second|third second
::end parameters
::begin shader
vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {
    if (Mode == Mode_first) return Tint;
    if (Mode == Mode_third) return vec3(Flag ? 1.0 : 0.0);
    return vec3(Scale);
}
::end shader
)";

TEST_F(GlEvaluator, ParametersHaveTheirDefaults) { EXPECT_EQ(evaluateText(all_parameters, context_), (Rgb{2, 2, 2})); }

TEST_F(GlEvaluator, ParametersReachTheShader) {
    EXPECT_EQ(evaluateText(all_parameters, context_, {{"Scale", 7.5}}), (Rgb{7.5, 7.5, 7.5}));
    EXPECT_EQ(evaluateText(all_parameters, context_, {{"Mode", "first"}}), (Rgb{0.25, 0.5, 0.75}));
    EXPECT_EQ(evaluateText(all_parameters, context_, {{"Mode", "first"}, {"Tint", Rgb{1, 0, 0.5}}}), (Rgb{1, 0, 0.5}));
    EXPECT_EQ(evaluateText(all_parameters, context_, {{"Mode", "third"}}), (Rgb{1, 1, 1}));
    EXPECT_EQ(evaluateText(all_parameters, context_, {{"Mode", "third"}, {"Flag", false}}), (Rgb{0, 0, 0}));
}

TEST_F(GlEvaluator, ParametersReachInitAndDiffuseReflectance) {
    const Model model = modelOf(R"(analytic
::begin parameters
float Scale 0 10 2
::end parameters
::begin initializer
float FromInit;
void init() { FromInit = Scale; }
::end initializer
::begin diffuseReflectance
vec3 DiffuseReflectance(vec3 AlphaPrime) { return Scale * AlphaPrime + FromInit; }
::end diffuseReflectance
::begin shader
vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return vec3(FromInit); }
::end shader
)");
    const auto evaluator = makeGlEvaluator(model, context_);
    evaluator->set({}, {{"Scale", 3.0}});
    EXPECT_EQ(evaluateAt(*evaluator, queryAt(1)), (Rgb{3, 3, 3}));
    EXPECT_EQ(evaluator->diffuseReflectance({1, 2, 0}), (Rgb{6, 9, 3}));
    evaluator->set({}, {{"Scale", 4.0}});
    EXPECT_EQ(evaluator->diffuseReflectance({1, 2, 0}), (Rgb{8, 12, 4}));
}

TEST_F(GlEvaluator, ParameterOutOfRangeIsAUsageError) {
    try {
        evaluateText(all_parameters, context_, {{"Scale", 11.0}});
        FAIL() << "11 is beyond 10";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::usage);
    }
}

TEST_F(GlEvaluator, StateHoldsArraysAndInitialValues) {
    EXPECT_EQ(evaluateText(R"(analytic
::begin initializer
const int N = 3;
float W[N];
vec3 Tint = vec3(1.0,
                 2.0, 3.0);  // over two lines
bool Filled = false;
mat3 Turn;
float twice(float x) { return 2.0 * x; }
void init() {
    for (int i = 0; i < N; ++i) W[i] = twice(float(i));
    Turn = mat3(1.0);
    Filled = true;
}
::end initializer
::begin shader
vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {
    float Sum = 0.0;
    for (int i = 0; i < N; ++i) Sum += twice(W[i]);
    return Filled ? Sum * (Turn * Tint) : vec3(0.0);
}
::end shader
)",
                           context_),
              (Rgb{12, 24, 36}));
}

TEST_F(GlEvaluator, NonFiniteValuesPassThrough) {
    const Rgb value = evaluateText(
        "analytic\n::begin shader\nvec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {\n"
        "float Zero = Xi.x; return vec3(Zero / Zero, 1.0 / Zero, -1.0 / Zero); }\n"
        "::end shader\n",
        context_);
    EXPECT_TRUE(std::isnan(value.r));
    EXPECT_EQ(value.g, std::numeric_limits<double>::infinity());
    EXPECT_EQ(value.b, -std::numeric_limits<double>::infinity());
}

TEST_F(GlEvaluator, ChannelWithoutScatteringIsLeftAsTheModelComputesIt) {
    const Model model = thesisDipole();
    const auto evaluator = makeGlEvaluator(model, context_);
    evaluator->set({{0, 0.1, 0.1}, {0, 1, 1}, {0, 0, 0}, 1.5}, {});
    const Rgb value = evaluateAt(*evaluator, queryAt(1));
    EXPECT_TRUE(std::isnan(value.r));
    EXPECT_NEAR(value.g / dipole(0.1, 1, 1.5, 1), 1, 1e-5);
}

TEST_F(GlEvaluator, ModelWithoutDiffuseReflectanceIsAUsageError) {
    const Model model = modelOf(
        "analytic\n::begin shader\nvec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {\n"
        "return Xi; }\n::end shader\n");
    const auto evaluator = makeGlEvaluator(model, context_);
    try {
        evaluator->diffuseReflectance({1, 1, 1});
        FAIL() << "a reflectance came from nowhere";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::usage);
        EXPECT_THAT(error.message, HasSubstr("DiffuseReflectance"));
    }
}

TEST_F(GlEvaluator, OutlivesTheModelItWasMadeFrom) {
    std::unique_ptr<Evaluator> evaluator;
    {
        const Model model = modelOf(all_parameters);
        evaluator = makeGlEvaluator(model, context_);
    }
    evaluator->set({}, {{"Scale", 5.0}});
    EXPECT_EQ(evaluateAt(*evaluator, queryAt(1)).r, 5);
}

TEST_F(GlEvaluator, NamesItsBackend) {
    const Model model = modelOf(all_parameters);
    EXPECT_EQ(makeGlEvaluator(model, context_)->backend(), "gl " + context_.info().renderer);
}

TEST_F(GlEvaluator, TwoEvaluatorsShareAContext) {
    const Model first_model = modelOf(all_parameters), second_model = thesisDipole();
    const auto first = makeGlEvaluator(first_model, context_);
    const auto second = makeGlEvaluator(second_model, context_);
    first->set({}, {{"Scale", 5.0}});
    second->set({{1, 1, 1}, {2, 2, 2}, {0, 0, 0}, 1.5}, {});
    EXPECT_EQ(evaluateAt(*first, queryAt(1)).r, 5);
    EXPECT_NEAR(evaluateAt(*second, queryAt(1)).r / dipole(1, 2, 1.5, 1), 1, 1e-5);
}

}  // namespace
}  // namespace searchlight
