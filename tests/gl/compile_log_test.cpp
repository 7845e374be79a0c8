#include "gl/compile_log.h"

#include <gtest/gtest.h>

namespace searchlight::gl {
namespace {

TEST(CompileLog, MesaErrorHasLineAndColumn) {
    const auto errors =
        compileErrors("0:12(5): error: `foo' undeclared\n0:13(1): error: syntax error, unexpected '}'\n");
    ASSERT_EQ(errors.size(), 2u);
    EXPECT_EQ(errors[0].line, 12);
    EXPECT_EQ(errors[0].column, 5);
    EXPECT_EQ(errors[0].text, "`foo' undeclared");
    EXPECT_EQ(errors[1].line, 13);
    EXPECT_EQ(errors[1].text, "syntax error, unexpected '}'");
}

TEST(CompileLog, NvidiaErrorHasLineButNoColumn) {
    const auto errors = compileErrors("0(7) : error C1503: undefined variable \"foo\"\n");
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].line, 7);
    EXPECT_EQ(errors[0].column, 0);
    EXPECT_EQ(errors[0].text, "undefined variable \"foo\"");
}

TEST(CompileLog, AmdErrorHasLineButNoColumn) {
    const auto errors = compileErrors("ERROR: 0:31: 'foo' : undeclared identifier \n");
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].line, 31);
    EXPECT_EQ(errors[0].text, "'foo' : undeclared identifier");
}

TEST(CompileLog, LinkErrorHasNoPlace) {
    const auto errors = compileErrors("error: function `f' is recursive\n");
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].line, 0);
    EXPECT_EQ(errors[0].text, "function `f' is recursive");
}

TEST(CompileLog, WarningsAndNoiseAreLeftOut) {
    EXPECT_TRUE(compileErrors("0:3(2): warning: `x' used uninitialized\n0(4) : warning C7050: \"y\" might be used\n\n")
                    .empty());
    EXPECT_TRUE(compileErrors("").empty());
}

}  // namespace
}  // namespace searchlight::gl
