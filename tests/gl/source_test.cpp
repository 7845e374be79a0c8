#include "gl/source.h"

#include <gtest/gtest.h>

namespace searchlight::gl {
namespace {

TEST(Source, LinesKeepTheirFileAndNumber) {
    Source source;
    source.add("a\nb\n", "one.glsl", 10);
    source.add("c", "two.glsl");
    EXPECT_EQ(source.text(), "a\nb\nc\n");
    EXPECT_EQ(source.place(2, 1).file, "one.glsl");
    EXPECT_EQ(source.place(2, 1).line, 11);
    EXPECT_EQ(source.place(3, 1).file, "two.glsl");
    EXPECT_EQ(source.place(3, 1).line, 1);
}

TEST(Source, LineOutsideTheTextHasNoPlace) {
    Source source;
    source.add("a", "one.glsl");
    EXPECT_EQ(source.place(0, 0).line, 0);
    EXPECT_EQ(source.place(2, 1).line, 0);
    EXPECT_EQ(source.place(2, 1).file, "");
}

TEST(Source, TokenKeepsItsColumnWhateverTheDriverSays) {
    Source source;
    source.addToken("foo", "m.bssrdf", 12, 34);
    EXPECT_EQ(source.place(1, 0).column, 34);
    EXPECT_EQ(source.place(1, 7).column, 34);
    EXPECT_EQ(source.place(1, 1).line, 12);
}

TEST(Source, ColumnsCountTheWhiteSpaceThatMesaSqueezes) {
    Source source;
    source.add("  a  =  /* why */ b;", "m.glsl");
    // Mesa sees " a = b;".
    EXPECT_EQ(source.place(1, 2).column, 3);
    EXPECT_EQ(source.place(1, 4).column, 6);
    EXPECT_EQ(source.place(1, 6).column, 19);
}

}  // namespace
}  // namespace searchlight::gl
