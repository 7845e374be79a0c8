#include "language/tokens.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"

namespace searchlight {

namespace {

std::vector<std::string> texts(std::string_view source) {
    std::vector<std::string> found;
    for (const Token& token : tokenize(source)) found.emplace_back(token.text);
    return found;
}

}  // namespace

TEST(Tokens, EndWithAnEndToken) {
    const std::vector<Token> tokens = tokenize("");
    ASSERT_EQ(tokens.size(), 1u);
    EXPECT_EQ(tokens[0].kind, TokenKind::end);
}

TEST(Tokens, TheLongestOperatorWins) {
    EXPECT_THAT(texts("a<<=b>>c+++d"), testing::ElementsAre("a", "<<=", "b", ">>", "c", "++", "+", "d", ""));
}

TEST(Tokens, NumbersKnowWhetherTheyAreWhole) {
    for (const char* whole : {"0", "12", "0x1F", "7u", "010"}) {
        const std::vector<Token> tokens = tokenize(whole);
        EXPECT_EQ(tokens[0].kind, TokenKind::int_literal) << whole;
        EXPECT_EQ(tokens[0].text, whole);
    }
    for (const char* real : {"1.", ".5", "1.5", "1e5", "1.5E-3", "2.0f", "1.0lf"}) {
        const std::vector<Token> tokens = tokenize(real);
        EXPECT_EQ(tokens[0].kind, TokenKind::float_literal) << real;
        EXPECT_EQ(tokens[0].text, real);
    }
}

TEST(Tokens, FieldsAreNoNumbers) { EXPECT_THAT(texts("v.x+w[0].y"), testing::Contains(".").Times(2)); }

TEST(Tokens, CommentsAreDropped) {
    EXPECT_THAT(texts("a // b \"#@\n/* c\n * d */ e/**/f"), testing::ElementsAre("a", "e", "f", ""));
}

TEST(Tokens, PlacesAreOneBasedAndFollowEveryLineEnd) {
    const std::vector<Token> tokens = tokenize("a\r\n  b\rc /* \n */ d\n", 10);
    ASSERT_EQ(tokens.size(), 5u);
    const std::vector<std::pair<int, int>> expected = {{10, 1}, {11, 3}, {12, 1}, {13, 5}, {14, 1}};
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        EXPECT_EQ(tokens[i].line, expected[i].first) << i;
        EXPECT_EQ(tokens[i].column, expected[i].second) << i;
    }
    EXPECT_EQ(tokens[3].offset, 17u);
}

TEST(Tokens, APreprocessorLineIsOneToken) {
    const std::vector<Token> tokens = tokenize("a\n  #define N 3 // three\nb");
    ASSERT_EQ(tokens.size(), 4u);
    EXPECT_EQ(tokens[1].kind, TokenKind::preprocessor);
    EXPECT_EQ(tokens[1].text, "#define N 3 // three");
    EXPECT_EQ(tokenize("/* hidden */ #define N")[0].kind, TokenKind::preprocessor);
}

TEST(Tokens, ErrorsHaveAPlace) {
    try {
        tokenize("a\n  $", 5);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.line, 6);
        EXPECT_EQ(error.column, 3);
    }
}

}  // namespace searchlight
