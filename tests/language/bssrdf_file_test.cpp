#include "language/bssrdf_file.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace searchlight {

namespace {

const std::string shader =
    "::begin shader\nvec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return vec3(0.0); }\n::end shader\n";

BssrdfFile parse(const std::string& text) { return parseBssrdf(text, "folder/my_model.bssrdf"); }

}  // namespace

TEST(BssrdfFile, NeedsOnlyAttributesAndShader) {
    const BssrdfFile file = parse("analytic\n" + shader);
    EXPECT_EQ(file.title, "my_model");
    EXPECT_FALSE(file.radial || file.no_wi || file.no_wo || file.normals || file.single_scattering || file.reciprocal ||
                 file.energy_violation || file.grosjean);
    EXPECT_FALSE(file.initializer.present() || file.diffuse_reflectance.present());
    EXPECT_EQ(file.shader.first_line, 3);
    EXPECT_EQ(file.shader.text, "vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return vec3(0.0); }\n");
}

TEST(BssrdfFile, KnowsEveryAttribute) {
    const BssrdfFile file = parse(
        "\n# a comment\n  analytic radial no_wi no_wo normals single_scattering reciprocal energy_violation grosjean # "
        "end\n" +
        shader);
    EXPECT_TRUE(file.radial && file.no_wi && file.no_wo && file.normals && file.single_scattering && file.reciprocal &&
                file.energy_violation && file.grosjean);
    EXPECT_EQ(file.attributes.size(), 9u);
}

TEST(BssrdfFile, ByteOrderMarkCrlfAndMissingNewlineAreAccepted) {
    std::string text =
        "\xef\xbb\xbf"
        "analytic radial\r\n::begin shader\r\n"
        "vec3 Bssrdf(vec3 a, vec3 b, vec3 c, vec3 d)\r\n{ return a; }\r\n::end shader";
    const BssrdfFile file = parse(text);
    EXPECT_TRUE(file.radial);
    EXPECT_EQ(file.shader.text, "vec3 Bssrdf(vec3 a, vec3 b, vec3 c, vec3 d)\n{ return a; }\n");
}

TEST(BssrdfFile, UnknownSectionsAreIgnored) {
    const BssrdfFile file = parse("analytic\n::begin history\n#define anything { goes 0x\n::end history\n" + shader);
    EXPECT_TRUE(file.shader.present());
}

TEST(BssrdfFile, InfoLinesOfOneKindAreJoined) {
    const BssrdfFile file = parse(
        "analytic\n::begin info\ntitle  My model\n\n# not this\ncitation Somebody, 2020, \xc2\xa7 3\n"
        "validity r > 1 mm\nnote First line\n  note and second.\n::end info\n" +
        shader);
    EXPECT_EQ(file.title, "My model");
    EXPECT_EQ(file.citation, "Somebody, 2020, \xc2\xa7 3");
    EXPECT_EQ(file.validity, "r > 1 mm");
    EXPECT_EQ(file.notes, "First line and second.");
}

TEST(BssrdfFile, ParametersCarryRangeUnitAndDoc) {
    const BssrdfFile file = parse(
        "analytic\n::begin parameters\n"
        "# a comment\n"
        "float Width 0.1 1e2 +2.5 [1/mm]  # how wide # really\n"
        "bool\tClamp\ttrue\n"
        "color Tint 0.2 0.4 60 # reflectance\n"
        "choice Fit skin|marble|wax marble [kind]\n"
        "choice First a|b\n"
        "::end parameters\n" +
        shader);
    ASSERT_EQ(file.parameters.size(), 5u);
    const Param& width = file.parameters[0];
    EXPECT_EQ(width.name, "Width");
    EXPECT_EQ(width.type, ParamType::number);
    EXPECT_EQ(width.min, 0.1);
    EXPECT_EQ(width.max, 100);
    EXPECT_EQ(std::get<double>(width.value), 2.5);
    EXPECT_EQ(width.unit, "1/mm");
    EXPECT_EQ(width.doc, "how wide # really");
    EXPECT_EQ(file.parameters[1].type, ParamType::toggle);
    EXPECT_EQ(std::get<bool>(file.parameters[1].value), true);
    EXPECT_EQ(file.parameters[2].type, ParamType::color);
    EXPECT_EQ(std::get<Rgb>(file.parameters[2].value), (Rgb{0.2, 0.4, 60}));
    EXPECT_EQ(file.parameters[3].choices, (std::vector<std::string>{"skin", "marble", "wax"}));
    EXPECT_EQ(std::get<std::string>(file.parameters[3].value), "marble");
    EXPECT_EQ(file.parameters[3].unit, "kind");
    EXPECT_EQ(std::get<std::string>(file.parameters[4].value), "a");
}

TEST(BssrdfFile, DefaultsPassTheirOwnCheck) {
    const BssrdfFile file = parse(
        "analytic\n::begin parameters\nfloat A -1 0 -1\nbool B 0\ncolor C 0 3 0\nchoice D x|y\n::end parameters\n" +
        shader);
    for (const Param& param : file.parameters) EXPECT_NO_THROW(checkValue(param, param.value)) << param.name;
}

TEST(BssrdfFile, EntryPointsMayQualifyAndLeaveOutTheirArguments) {
    EXPECT_NO_THROW(parse(
        "analytic\n::begin shader\nvec3 Bssrdf(const in vec3 Xi, in vec3, const vec3 Xo, vec3 Wo) { return Xi; }\n"
        "::end shader\n"));
}

TEST(BssrdfFile, APrototypeIsNoBssrdf) {
    EXPECT_THROW(parse("analytic\n::begin shader\nvec3 Bssrdf(vec3 a, vec3 b, vec3 c, vec3 d);\n::end shader\n"),
                 Error);
}

}  // namespace searchlight
