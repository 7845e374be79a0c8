#include <gtest/gtest.h>

#include "base/error.h"
#include "gl_test_model.h"

namespace searchlight {
namespace {

using testing::HasSubstr;

class GlErrors : public testing::Test {
protected:
    // The error of a model that must not compile.
    Error errorOf(std::string_view text) {
        try {
            evaluateText(text, context_);
        } catch (const Error& error) {
            return error;
        }
        ADD_FAILURE() << "the model compiled";
        return inputError("none");
    }

    gl::Context context_;
};

TEST_F(GlErrors, InShaderHasFileLineAndColumn) {
    const Error error = errorOf(R"(analytic
::begin shader
/* one comment */ vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {
    // and another
	for (int i = 0; i < 2; ++i) { }   /* tab, loop */  float a = missing;
    return vec3(a);
}
::end shader
)");
    EXPECT_EQ(error.kind, ErrorKind::input);
    EXPECT_EQ(error.file, "test.bssrdf");
    EXPECT_EQ(error.line, 5);
    EXPECT_EQ(error.column, 63);
    EXPECT_EQ(error.message, "`missing' undeclared");
}

TEST_F(GlErrors, InInitializerHasFileLineAndColumn) {
    const Error error = errorOf(R"(analytic
::begin initializer
float A;
float B = 2.0;

float half_of(float x) { return x / 2.0; }
void init() {
    A = half_of(B) + vec2(1.0)   * mat3(1.0);
}
::end initializer
::begin shader
vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return vec3(A); }
::end shader
)");
    EXPECT_EQ(error.line, 8);
    EXPECT_EQ(error.column, 22);
}

TEST_F(GlErrors, InInitialValueStandsAtItsName) {
    const Error error = errorOf(R"(analytic
::begin initializer
float A, Bad = vec3(1.0);
void init() { A = 1.0; }
::end initializer
::begin shader
vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return vec3(A); }
::end shader
)");
    EXPECT_EQ(error.line, 3);
    EXPECT_EQ(error.column, 10);
}

TEST_F(GlErrors, InDiffuseReflectanceIsFoundWithoutCallingIt) {
    const Error error = errorOf(R"(analytic
::begin diffuseReflectance
vec3 DiffuseReflectance(vec3 AlphaPrime) {
    vec3 Twice = 2.0 *  nothing;
    return Twice;
}
::end diffuseReflectance
::begin shader
vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return Xi; }
::end shader
)");
    EXPECT_EQ(error.line, 4);
    EXPECT_EQ(error.column, 25);
}

TEST_F(GlErrors, SeveralAreCounted) {
    const Error error = errorOf(R"(analytic
::begin shader
vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {
    float a = missing_1;
    float b = missing_2;
    return vec3(a + b);
}
::end shader
)");
    EXPECT_EQ(error.message, "`missing_1' undeclared");
    EXPECT_EQ(error.hint, "and 1 more");
}

TEST_F(GlErrors, SyntaxErrorStandsAtTheUnexpectedToken) {
    const Error error = errorOf(R"(analytic
::begin shader
vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {
    return Xi Xo;
}
::end shader
)");
    EXPECT_EQ(error.line, 4);
    EXPECT_EQ(error.column, 15);
    EXPECT_THAT(error.message, HasSubstr("unexpected"));
}

TEST_F(GlErrors, LoopConditionKeepsItsColumn) {
    const Error error = errorOf(R"(analytic
::begin shader
vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {
    float Sum = 0.0;
    while (Sum < 3.0 && missing) Sum += 1.0; return also_missing;
}
::end shader
)");
    EXPECT_EQ(error.line, 5);
    EXPECT_EQ(error.column, 25);
}

TEST_F(GlErrors, StateIsReadOnlyOutsideInit) {
    const Error error = errorOf(R"(analytic
::begin initializer
float A;
void init() { A = 1.0; }
::end initializer
::begin shader
vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {
    A += 1.0;
    return vec3(A);
}
::end shader
)");
    EXPECT_EQ(error.file, "test.bssrdf");
    EXPECT_EQ(error.line, 8);
    EXPECT_EQ(error.column, 5);
}

TEST_F(GlErrors, NormalsNeedTheirAttribute) {
    const Error error = errorOf(R"(analytic
::begin shader
vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return Ni; }
::end shader
)");
    EXPECT_EQ(error.line, 3);
    EXPECT_EQ(error.column, 58);
    EXPECT_EQ(error.message, "`Ni' undeclared");
}

TEST_F(GlErrors, RecursionIsRefused) {
    const Error error = errorOf(R"(analytic
::begin shader
float f(float x);
float g(float x) { return f(x); }
float f(float x) { return x > 1.0 ? g(x - 1.0) : x; }
vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return vec3(f(Xo.x)); }
::end shader
)");
    EXPECT_EQ(error.kind, ErrorKind::input);
    EXPECT_THAT(error.message, HasSubstr("recurs"));
}

TEST_F(GlErrors, InternalNamesAreRefused) {
    const Error error = errorOf(R"(analytic
::begin shader
vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {
    sl_values[0] = 1.0;
    return Xi;
}
::end shader
)");
    EXPECT_EQ(error.line, 4);
    EXPECT_EQ(error.column, 5);
    EXPECT_THAT(error.hint, HasSubstr("sl_"));
}

TEST_F(GlErrors, ContextIsGoodAfterAModelThatDoesNotCompile) {
    errorOf("analytic\n::begin shader\nvec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return 1; }\n::end shader\n");
    EXPECT_EQ(evaluateText("analytic\n::begin shader\nvec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return Xo; }\n"
                           "::end shader\n",
                           context_),
              (Rgb{1, 0, 0}));
}

}  // namespace
}  // namespace searchlight
