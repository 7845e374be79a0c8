// The top level of a GLSL text: its functions and globals as ranges of tokens. Function bodies stay tokens.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "language/tokens.h"

namespace searchlight {

/// One declared name: "w[3] = float[3](1.0, 2.0, 3.0)", or a function's parameter.
struct Declarator {
    Token name;                    ///< kind end for an unnamed parameter
    std::span<const Token> array;  ///< the tokens between [ and ], of the type or the name
    bool is_array = false;
    std::span<const Token> value;  ///< the tokens after '='
};

struct Function {
    Token type;                         ///< of the return value
    std::span<const Token> type_array;  ///< tokens between [ and ] of the return type
    bool returns_array = false;
    Token name;
    struct Parameter {
        std::vector<Token> qualifiers;  ///< const, in, out, inout
        Token type;
        Declarator declarator;
    };
    std::vector<Parameter> parameters;
    std::span<const Token> body;  ///< with its braces; empty for a prototype
    Token last;                   ///< the closing brace, or the semicolon of a prototype
};

struct Global {
    std::vector<Token> qualifiers;  ///< const, uniform, layout ... (a layout's parentheses are dropped)
    Token type;
    std::vector<Declarator> declarators;
    Token last;  ///< the semicolon

    bool isConst() const;
};

/// In the order of the text: exactly one of the members is set per item; structs, precision statements and interface
/// blocks are `other`.
struct OutlineItem {
    enum class Kind { function, global, other } kind;
    std::size_t index;              ///< into functions or globals
    std::span<const Token> tokens;  ///< all of them, last one included
};

struct Outline {
    std::vector<OutlineItem> items;
    std::vector<Function> functions;
    std::vector<Global> globals;

    /// The function of that name with a body; nullptr when there is none.
    const Function* find(std::string_view name) const;
};

/// `tokens` is what tokenize returned and outlives the outline. Throws an input Error (line, column; no file) for
/// unbalanced brackets, a preprocessor line, or text that is no declaration.
Outline outline(std::span<const Token> tokens);

/// The index of the bracket that closes the one at tokens[open].
std::size_t closingBracket(std::span<const Token> tokens, std::size_t open);

}  // namespace searchlight
