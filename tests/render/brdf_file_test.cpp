#include "render/brdf_file.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace searchlight {
namespace {

std::string message(const std::string& text) {
    try {
        parseBrdf(text, "a.brdf");
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

const std::string shader =
    "::begin shader\nvec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y) { return vec3(1.0); }\n::end shader\n";

TEST(BrdfFile, ReadsParametersAndShader) {
    const BrdfFile file = parseBrdf(
        "# Copyright\n\nanalytic\n\n:: begin parameters\nfloat roughness 0 1 0.25\nbool on 1\ncolor tint 1 .5 0\n::end "
        "parameters\n" +
            shader,
        "a.brdf");
    ASSERT_EQ(file.parameters.size(), 3u);
    EXPECT_EQ(std::get<double>(file.parameters[0].value), 0.25);
    EXPECT_EQ(std::get<bool>(file.parameters[1].value), true);
    EXPECT_EQ(std::get<Rgb>(file.parameters[2].value), (Rgb{1, 0.5, 0}));
    EXPECT_EQ(file.shader_first_line, 11);
    EXPECT_TRUE(file.shader.starts_with("vec3 BRDF"));
}

TEST(BrdfFile, ParametersAreSetByNameOrHaveTheirDefaults) {
    const BrdfFile file = parseBrdf(
        "analytic\n::begin parameters\nfloat roughness 0 1 0.25\nbool on 1\ncolor tint 1 .5 0\n::end parameters\n" +
            shader,
        "a.brdf");
    const std::vector<ParamValue> values =
        brdfValues(file, {{"on", false}, {"tint", std::vector<double>{0.1, 0.2, 0.3}}});
    EXPECT_EQ(values, (std::vector<ParamValue>{0.25, false, Rgb{0.1, 0.2, 0.3}}));
    const auto refusal = [&](const ParamValues& given) -> std::string {
        try {
            brdfValues(file, given);
        } catch (const Error& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_EQ(refusal({{"roughnes", 0.1}}), "unknown parameter of a.brdf 'roughnes' (valid: roughness, on, tint)");
    EXPECT_NE(refusal({{"roughness", 2.0}}), "no error");
}

TEST(BrdfFile, SaysWhatIsWrongAndWhere) {
    EXPECT_EQ(message(""), "a.brdf:1:1: the file holds no BRDF (expected a first line 'analytic')");
    EXPECT_EQ(message("merl\n"),
              "a.brdf:1:1: 'merl' found where 'analytic' was expected (measured BRDFs are not read)");
    EXPECT_EQ(message("analytic\n"), "a.brdf:1:1: the file has no section shader (expected ::begin shader)");
    EXPECT_EQ(
        message("analytic\nfloat x\n"),
        "a.brdf:2:1: 'float x' stands outside a section (expected ::begin NAME, or a comment that starts with #)");
    EXPECT_EQ(message("analytic\n::start shader\n"),
              "a.brdf:2:1: '::start shader' found where ::begin NAME or ::end NAME was expected");
    EXPECT_EQ(message("analytic\n::end shader\n"), "a.brdf:2:3: ::end shader without a ::begin shader");
    EXPECT_EQ(message("analytic\n::begin shader\nvoid f() {}\n"),
              "a.brdf:2:1: section shader never ends (expected ::end shader)");
    EXPECT_EQ(message("analytic\n::begin shader\n::end parameters\n"),
              "a.brdf:3:1: '::end parameters' found where ::end shader was expected");
    EXPECT_EQ(message("analytic\n" + shader + shader), "a.brdf:5:9: section shader is already on line 2");
    EXPECT_EQ(
        message("analytic\n::begin shader\nvoid f() {}\n::end shader\n"),
        "a.brdf:2:9: section shader has no function BRDF (expected vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 "
        "Y))");
    EXPECT_EQ(message("analytic\n::begin shader\n float BRDF(vec3 L) { return 1.0; }\n::end shader\n"),
              "a.brdf:3:8: BRDF has another signature (expected vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y))");
    EXPECT_EQ(message("analytic\n::begin parameters\nint n 1\n::end parameters\n" + shader),
              "a.brdf:3:1: unknown parameter type 'int' (valid: float, bool, color, choice)");
}

}  // namespace
}  // namespace searchlight
