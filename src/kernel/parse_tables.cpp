#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/text.h"
#include "kernel/kernel_rows.h"
#include "kernel/kernel_text.h"

namespace searchlight {

namespace {

enum class Kind { word, number, sign, comment, end };

struct Token {
    Kind kind = Kind::end;
    std::string_view text;
    double value = 0;
    int line = 1, column = 1;
};

bool isWordStart(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool isWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
bool isDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)); }

class Scanner {
public:
    explicit Scanner(std::string_view text) : text_(text) {}

    std::vector<Token> all() {
        std::vector<Token> tokens;
        while (true) {
            skip();
            Token token{.line = line_, .column = static_cast<int>(at_ - line_start_) + 1};
            if (at_ >= text_.size()) {
                tokens.push_back(token);
                return tokens;
            }
            read(token);
            tokens.push_back(token);
        }
    }

private:
    char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }

    void advance() {
        if (text_[at_++] != '\n') return;
        ++line_;
        line_start_ = at_;
    }

    void skipLine() {
        while (at_ < text_.size() && text_[at_] != '\n') ++at_;
    }

    // White space, block comments and preprocessor lines.
    void skip() {
        while (at_ < text_.size()) {
            if (peek() == '#')
                skipLine();
            else if (peek() == '/' && peek(1) == '*') {
                while (at_ < text_.size() && !(peek() == '*' && peek(1) == '/')) advance();
                for (int i = 0; i < 2 && at_ < text_.size(); ++i) advance();
            } else if (std::isspace(static_cast<unsigned char>(peek())))
                advance();
            else
                return;
        }
    }

    void read(Token& token) {
        const std::size_t first = at_;
        if (peek() == '/' && peek(1) == '/') {
            skipLine();
            token.kind = Kind::comment;
        } else if (isWordStart(peek())) {
            while (isWord(peek())) ++at_;
            token.kind = Kind::word;
        } else if (isDigit(peek()) || (peek() == '.' && isDigit(peek(1)))) {
            while (isDigit(peek()) || peek() == '.') ++at_;
            const std::size_t after = peek() != 'e' && peek() != 'E'                           ? 0
                                      : isDigit(peek(1))                                       ? 1
                                      : (peek(1) == '-' || peek(1) == '+') && isDigit(peek(2)) ? 2
                                                                                               : 0;
            if (after > 0) {
                at_ += after;
                while (isDigit(peek())) ++at_;
            }
            const std::optional<double> value = parseNumber(text_.substr(first, at_ - first));
            token.kind = value ? Kind::number : Kind::sign;
            token.value = value.value_or(0);
            if (value && (peek() == 'f' || peek() == 'F' || peek() == 'h')) ++at_;
        } else {
            ++at_;
            token.kind = Kind::sign;
        }
        token.text = text_.substr(first, at_ - first);
    }

    std::string_view text_;
    std::size_t at_ = 0, line_start_ = 0;
    int line_ = 1;
};

class TableParser {
public:
    TableParser(std::string_view text, std::string_view path) : path_(path), tokens_(Scanner(text).all()) {}

    std::vector<KernelTable> run() {
        while (tokens_[at_].kind != Kind::end) {
            const Token& token = tokens_[at_];
            if (token.kind == Kind::comment) {
                readComment(token.text);
                ++at_;
            } else if (isOpening())
                readTable();
            else {
                // The name of an array stands before its brackets or its equals sign.
                if (token.kind == Kind::word && (is(at_ + 1, "[") || is(at_ + 1, "="))) name_ = token.text;
                ++at_;
            }
        }
        if (tables_.empty()) readLines();
        if (tables_.empty())
            throw inputError("there is no kernel in it",
                             "expected an array of float4, vec4 or { r, g, b, offset }, lines of such numbers, or JSON")
                .at(path_);
        return std::move(tables_);
    }

private:
    bool is(std::size_t at, std::string_view text) const { return at < tokens_.size() && tokens_[at].text == text; }

    bool isOpening() const {
        static constexpr std::array<std::string_view, 13> types{"float4", "vec4",    "half4",  "fixed4", "Vector4",
                                                                "Color",  "double4", "float2", "vec2",   "half2",
                                                                "fixed2", "Vector2", "double2"};
        if (tokens_[at_].kind == Kind::word)
            return std::ranges::find(types, tokens_[at_].text) != types.end() && is(at_ + 1, "(");
        return (is(at_, "{") || is(at_, "[")) &&
               (tokens_[at_ + 1].kind == Kind::number || is(at_ + 1, "-") || is(at_ + 1, "+"));
    }

    Error fault(const Token& token, std::string message, std::string hint = {}) const {
        return inputError(std::move(message), std::move(hint)).at(path_, token.line, token.column);
    }

    // A number with its sign; nothing where it is other code. Leaves at_ behind it, or where it was.
    std::optional<double> number() {
        const bool negative = is(at_, "-"), sign = negative || is(at_, "+");
        const std::size_t at = at_ + (sign ? 1 : 0);
        if (tokens_[std::min(at, tokens_.size() - 1)].kind != Kind::number) return {};
        at_ = at + 1;
        return (negative ? -1 : 1) * tokens_[at].value;
    }

    // Four numbers in brackets, or two: of all channels, and the offset. Nothing where it is other code. Leaves at_
    // behind it, or where it was.
    std::optional<std::vector<double>> vector() {
        const std::size_t start = at_;
        at_ += tokens_[at_].kind == Kind::word ? 2 : 1;
        const std::string_view close = is(at_ - 1, "(") ? ")" : is(at_ - 1, "[") ? "]" : "}";
        std::vector<double> values;
        while (values.size() < 5) {
            const std::optional<double> value = number();
            if (!value) break;
            values.push_back(*value);
            if (is(at_, close) && (values.size() == 2 || values.size() == 4)) {
                ++at_;
                return values;
            }
            if (!is(at_, ",")) break;
            ++at_;
        }
        at_ = start;
        return {};
    }

    static KernelRow rowOf(const std::vector<double>& values, int line) {
        if (values.size() == 2) return {{values[0], values[0], values[0], values[1]}, line};
        return {{values[0], values[1], values[2], values[3]}, line};
    }

    void readTable() {
        std::vector<KernelRow> rows;
        std::size_t width = 0;
        const std::size_t start = at_;
        while (true) {
            while (tokens_[at_].kind == Kind::comment) ++at_;
            if (!isOpening()) break;
            const Token& token = tokens_[at_];
            const std::optional<std::vector<double>> values = vector();
            if (!values && rows.empty()) {
                ++at_;
                return;
            }
            if (rows.empty()) width = values->size();
            if (!values || values->size() != width)
                throw fault(
                    token,
                    fmt::format("tap {} of the table is not {} numbers", rows.size() + 1, width == 2 ? "two" : "four"),
                    width == 2 ? "expected the weight and the offset" : "expected r, g, b, offset");
            add(rows, rowOf(*values, token.line), token);
            while (tokens_[at_].kind == Kind::comment) ++at_;
            if (!is(at_, ",")) break;
            ++at_;
        }
        finish(rows, tokens_[start]);
    }

    // Text of numbers alone: a tap on each line, tables apart by other lines.
    void readLines() {
        for (const Token& token : tokens_)
            if (token.kind == Kind::word ||
                (token.kind == Kind::sign && token.text.find_first_not_of(",;+-") != token.text.npos))
                return;
        at_ = 0;
        std::vector<KernelRow> rows;
        std::size_t width = 0, start = 0;
        while (tokens_[at_].kind != Kind::end) {
            if (tokens_[at_].kind == Kind::comment) {
                readComment(tokens_[at_++].text);
                continue;
            }
            const std::size_t first = at_;
            const Token& token = tokens_[first];
            std::vector<double> values;
            while (tokens_[at_].kind != Kind::end && tokens_[at_].line == token.line) {
                if (tokens_[at_].kind == Kind::comment) break;
                if (is(at_, ",") || is(at_, ";")) {
                    ++at_;
                    continue;
                }
                const std::optional<double> value = number();
                if (!value) throw fault(tokens_[at_], "this is no number", "expected r, g, b, offset on a line");
                values.push_back(*value);
            }
            if (values.empty()) continue;
            if (values.size() != 2 && values.size() != 4)
                throw fault(token, fmt::format("there are {} numbers on the line", values.size()),
                            "expected r, g, b, offset, or the weight of all channels and the offset");
            if (!rows.empty() && (values.size() != width || token.line > rows.back().line + 1)) {
                finish(rows, tokens_[start]);
                rows.clear();
            }
            if (rows.empty()) start = first;
            width = values.size();
            add(rows, rowOf(values, token.line), token);
        }
        if (!rows.empty()) finish(rows, tokens_[start]);
    }

    void add(std::vector<KernelRow>& rows, const KernelRow& row, const Token& token) const {
        rows.push_back(row);
        if (rows.size() > most_kernel_taps)
            throw fault(token, fmt::format("a table of more than {} taps", most_kernel_taps));
    }

    void finish(const std::vector<KernelRow>& rows, const Token& at) {
        if (rows.size() < 3) return;
        if (tables_.size() == most_kernel_tables)
            throw fault(at, fmt::format("more than {} tables", most_kernel_tables));
        next_.name = name_;
        next_.line = at.line;
        try {
            tables_.push_back(tableOfRows(next_, rows));
        } catch (Error& error) {
            throw error.at(path_, at.line, at.column);
        }
        next_ = KernelTable();
    }

    // "term 1 of 2: angle_deg 45, scale 0.5 0.5 0.5", as exports have it.
    void readComment(std::string_view text) {
        const auto numbersAfter = [&](std::string_view key, std::size_t count) {
            std::vector<double> numbers;
            const std::size_t found = text.find(key);
            if (found == text.npos) return numbers;
            for (const std::string_view word : split(text.substr(found + key.size()), ' ')) {
                const std::string_view bare = word.substr(0, word.find_first_of(",:"));
                if (bare.empty()) continue;
                const std::optional<double> number = parseNumber(bare);
                if (!number || numbers.size() == count) break;
                numbers.push_back(*number);
            }
            return numbers.size() == count ? numbers : std::vector<double>();
        };
        const std::vector<double> index = numbersAfter("term ", 1), count = numbersAfter(" of ", 1);
        if (index.empty() || count.empty()) return;
        const std::vector<double> angle = numbersAfter("angle_deg ", 1), scale = numbersAfter("scale ", 3);
        if (angle.empty() || scale.empty() ||
            !(index[0] >= 1 && index[0] <= count[0] && count[0] <= most_kernel_tables))
            return;
        next_.index = static_cast<int>(index[0]);
        next_.count = static_cast<int>(count[0]);
        next_.term.angle_deg = angle[0];
        next_.term.scale = {scale[0], scale[1], scale[2]};
    }

    std::string path_;
    std::vector<Token> tokens_;
    std::size_t at_ = 0;
    std::string name_;
    KernelTable next_;
    std::vector<KernelTable> tables_;
};

}  // namespace

std::vector<KernelTable> parseKernelTables(std::string_view text, std::string_view path) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    // No shader begins with a brace and a quote.
    const std::size_t second = first == text.npos ? first : text.find_first_not_of(" \t\r\n", first + 1);
    if (second != text.npos && text[first] == '{' && text[second] == '"') return kernelTablesOfJson(text, path);
    return TableParser(text, path).run();
}

std::vector<Taps> kernelsOfTables(const std::vector<KernelTable>& tables) {
    std::vector<Taps> kernels;
    for (const KernelTable& table : tables) {
        if (table.index == 1 || kernels.empty()) kernels.emplace_back();
        kernels.back().terms.push_back(table.term);
        kernels.back().extent_mm = std::max(kernels.back().extent_mm, table.term.offsets_mm.back());
    }
    return kernels;
}

}  // namespace searchlight
