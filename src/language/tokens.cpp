#include "language/tokens.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/error.h"

namespace searchlight {

namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isHexDigit(char c) { return isDigit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }
bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

// Longest first: "<<=" must not be read as "<<" and "=".
constexpr std::array<std::string_view, 21> long_punctuation = {
    "<<=", ">>=", "++", "--", "<<", ">>", "<=", ">=", "==", "!=", "&&",
    "||",  "^^",  "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^="};
constexpr std::string_view short_punctuation = "()[]{}.,;:?+-*/%<>=!~&|^";

class Tokenizer {
public:
    Tokenizer(std::string_view source, int first_line) : source_(source), line_(first_line) {}

    std::vector<Token> run() {
        for (skipBlank(); at_ < source_.size(); skipBlank()) {
            readToken();
            line_is_blank_ = false;
        }
        add(TokenKind::end, 0);
        return std::move(tokens_);
    }

private:
    char peek(std::size_t ahead = 0) const { return at_ + ahead < source_.size() ? source_[at_ + ahead] : '\0'; }
    int column() const { return static_cast<int>(at_ - line_start_) + 1; }

    Error error(std::string message, std::string hint = {}) const {
        return inputError(std::move(message), std::move(hint)).at({}, line_, column());
    }

    void advance() {
        const char c = source_[at_++];
        // A lone carriage return ends a line too, as GLSL has it.
        if (c == '\n' || (c == '\r' && peek() != '\n')) {
            ++line_;
            line_start_ = at_;
            line_is_blank_ = true;
        }
    }

    void add(TokenKind kind, std::size_t size) {
        tokens_.push_back({kind, source_.substr(at_, size), line_, column(), at_});
        at_ += size;
    }

    void skipBlank() {
        while (at_ < source_.size()) {
            const char c = peek();
            if (c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f')
                advance();
            else if (c == '/' && peek(1) == '/')
                skipLineComment();
            else if (c == '/' && peek(1) == '*')
                skipBlockComment();
            else
                return;
        }
    }

    void skipLineComment() {
        while (at_ < source_.size() && peek() != '\n' && peek() != '\r') {
            // GLSL would carry the comment on to the next line; what looks like code there would be none.
            if (peek() == '\\' && (peek(1) == '\n' || peek(1) == '\r'))
                throw error("a backslash continues the comment on the next line", "end the comment differently");
            advance();
        }
    }

    void skipBlockComment() {
        const Error never_ends = error("this comment never ends", "expected */");
        const std::size_t end = source_.find("*/", at_ + 2);
        if (end == std::string_view::npos) throw never_ends;
        while (at_ < end + 2) advance();
    }

    void readToken() {
        const char c = peek();
        if (c == '#' && line_is_blank_)
            readPreprocessor();
        else if (isDigit(c) || (c == '.' && isDigit(peek(1))))
            readNumber();
        else if (isLetter(c))
            readIdentifier();
        else
            readPunctuation();
    }

    void readPreprocessor() {
        std::size_t size = 0;
        while (at_ + size < source_.size() && peek(size) != '\n' && peek(size) != '\r') ++size;
        add(TokenKind::preprocessor, size);
    }

    void readIdentifier() {
        std::size_t size = 1;
        while (isLetter(peek(size)) || isDigit(peek(size))) ++size;
        add(TokenKind::identifier, size);
    }

    void readNumber() {
        std::size_t size = 0;
        bool is_float = false;
        if (peek() == '0' && (peek(1) == 'x' || peek(1) == 'X')) {
            size = 2;
            while (isHexDigit(peek(size))) ++size;
            if (size == 2) throw error("a hexadecimal number needs digits after 0x");
        } else {
            while (isDigit(peek(size))) ++size;
            if (peek(size) == '.') {
                is_float = true;
                ++size;
                while (isDigit(peek(size))) ++size;
            }
            if (peek(size) == 'e' || peek(size) == 'E') {
                is_float = true;
                ++size;
                if (peek(size) == '+' || peek(size) == '-') ++size;
                if (!isDigit(peek(size))) throw error("a number needs digits after its exponent");
                while (isDigit(peek(size))) ++size;
            }
        }
        const char suffix = peek(size);
        if (is_float && ((suffix == 'l' && peek(size + 1) == 'f') || (suffix == 'L' && peek(size + 1) == 'F')))
            size += 2;
        else if (is_float ? suffix == 'f' || suffix == 'F' : suffix == 'u' || suffix == 'U')
            ++size;
        if (isLetter(peek(size)) || isDigit(peek(size)) || (is_float && peek(size) == '.'))
            throw error(fmt::format("malformed number '{}'", source_.substr(at_, size + 1)));
        add(is_float ? TokenKind::float_literal : TokenKind::int_literal, size);
    }

    void readPunctuation() {
        for (const std::string_view candidate : long_punctuation)
            if (source_.substr(at_).starts_with(candidate)) return add(TokenKind::punctuation, candidate.size());
        const char c = peek();
        if (short_punctuation.find(c) != std::string_view::npos) return add(TokenKind::punctuation, 1);
        if (c == '#') throw error("'#' inside a line", "GLSL comments start with //");
        if (c == '\\') throw error("lines cannot be continued with a backslash");
        const auto byte = static_cast<unsigned char>(c);
        if (byte > 0x20 && byte < 0x7f) throw error(fmt::format("'{}' has no meaning in GLSL", c));
        throw error(fmt::format("byte 0x{:02x} has no meaning in GLSL", byte), "outside comments GLSL is plain ASCII");
    }

    std::string_view source_;
    std::size_t at_ = 0;
    std::size_t line_start_ = 0;
    int line_;
    bool line_is_blank_ = true;
    std::vector<Token> tokens_;
};

}  // namespace

std::vector<Token> tokenize(std::string_view source, int first_line) { return Tokenizer(source, first_line).run(); }

}  // namespace searchlight
