#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/text.h"
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

struct Row {
    std::array<double, 4> value{};
    int line = 1;
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
        if (tables_.empty())
            throw inputError("there is no kernel in it", "expected an array of float4, vec4 or { r, g, b, offset }")
                .at(path_);
        return std::move(tables_);
    }

private:
    bool is(std::size_t at, std::string_view text) const { return at < tokens_.size() && tokens_[at].text == text; }

    bool isOpening() const {
        static constexpr std::array<std::string_view, 7> types{"float4",  "vec4",  "half4",  "fixed4",
                                                               "Vector4", "Color", "double4"};
        if (tokens_[at_].kind == Kind::word)
            return std::ranges::find(types, tokens_[at_].text) != types.end() && is(at_ + 1, "(");
        return is(at_, "{") && (tokens_[at_ + 1].kind == Kind::number || is(at_ + 1, "-") || is(at_ + 1, "+"));
    }

    Error fault(const Token& token, std::string message, std::string hint = {}) const {
        return inputError(std::move(message), std::move(hint)).at(path_, token.line, token.column);
    }

    // Four numbers in brackets; nothing where it is other code. Leaves at_ behind it, or where it was.
    std::optional<Row> vector() {
        const std::size_t start = at_;
        Row row{.line = tokens_[at_].line};
        at_ += tokens_[at_].kind == Kind::word ? 2 : 1;
        const std::string_view close = is(at_ - 1, "(") ? ")" : "}";
        for (std::size_t i = 0; i < 4; ++i) {
            const bool negative = is(at_, "-");
            if (negative || is(at_, "+")) ++at_;
            const bool number = at_ < tokens_.size() && tokens_[at_].kind == Kind::number;
            if (number) row.value[i] = (negative ? -1 : 1) * tokens_[at_].value;
            const std::size_t next = at_ + 1;
            if (!number || !is(next, i < 3 ? "," : close)) {
                at_ = start;
                return {};
            }
            at_ += 2;
        }
        return row;
    }

    void readTable() {
        std::vector<Row> rows;
        const std::size_t start = at_;
        while (true) {
            while (tokens_[at_].kind == Kind::comment) ++at_;
            if (!isOpening()) break;
            const Token& token = tokens_[at_];
            const std::optional<Row> row = vector();
            if (!row) {
                if (rows.empty()) {
                    ++at_;
                    return;
                }
                throw fault(token, fmt::format("tap {} of the table is not four numbers", rows.size() + 1),
                            "expected r, g, b, offset");
            }
            rows.push_back(*row);
            if (rows.size() > most_kernel_taps)
                throw fault(token, fmt::format("a table of more than {} taps", most_kernel_taps));
            while (tokens_[at_].kind == Kind::comment) ++at_;
            if (!is(at_, ",")) break;
            ++at_;
        }
        if (rows.size() < 3) return;
        if (tables_.size() == most_kernel_tables)
            throw fault(tokens_[start], fmt::format("more than {} tables", most_kernel_tables));
        tables_.push_back(table(rows, tokens_[start]));
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

    KernelTable table(const std::vector<Row>& rows, const Token& at) const {
        KernelTable table = next_;
        table.name = name_;
        table.line = at.line;
        std::vector<Row> sorted = rows;
        std::ranges::stable_sort(sorted, {}, [](const Row& row) { return row.value[3]; });
        if (sorted.front().value[3] >= 0 && sorted.back().value[3] > 0) {
            table.one_sided = true;
            std::vector<Row> both;
            for (auto row = sorted.rbegin(); row != sorted.rend(); ++row) {
                if (row->value[3] == 0) continue;
                both.push_back(*row);
                both.back().value[3] = -row->value[3];
            }
            both.insert(both.end(), sorted.begin(), sorted.end());
            sorted = std::move(both);
        }
        const auto middle = std::ranges::find(sorted, 0.0, [](const Row& row) { return row.value[3]; });
        if (middle == sorted.end()) throw fault(at, "the table has no tap in the middle", "expected an offset of 0");
        const auto before = static_cast<std::size_t>(middle - sorted.begin());
        if (sorted.size() - before - 1 != before)
            throw fault(at,
                        fmt::format("{} taps on one side of the middle and {} on the other", before,
                                    sorted.size() - before - 1),
                        "expected as many, or one side alone");
        for (const Row& row : sorted) {
            table.term.offsets_mm.push_back(row.value[3]);
            table.term.weights.push_back({row.value[0], row.value[1], row.value[2]});
        }
        findFaults(table, rows);
        return table;
    }

    static void findFaults(KernelTable& table, const std::vector<Row>& rows) {
        const std::vector<double>& offsets = table.term.offsets_mm;
        const std::vector<Rgb>& weights = table.term.weights;
        const std::size_t n = offsets.size();
        static constexpr const char* names[] = {"red", "green", "blue"};
        // Six digits, as tables are printed, times the number of taps.
        const double rounding = 1e-6 * static_cast<double>(n);
        if (table.count == 1)
            for (int c = 0; c < Rgb::channels; ++c) {
                double sum = 0;
                for (const Rgb& weight : weights) sum += weight[c];
                if (std::abs(sum - 1) > std::max(rounding, 1e-5))
                    table.faults.push_back(fmt::format("{} adds up to {:.6g}, not to 1", names[c], sum));
            }
        for (std::size_t i = 0; i < n / 2; ++i) {
            const std::size_t j = n - 1 - i;
            if (std::abs(offsets[i] + offsets[j]) > 1e-5 * std::abs(offsets[j]))
                table.faults.push_back(fmt::format("offset {:g} has {:g} on the other side", offsets[j], offsets[i]));
            for (int c = 0; c < Rgb::channels; ++c)
                if (std::abs(weights[i][c] - weights[j][c]) > 1e-5 * (std::abs(weights[j][c]) + 1e-3))
                    table.faults.push_back(fmt::format("{} at offset {:g} is {:g}, on the other side {:g}", names[c],
                                                       offsets[j], weights[j][c], weights[i][c]));
        }
        for (std::size_t i = 0; i + 1 < n; ++i)
            if (offsets[i] == offsets[i + 1])
                table.faults.push_back(fmt::format("offset {:g} stands twice", offsets[i]));
        if (table.count == 1)
            for (std::size_t i = 0; i < n; ++i)
                for (int c = 0; c < Rgb::channels; ++c)
                    if (weights[i][c] < 0)
                        table.faults.push_back(fmt::format("{} at offset {:g} is negative", names[c], offsets[i]));
        const auto ascends = [](auto first, auto last) {
            return std::is_sorted(first, last, [](const Row& a, const Row& b) { return a.value[3] < b.value[3]; });
        };
        if (rows.front().value[3] != 0 && !ascends(rows.begin(), rows.end()))
            table.faults.push_back("offsets do not ascend");
        if (rows.front().value[3] == 0 && !ascends(rows.begin() + 1, rows.end()))
            table.faults.push_back("offsets after the middle do not ascend");
        // A density that rises and falls again away from the middle is a slip of digits, where it falls on both sides.
        for (int c = 0; c < Rgb::channels && table.count == 1; ++c) {
            std::vector<double> density;
            for (std::size_t i = n / 2 + 1; i + 1 < n; ++i)
                density.push_back(weights[i][c] / (0.5 * (offsets[i + 1] - offsets[i - 1])));
            for (std::size_t i = 1; i + 1 < density.size(); ++i)
                if (density[i] > 1.02 * density[i - 1] ||
                    (i + 2 < density.size() && density[i] < density[i + 1] / 1.02))
                    table.faults.push_back(fmt::format("{} per mm does not fall away from the middle at offset {:g}",
                                                       names[c], offsets[n / 2 + 1 + i]));
        }
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
