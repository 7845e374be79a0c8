#include "model/gl_source.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace searchlight {
namespace {

using testing::HasSubstr;
using testing::Not;

// Without the line breaks between tokens.
std::string flat(const gl::Source& source) {
    std::string text = source.text();
    std::ranges::replace(text, '\n', ' ');
    return text;
}

std::string shaderOf(std::string_view body) {
    const BssrdfFile file =
        parseBssrdf("analytic\n::begin shader\nvec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {\n" +
                        std::string(body) + "\nreturn Xi;\n}\n::end shader\n",
                    "m.bssrdf");
    return flat(modelShader(file, GlStage::evaluate, {}));
}

TEST(GlSource, WrapsLoopConditions) {
    EXPECT_THAT(shaderOf("for (int i = 0; i < 3; ++i) {}"),
                HasSubstr("for ( int i = 0 ; ( i < 3 ) && sl_loop(4) ; ++ i ) { }"));
    EXPECT_THAT(shaderOf("for (;;) {}"), HasSubstr("for ( ; sl_loop(4) ; ) { }"));
    EXPECT_THAT(shaderOf("while (a(b)) {}"), HasSubstr("while ( ( a ( b ) ) && sl_loop(4) ) { }"));
    EXPECT_THAT(shaderOf("do {} while (a, b);"), HasSubstr("while ( ( a , b ) && sl_loop(4) ) ;"));
    EXPECT_THAT(shaderOf("while (bool b = c) {}"), HasSubstr("while ( bool b = ( c ) && sl_loop(4) ) { }"));
    EXPECT_THAT(shaderOf("for (int i = f(1, (2)); x; ) {}"),
                HasSubstr("for ( int i = f ( 1 , ( 2 ) ) ; ( x ) && sl_loop(4) ; ) { }"));
    EXPECT_THAT(shaderOf("for (;;)\nfor (;a;) {}"),
                HasSubstr("for ( ; sl_loop(4) ; ) for ( ; ( a ) && sl_loop(5) ; )"));
}

TEST(GlSource, TakesOnlyThePhysicsThatIsUsed) {
    EXPECT_THAT(shaderOf(""), Not(HasSubstr("henyeyGreenstein")));
    EXPECT_THAT(shaderOf("henyeyGreenstein(1.0, 0.0);"), HasSubstr("float henyeyGreenstein ( float mu , float g ) {"));
    EXPECT_THAT(shaderOf("henyeyGreenstein(1.0, 0.0);"), HasSubstr("inv_4pi"));
    EXPECT_THAT(shaderOf("henyeyGreenstein(1.0, 0.0);"), Not(HasSubstr("fresnelReflectance")));
}

TEST(GlSource, EachTokenKeepsItsPlace) {
    const BssrdfFile file = parseBssrdf(
        "analytic\n::begin shader\nvec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {\n  /* */ return  Xi * 7.25;\n}\n"
        "::end shader\n",
        "m.bssrdf");
    const gl::Source source = modelShader(file, GlStage::evaluate, {});
    const std::size_t at = source.text().find("\n7.25\n");
    ASSERT_NE(at, std::string::npos);
    const auto line = static_cast<int>(std::count(source.text().begin(), source.text().begin() + at + 1, '\n')) + 1;
    const gl::SourcePlace place = source.place(line, 1);
    EXPECT_EQ(place.file, "m.bssrdf");
    EXPECT_EQ(place.line, 4);
    EXPECT_EQ(place.column, 22);
}

}  // namespace
}  // namespace searchlight
