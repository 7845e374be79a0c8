#include "language/outline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/error.h"

namespace searchlight {

namespace {

constexpr std::size_t max_nesting = 256;

constexpr std::array<std::string_view, 24> qualifiers = {
    "const",    "in",       "out",      "inout",     "uniform", "buffer",    "shared",    "layout",
    "highp",    "mediump",  "lowp",     "flat",      "smooth",  "precise",   "invariant", "coherent",
    "volatile", "restrict", "readonly", "writeonly", "varying", "attribute", "centroid",  "noperspective"};

constexpr std::array<std::string_view, 12> statement_words = {
    "return", "if", "else", "for", "while", "do", "switch", "case", "default", "break", "continue", "discard"};

bool isOperand(const Token& token) {
    return token.kind == TokenKind::identifier || token.kind == TokenKind::int_literal ||
           token.kind == TokenKind::float_literal;
}

bool isOperandEnd(const Token& token) { return isOperand(token) || token.text == ")" || token.text == "]"; }

Error errorAt(const Token& token, std::string message, std::string hint = {}) {
    return inputError(std::move(message), std::move(hint)).at({}, token.line, token.column);
}

char partner(char open) { return open == '(' ? ')' : open == '[' ? ']' : '}'; }

bool isBracket(const Token& token, std::string_view kinds) {
    return token.kind == TokenKind::punctuation && token.text.size() == 1 &&
           kinds.find(token.text[0]) != std::string_view::npos;
}

void checkBrackets(std::span<const Token> tokens) {
    std::vector<const Token*> open;
    for (const Token& token : tokens) {
        if (isBracket(token, "([{")) {
            open.push_back(&token);
            // Keeps work on brackets inside brackets linear in the text.
            if (open.size() > max_nesting)
                throw errorAt(token, fmt::format("brackets are nested more than {} deep", max_nesting));
        } else if (isBracket(token, ")]}")) {
            if (open.empty()) throw errorAt(token, fmt::format("'{}' closes nothing", token.text));
            const Token& opened = *open.back();
            if (partner(opened.text[0]) != token.text[0])
                throw errorAt(token,
                              fmt::format("'{}' closes the '{}' of line {}", token.text, opened.text, opened.line),
                              fmt::format("expected '{}'", partner(opened.text[0])));
            open.pop_back();
        } else if (token.kind == TokenKind::preprocessor) {
            throw errorAt(token, fmt::format("preprocessor line '{}'", token.text.substr(0, 40)),
                          "models are plain GLSL; comments start with //");
        }
    }
    if (!open.empty()) throw errorAt(*open.back(), fmt::format("'{}' is never closed", open.back()->text));
}

class OutlineParser {
public:
    explicit OutlineParser(std::span<const Token> tokens) : tokens_(tokens) {}

    Outline run() {
        while (peek().kind != TokenKind::end) {
            if (is(";"))
                ++at_;
            else
                declaration();
        }
        return std::move(outline_);
    }

private:
    const Token& peek(std::size_t ahead = 0) const { return tokens_[std::min(at_ + ahead, tokens_.size() - 1)]; }
    bool is(std::string_view text) const { return peek().text == text && peek().kind == TokenKind::punctuation; }
    const Token& next() { return tokens_[at_++]; }

    const Token& expect(std::string_view text, std::string_view where) {
        if (!is(text)) throw unexpected(fmt::format("'{}' {}", text, where));
        return next();
    }

    const Token& expectName(std::string_view what) {
        if (peek().kind != TokenKind::identifier) throw unexpected(std::string(what));
        return next();
    }

    Error unexpected(const std::string& expected) const {
        const std::string found =
            peek().kind == TokenKind::end ? "the section ends" : fmt::format("'{}' found", peek().text);
        return errorAt(peek(), fmt::format("{} where {} was expected", found, expected));
    }

    // [ tokens ], if there.
    bool arraySize(std::span<const Token>& size) {
        if (!is("[")) return false;
        const std::size_t close = closingBracket(tokens_, at_);
        size = tokens_.subspan(at_ + 1, close - at_ - 1);
        at_ = close + 1;
        if (is("[")) throw errorAt(peek(), "arrays of arrays are not supported");
        return true;
    }

    std::vector<Token> readQualifiers() {
        std::vector<Token> read;
        while (peek().kind == TokenKind::identifier && std::ranges::find(qualifiers, peek().text) != qualifiers.end()) {
            read.push_back(next());
            if (read.back().text == "layout" && is("(")) at_ = closingBracket(tokens_, at_) + 1;
        }
        return read;
    }

    void add(OutlineItem::Kind kind, std::size_t index, std::size_t first) {
        outline_.items.push_back({kind, index, tokens_.subspan(first, at_ - first)});
    }

    void skipToSemicolon() {
        while (!is(";")) {
            if (peek().kind == TokenKind::end) throw unexpected("';'");
            at_ = isBracket(peek(), "([{") ? closingBracket(tokens_, at_) + 1 : at_ + 1;
        }
        ++at_;
    }

    void declaration() {
        const std::size_t first = at_;
        std::vector<Token> read = readQualifiers();
        const bool block = peek().kind == TokenKind::identifier && peek(1).text == "{";
        if (peek().text == "struct" || peek().text == "precision" || block || (!read.empty() && is(";"))) {
            skipToSemicolon();
            return add(OutlineItem::Kind::other, 0, first);
        }
        if (std::ranges::find(statement_words, peek().text) != statement_words.end()) throw unexpected("a declaration");
        const Token type = expectName("a declaration");
        std::span<const Token> type_array;
        const bool is_array = arraySize(type_array);
        const Token name = expectName("a name");
        if (is("(")) {
            Function function{type, type_array, is_array, name, {}, {}, {}};
            finishFunction(function);
            outline_.functions.push_back(std::move(function));
            add(OutlineItem::Kind::function, outline_.functions.size() - 1, first);
        } else {
            Global global{std::move(read), type, {}, {}};
            finishGlobal(global, {name, type_array, is_array, {}});
            outline_.globals.push_back(std::move(global));
            add(OutlineItem::Kind::global, outline_.globals.size() - 1, first);
        }
    }

    void finishFunction(Function& function) {
        const std::size_t close = closingBracket(tokens_, at_);
        ++at_;
        const bool is_void = peek().text == "void" && at_ + 1 == close;
        if (is_void) ++at_;
        while (at_ < close) {
            Function::Parameter& parameter = function.parameters.emplace_back();
            parameter.qualifiers = readQualifiers();
            parameter.type = expectName("a parameter's type");
            parameter.declarator.is_array = arraySize(parameter.declarator.array);
            if (peek().kind == TokenKind::identifier) {
                parameter.declarator.name = next();
                if (!parameter.declarator.is_array)
                    parameter.declarator.is_array = arraySize(parameter.declarator.array);
            }
            if (at_ < close) {
                expect(",", "or ')'");
                if (at_ == close) throw unexpected("a parameter");
            }
        }
        expect(")", "");
        if (is("{")) {
            const std::size_t end = closingBracket(tokens_, at_);
            function.body = tokens_.subspan(at_, end - at_ + 1);
            function.last = tokens_[end];
            at_ = end + 1;
        } else {
            function.last = expect(";", "or '{'");
        }
    }

    void finishGlobal(Global& global, Declarator declarator) {
        const Declarator of_type = declarator;
        for (;;) {
            if (!declarator.is_array) declarator.is_array = arraySize(declarator.array);
            if (is("=")) {
                const std::size_t first = ++at_;
                while (!is(",") && !is(";")) {
                    const bool second_operand = at_ > first && isOperand(peek()) && isOperandEnd(tokens_[at_ - 1]);
                    if (peek().kind == TokenKind::end || second_operand) throw unexpected("';'");
                    at_ = isBracket(peek(), "([{") ? closingBracket(tokens_, at_) + 1 : at_ + 1;
                }
                declarator.value = tokens_.subspan(first, at_ - first);
                if (declarator.value.empty()) throw unexpected("a value");
            }
            global.declarators.push_back(declarator);
            if (!is(",")) break;
            ++at_;
            declarator = of_type;
            declarator.name = expectName("a name");
        }
        global.last = expect(";", "after a declaration");
    }

    std::span<const Token> tokens_;
    std::size_t at_ = 0;
    Outline outline_;
};

}  // namespace

bool Global::isConst() const {
    return std::ranges::any_of(qualifiers, [](const Token& token) { return token.text == "const"; });
}

const Function* Outline::find(std::string_view name) const {
    for (const Function& function : functions)
        if (function.name.text == name && !function.body.empty()) return &function;
    return nullptr;
}

std::size_t closingBracket(std::span<const Token> tokens, std::size_t open) {
    int depth = 0;
    for (std::size_t i = open; i < tokens.size(); ++i) {
        if (isBracket(tokens[i], "([{")) ++depth;
        if (isBracket(tokens[i], ")]}") && --depth == 0) return i;
    }
    return tokens.size() - 1;
}

Outline outline(std::span<const Token> tokens) {
    checkBrackets(tokens);
    return OutlineParser(tokens).run();
}

}  // namespace searchlight
