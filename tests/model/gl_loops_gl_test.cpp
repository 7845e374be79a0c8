#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>

#include "base/error.h"
#include "gl_test_model.h"

namespace searchlight {
namespace {

using testing::HasSubstr;

// A model whose Bssrdf has `body` on line 5.
std::string modelText(std::string_view body) {
    return fmt::format(
        "analytic\n::begin shader\nvec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {{\n    float Sum = 0.0;\n"
        "{}\n    return vec3(Sum);\n}}\n::end shader\n",
        body);
}

class GlLoops : public testing::Test {
protected:
    // The line at which a batch of 20,000 queries fails.
    int failingLine(const std::string& text) {
        const Model model = modelOf(text);
        const auto evaluator = makeGlEvaluator(model, context_);
        std::vector<Query> queries(20'000, queryAt(1));
        std::vector<Rgb> values(queries.size());
        try {
            evaluator->set({{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, 1}, {});
            evaluator->evaluate(queries, values);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind, ErrorKind::input);
            EXPECT_EQ(error.file, "test.bssrdf");
            EXPECT_THAT(error.message, HasSubstr(fmt::format("loop at line {} exceeded ", error.line)));
            return error.line;
        }
        ADD_FAILURE() << "the loops ended";
        return 0;
    }

    double sumOf(std::string_view body) { return evaluateText(modelText(body), context_).r; }

    gl::Context context_;
};

TEST_F(GlLoops, EndlessForIsReportedAtItsLine) {
    EXPECT_EQ(failingLine(modelText("for (;;) Sum += 1.0;")), 5);
    EXPECT_EQ(failingLine(modelText("for (int i = 0; i > -1;) Sum += 1.0;")), 5);
    EXPECT_EQ(failingLine(modelText("\n\nfor (int i = 0; true; i++) { if (Sum < -1.0) continue; Sum += 1.0; }")), 7);
}

TEST_F(GlLoops, EndlessWhileIsReportedAtItsLine) {
    EXPECT_EQ(failingLine(modelText("while (true) Sum += 1.0;")), 5);
    EXPECT_EQ(failingLine(modelText("while (bool more = Sum >= 0.0) Sum += 1.0;")), 5);
}

TEST_F(GlLoops, EndlessDoIsReportedAtItsCondition) {
    EXPECT_EQ(failingLine(modelText("do {\n    Sum += 1.0;\n} while (Sum >= 0.0);")), 7);
}

TEST_F(GlLoops, EndlessInnerLoopIsReportedAtItsLine) {
    EXPECT_EQ(failingLine(modelText("for (int i = 0; i < 3; ++i) {\n    while (i >= 0) Sum += 1.0;\n}")), 6);
}

TEST_F(GlLoops, EndlessLoopOverPhysicsIsReportedAtTheModelsLine) {
    EXPECT_EQ(failingLine(modelText("for (;;)\n    Sum += fresnelMoment(1, 1.5 + Sum);")), 5);
}

TEST_F(GlLoops, NestedLoopsSpendOneBudget) {
    const int line = failingLine(
        modelText("for (int i = 0; i < 2000; ++i)\n    for (int j = 0; j < 2000; ++j)\n        Sum += 1.0;"));
    EXPECT_TRUE(line == 5 || line == 6);
}

TEST_F(GlLoops, EndlessLoopInInitIsReported) {
    EXPECT_EQ(failingLine("analytic\n::begin initializer\nfloat A;\nvoid init() {\n    A = 0.0;\n    while (A >= 0.0)\n"
                          "        A += 1.0;\n}\n::end initializer\n::begin shader\n"
                          "vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return vec3(A); }\n::end shader\n"),
              6);
}

TEST_F(GlLoops, EndlessLoopInDiffuseReflectanceIsReported) {
    const Model model = modelOf(
        "analytic\n::begin diffuseReflectance\nvec3 DiffuseReflectance(vec3 AlphaPrime) {\n    vec3 A = AlphaPrime;\n"
        "    while (A.x >= 0.0) A += 1.0;\n    return A;\n}\n::end diffuseReflectance\n::begin shader\n"
        "vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return Xi; }\n::end shader\n");
    const auto evaluator = makeGlEvaluator(model, context_);
    evaluator->set({}, {});
    try {
        evaluator->diffuseReflectance({1, 1, 1});
        FAIL() << "the loop ended";
    } catch (const Error& error) {
        EXPECT_EQ(error.line, 5);
    }
}

// Lanes that run different loops share the driver's count on llvmpipe: each stays below the budget, their sum does not.
TEST_F(GlLoops, LoopsThatTheDriverCutAreNeverPassedOffAsDone) {
    const Model model =
        modelOf(modelText("if (Xo.x > 0.5) for (int i = 0; i < 40000; ++i) Sum += 1.0;\n"
                          "else for (int i = 0; i < 40000; ++i) Sum += 1.0;"));
    const auto evaluator = makeGlEvaluator(model, context_);
    evaluator->set({}, {});
    std::vector<Query> queries;
    for (int i = 0; i < 64; ++i) queries.push_back(queryAt(i % 2));
    std::vector<Rgb> values(queries.size());
    try {
        evaluator->evaluate(queries, values);
        for (const Rgb& value : values) EXPECT_EQ(value.r, 40'000);
    } catch (const Error& error) {
        EXPECT_THAT(error.message, HasSubstr("exceeded"));
    }
}

TEST_F(GlLoops, EndlessLoopIsReportedWithinTwoSeconds) {
    const auto start = std::chrono::steady_clock::now();
    failingLine(modelText("for (;;) Sum += exp(-Sum) * sin(Sum) + pow(abs(Sum), 0.3);"));
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_LT(seconds.count(), 2);
}

TEST_F(GlLoops, EvaluatorWorksAfterALoopFailed) {
    const Model model = modelOf(modelText("while (Xo.x > 5.0) Sum += 1.0;\nSum += 1.0;"));
    const auto evaluator = makeGlEvaluator(model, context_);
    evaluator->set({}, {});
    EXPECT_EQ(evaluateAt(*evaluator, queryAt(1)).r, 1);
    EXPECT_THROW(evaluateAt(*evaluator, queryAt(6)), Error);
    EXPECT_EQ(evaluateAt(*evaluator, queryAt(1)).r, 1);
}

TEST_F(GlLoops, LoopsThatEndGiveTheirResult) {
    EXPECT_EQ(sumOf("for (int i = 0; i < 50000; ++i) Sum += 1.0;"), 50'000);
    EXPECT_EQ(sumOf("for (int i = 0, j = 5; i < 10 && (j > 2 || i < 4); ++i, --j) Sum += 1.0;"), 4);
    EXPECT_EQ(sumOf("while (Sum < 7.0) { Sum += 1.0; if (Sum == 3.0) break; }"), 3);
    EXPECT_EQ(sumOf("do Sum += 1.0; while (Sum < 5.0);"), 5);
    EXPECT_EQ(sumOf("do { Sum += 1.0; if (Sum < 3.0) continue; } while (Sum < 4.0);"), 4);
    EXPECT_EQ(sumOf("while (bool more = Sum < 7.0) Sum += more ? 1.0 : 100.0;"), 7);
    EXPECT_EQ(sumOf("for (int i = 0; bool(i < 6); i++) { switch (i) { case 3: break; default: Sum += 1.0; } }"), 5);
}

TEST_F(GlLoops, LaterLoopsRunInFullAfterEarlierOnes) {
    EXPECT_EQ(sumOf("for (int k = 0; k < 20; ++k)\n    for (int i = 0; i < 2000; ++i) Sum += 1.0;\n"
                    "for (int i = 0; i < 5000; ++i) Sum += 1.0;"),
              45'000);
}

}  // namespace
}  // namespace searchlight
