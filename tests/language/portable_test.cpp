#include "language/portable.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "base/files.h"
#include "base/text.h"
#include "language/glsl_names.h"
#include "language/tokens.h"

namespace searchlight {

namespace {

BssrdfFile model(const std::string& code, const std::string& initializer = "") {
    std::string text = "analytic\n::begin shader\n" + code +
                       "\nvec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return vec3(0.0); }\n::end shader\n";
    if (!initializer.empty()) text += "::begin initializer\n" + initializer + "\n::end initializer\n";
    return parseBssrdf(text, "m.bssrdf");
}

std::string why(const std::string& code, const std::string& initializer = "") {
    const std::vector<GlslSource> physics = {{"p.glsl", "float helper(float x) { return x; }"}};
    const std::optional<Error> error = portabilityError(model(code, initializer), translateLibrary(physics));
    return error ? error->what() : "";
}

}  // namespace

TEST(Portable, PlainModelsAre) {
    EXPECT_EQ(why("float f(vec2 x) { return helper(x.y) + max(x.x, 1.0); }"), "");
    EXPECT_EQ(why("", "float A = 1.0; void init() {}"), "");
}

TEST(Portable, SaysWhatIsNot) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"double a() { return 1.0; }",
         "m.bssrdf:3:1: not in the portable subset: type 'double' (valid: float, int, uint, bool, vec2 to vec4, bvec2 "
         "to bvec4, mat3, and arrays of them)"},
        {"float a() { return 1.0lf; }", "m.bssrdf:3:20: not in the portable subset: a double literal"},
        {"float a() { discard; }", "m.bssrdf:3:13: not in the portable subset: 'discard'"},
        {"float a() { ivec2 b; return 1.0; }", "m.bssrdf:3:13: not in the portable subset: 'ivec2'"},
        {"void a(vec3 v) { v.xy = vec2(1.0); }",
         "m.bssrdf:3:20: not in the portable subset: writing to the swizzle '.xy' (write one component at a time, or "
         "the whole vector)"},
        {"void a(vec3 v) { v.zx *= 2.0; }",
         "m.bssrdf:3:20: not in the portable subset: writing to the swizzle '.zx' (write one component at a time, or "
         "the whole vector)"},
        {"float a(float x) { return dFdx(x); }",
         "m.bssrdf:3:27: not in the portable subset: function 'dFdx' (it is neither the model's own, nor in physics/, "
         "nor a function of the subset)"},
        {"bool a(bool x) { return x ^^ true; }",
         "m.bssrdf:3:27: not in the portable subset: operator ^^ (write a != b)"},
        {"struct S { float x; };", "m.bssrdf:3:1: not in the portable subset: 'struct'"},
        {"float a(vec3 v) { return v.xg; }",
         "m.bssrdf:3:28: not in the portable subset: field '.xg' (structs are not in it)"},
        {"float cache;", "m.bssrdf:3:7: not in the portable subset: global 'cache' outside section initializer"},
        {"uniform sampler2D t;", "m.bssrdf:3:19: not in the portable subset: global 't' outside section initializer"},
        {"float a(highp float x) { return x; }", "m.bssrdf:3:9: not in the portable subset: qualifier 'highp'"},
        {"float x() { float Xi = 1.0; { float Xi = Xi * 2.0; } return Xi; }",
         "m.bssrdf:3:42: not in the portable subset: 'Xi' in its own initial value (GLSL means the outer variable, C++ "
         "the new one: use another name)"},
        {"void a() { vec3 v = {1.0, 2.0, 3.0}; }",
         "m.bssrdf:3:21: not in the portable subset: a list in { } (write TYPE[](a, b) or a constructor)"},
        {"void a() { for (float x[2]; true; ) {} }",
         "m.bssrdf:3:23: not in the portable subset: an array declared inside ( )"},
        {"void a() { for (int i = 0, j[2] = int[](1, 2); i < 2; i++) {} }",
         "m.bssrdf:3:28: not in the portable subset: an array declared inside ( )"},
        {"float a() { float x[]; return x[0]; }", "m.bssrdf:3:13: not in the portable subset: an array without a size"},
        {"float a() { float b = float c = 1.0; return b; }",
         "m.bssrdf:3:23: not in the portable subset: a declaration inside an expression"},
    };
    for (const auto& [code, message] : cases) EXPECT_EQ(why(code), message) << code;
}

TEST(Portable, ErrorsInTheInitializerNameItsLines) {
    EXPECT_EQ(why("", "mat4 M;\nvoid init() {}"),
              "m.bssrdf:7:1: not in the portable subset: type 'mat4' (valid: float, int, uint, bool, vec2 to vec4, "
              "bvec2 to bvec4, mat3, and arrays of them)");
}

TEST(Portable, EveryBuiltinIsKnown) {
    for (const std::string& name : portableBuiltins())
        EXPECT_EQ(why("void f() { float x = float(" + name + "(1.0)); }"), "") << name;
}

TEST(Portable, ALibraryKnowsItsFunctionsAndConstants) {
    const std::vector<GlslSource> sources = {{"a.glsl", "float f(float x);\nfloat f(float x) { return x; }\n"},
                                             {"b.glsl", "const float k = 2.0;\nvec3 f(vec3 x) { return k * x; }\n"}};
    const PortableLibrary library = translateLibrary(sources);
    EXPECT_EQ(library.functions, std::vector<std::string>{"f"});
    EXPECT_EQ(library.constants, std::vector<std::string>{"k"});
}

TEST(Portable, ALibraryHoldsNoVariables) {
    const std::vector<GlslSource> sources = {{"a.glsl", "\nfloat k = 2.0;\n"}};
    try {
        translateLibrary(sources);
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(),
                     "a.glsl:2:7: not in the portable subset: a global of physics/ that is no constant expression");
    }
}

TEST(Portable, CompilerMessagesAreSentToTheModel) {
    const std::string cpp = translateModel(model("float f() { return 1.0; }"), {}, "Twin");
    EXPECT_NE(cpp.find("#line 3 \"m.bssrdf\"\n    Real f() const { return Real(1.0); }"), std::string::npos) << cpp;
}

// docs/bssrdf-format.md is held to what the code does.
class FormatPage : public testing::Test {
protected:
    static std::string page() { return readFile(root() / "docs/bssrdf-format.md"); }
    static std::filesystem::path root() { return SEARCHLIGHT_SOURCE_DIR; }

    static PortableLibrary physics() {
        std::vector<GlslSource> sources;
        for (const auto& entry : std::filesystem::directory_iterator(root() / "physics"))
            sources.push_back({entry.path(), readFile(entry.path())});
        return translateLibrary(sources);
    }
};

TEST_F(FormatPage, ItsExampleIsAPortableModel) {
    const std::string text = page();
    const std::size_t begin = text.find("```\nanalytic") + 4;
    const BssrdfFile file = parseBssrdf(text.substr(begin, text.find("```", begin) - begin), "example.bssrdf");
    EXPECT_EQ(file.parameters.size(), 4u);
    const std::optional<Error> error = portabilityError(file, physics());
    EXPECT_FALSE(error) << error->what();
}

TEST_F(FormatPage, ItNamesEveryFunction) {
    const std::string text = page();
    for (const std::string& name : physics().functions)
        EXPECT_NE(text.find("`" + name + "`"), std::string::npos) << name;
    std::string subset = text.substr(text.find("- the functions abs"));
    subset.resize(subset.find("and those of"));
    std::set<std::string_view> listed;
    for (const Token& token : tokenize(subset)) listed.insert(token.text);
    for (const std::string& name : portableBuiltins()) EXPECT_TRUE(listed.contains(name)) << name;
}

TEST_F(FormatPage, ItNamesEveryAttribute) {
    try {
        parseBssrdf("analytic unknown\n", "m");
        FAIL();
    } catch (const Error& error) {
        const std::string_view hint = error.hint;
        for (const std::string_view name : split(hint.substr(hint.find(':') + 1), ','))
            EXPECT_NE(page().find("| `" + std::string(trim(name)) + "`"), std::string::npos) << name;
    }
}

}  // namespace searchlight
