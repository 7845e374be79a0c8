#include "language/initializer.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"

namespace searchlight {

namespace {

BssrdfFile model(const std::string& initializer, const std::string& shader_start = "") {
    return parseBssrdf("analytic\n::begin initializer\n" + initializer + "::end initializer\n::begin shader\n" +
                           shader_start + "vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return vec3(0.0); }\n" +
                           "::end shader\n",
                       "model.bssrdf");
}

std::ptrdiff_t lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

}  // namespace

TEST(Initializer, IsEmptyWithoutSection) {
    const Initializer none = splitInitializer(parseBssrdf(
        "analytic\n::begin shader\nvec3 Bssrdf(vec3 a, vec3 b, vec3 c, vec3 d) { return a; }\n::end shader\n", "m"));
    EXPECT_TRUE(none.state.empty());
    EXPECT_TRUE(none.init_text.empty());
    EXPECT_EQ(none.first_line, 0);
}

TEST(Initializer, TakesStateOutAndKeepsLines) {
    const std::string text =
        "const int N = 2; float A /* here */ = 1.0 +\n 2.0, B[N * (N + 1)];\n"
        "float twice(float x) { return 2.0 * x; }\n"
        "void init() {\n  A = twice(A);\n}\n"
        "float[3] C; // last\n";
    const Initializer split = splitInitializer(model(text));
    EXPECT_EQ(split.first_line, 3);
    ASSERT_EQ(split.state.size(), 3u);
    EXPECT_EQ(split.state[0].initial_value, "1.0 +\n 2.0");
    EXPECT_EQ(split.state[0].array_size, 0);
    EXPECT_EQ(split.state[1].name, "B");
    EXPECT_EQ(split.state[1].array_size, 6);
    EXPECT_EQ(split.state[1].line, 4);
    EXPECT_EQ(split.state[1].column, 7);
    EXPECT_EQ(split.state[2].array_size, 3);
    EXPECT_EQ(lines(split.functions_text), lines(text));
    EXPECT_EQ(lines(split.init_text), lines(text));
    EXPECT_EQ(split.functions_text,
              "const int N = 2;                           \n                     \n"
              "float twice(float x) { return 2.0 * x; }\n"
              "             \n               \n \n"
              "            // last\n");
    EXPECT_EQ(split.init_text.substr(split.init_text.find("void")).substr(0, 33),
              "void init() {\n  A = twice(A);\n}\n ");
    EXPECT_EQ(split.init_text.find("twice"), split.init_text.rfind("twice"));
}

TEST(Initializer, LocalsAndParametersMayHideState) {
    EXPECT_NO_THROW(splitInitializer(model("float A;\nvec3 B;\nvoid init() { A = 1.0; }\n",
                                           "float f(float A) { A = 2.0; return A; }\n"
                                           "float g() { float x, A = 1.0, B[3]; A += x; B[0] = 1.0; return A; }\n"
                                           "float h() { for (int A = 0; A < 3; ++A) { } return 1.0; }\n"
                                           "bool k() { return A == 1.0 || A <= 2.0 || B.x != 3.0; }\n")));
}

TEST(Initializer, StateIsHiddenOnlyWithinTheBlock) {
    EXPECT_THROW(
        splitInitializer(model("float A;\nvoid init() {}\n", "float f() { { float A = 1.0; } A = 2.0; return A; }\n")),
        Error);
}

TEST(Initializer, AnArgumentIsNoDeclaration) {
    // "f(x, A)" and "x, A = 1" outside a declaration declare nothing.
    EXPECT_THROW(splitInitializer(model("float A;\nvoid init() {}\n",
                                        "float f(float x) { float y = f(x, A); x = 1.0, A = 2.0; return A; }\n")),
                 Error);
}

TEST(Initializer, ArraySizesAreChecked) {
    for (const char* size : {"0", "-1", "4097", "99999999999999999999", "1 / 0", "2.0", "N", "", "1 +", "(1"}) {
        const auto split = [&] { splitInitializer(model(std::string("float A[") + size + "];\nvoid init() {}\n")); };
        EXPECT_THROW(split(), Error) << size;
    }
}

}  // namespace searchlight
