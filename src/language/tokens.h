// GLSL as a list of tokens: what the parser, the translator to C++ and the loop budget work on.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace searchlight {

enum class TokenKind { identifier, int_literal, float_literal, punctuation, preprocessor, end };

struct Token {
    TokenKind kind = TokenKind::end;
    std::string_view
        text;        ///< into the source; "+=", "&&" and the like are one token; a preprocessor line is one token
    int line = 0;    ///< 1-based, in the file
    int column = 0;  ///< 1-based
    std::size_t offset = 0;  ///< of text in the source
};

/// The tokens of `source`, whose first character stands at `first_line` of its file; comments and white space are
/// dropped; the last token has kind end. Throws an input Error (line, column; no file) for a character outside GLSL, a
/// comment that never ends, or a malformed number.
std::vector<Token> tokenize(std::string_view source, int first_line = 1);

}  // namespace searchlight
