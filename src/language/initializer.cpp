#include "language/initializer.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <list>
#include <map>
#include <optional>
#include <set>

#include "base/error.h"
#include "language/glsl_names.h"
#include "language/outline.h"
#include "language/state_writes.h"

namespace searchlight {

namespace {

Error errorAt(const Token& token, std::string message, std::string hint = {}) {
    return inputError(std::move(message), std::move(hint)).at({}, token.line, token.column);
}

std::string_view sourceOf(std::string_view text, std::span<const Token> tokens) {
    if (tokens.empty()) return {};
    const std::size_t begin = tokens.front().offset;
    return text.substr(begin, tokens.back().offset + tokens.back().text.size() - begin);
}

void blank(std::string& text, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
        if (text[i] != '\n') text[i] = ' ';
}

// Array sizes: integers, const int globals, + - * / and parentheses.
class SizeExpression {
public:
    SizeExpression(std::span<const Token> tokens, const std::map<std::string_view, long>& constants)
        : tokens_(tokens), constants_(constants) {}

    /// Nothing when it is no constant expression of that kind.
    std::optional<long> value() {
        const std::optional<long> result = sum();
        return at_ == tokens_.size() ? result : std::nullopt;
    }

private:
    static constexpr long limit = 1 << 24;

    std::string_view peek() const { return at_ < tokens_.size() ? tokens_[at_].text : std::string_view{}; }

    std::optional<long> sum() {
        std::optional<long> left = product();
        while (left && (peek() == "+" || peek() == "-")) {
            const bool plus = tokens_[at_++].text == "+";
            const std::optional<long> right = product();
            left = right ? checked(plus ? *left + *right : *left - *right) : std::nullopt;
        }
        return left;
    }

    std::optional<long> product() {
        std::optional<long> left = atom();
        while (left && (peek() == "*" || peek() == "/")) {
            const bool times = tokens_[at_++].text == "*";
            const std::optional<long> right = atom();
            if (!right || (!times && *right == 0)) return std::nullopt;
            left = checked(times ? *left * *right : *left / *right);
        }
        return left;
    }

    std::optional<long> atom() {
        if (at_ == tokens_.size() || depth_ > 100) return std::nullopt;
        const Token& token = tokens_[at_++];
        if (token.text == "(") {
            ++depth_;
            const std::optional<long> inner = sum();
            --depth_;
            if (peek() != ")") return std::nullopt;
            ++at_;
            return inner;
        }
        if (const auto constant = constants_.find(token.text); constant != constants_.end()) return constant->second;
        if (token.kind != TokenKind::int_literal) return std::nullopt;
        long number = 0;
        const char* const end = token.text.data() + token.text.size();
        const auto [stop, error] = std::from_chars(token.text.data(), end, number);
        const bool octal_or_hex = token.text.size() > 1 && token.text[0] == '0';
        if (error != std::errc{} || stop != end || octal_or_hex) return std::nullopt;
        return checked(number);
    }

    static std::optional<long> checked(long number) {
        return number > -limit && number < limit ? std::optional(number) : std::nullopt;
    }

    std::span<const Token> tokens_;
    const std::map<std::string_view, long>& constants_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

class Splitter {
public:
    explicit Splitter(const BssrdfFile& file) : file_(file) {}

    Initializer run() {
        if (file_.initializer.present()) split();
        checkWrites();
        return std::move(result_);
    }

private:
    void split() {
        const std::string& text = file_.initializer.text;
        const std::vector<Token> tokens = tokenize(text, file_.initializer.first_line);
        const Outline found = outline(tokens);
        result_.first_line = file_.initializer.first_line;
        result_.functions_text = text;
        result_.init_text = text;
        std::size_t kept = 0;  // of init_text: everything before is decided
        for (const OutlineItem& item : found.items) {
            const std::size_t begin = item.tokens.front().offset;
            const std::size_t end = item.tokens.back().offset + item.tokens.back().text.size();
            if (item.kind == OutlineItem::Kind::global) {
                const Global& global = found.globals[item.index];
                if (global.isConst()) {
                    noteConstants(global);
                    continue;
                }
                addState(global, text);
                blank(result_.functions_text, begin, end);
            } else if (item.kind == OutlineItem::Kind::function && found.functions[item.index].name.text == "init") {
                blank(result_.functions_text, begin, end);
                if (found.functions[item.index].body.empty()) continue;  // a prototype
                blank(result_.init_text, kept, begin);
                kept = end;
            } else if (item.kind == OutlineItem::Kind::other && item.tokens.front().text != "struct") {
                throw errorAt(item.tokens.front(), "an initializer holds globals, structs and functions");
            }
        }
        blank(result_.init_text, kept, text.size());
    }

    void noteConstants(const Global& global) {
        for (const Declarator& declarator : global.declarators) {
            checkName(declarator.name);
            if (global.type.text != "int" || declarator.is_array) continue;
            const std::optional<long> value = SizeExpression(declarator.value, constants_).value();
            if (value) constants_[declarator.name.text] = *value;
        }
    }

    void checkName(const Token& name) {
        if (const std::string why = whyReserved(name.text); !why.empty())
            throw errorAt(name, fmt::format("a global cannot be called '{}'", name.text), why);
        for (const Param& param : file_.parameters) {
            if (param.name == name.text)
                throw errorAt(name, fmt::format("'{}' is already a parameter of the model", name.text));
            for (const std::string& choice : param.choices)
                if (param.name + "_" + choice == name.text)
                    throw errorAt(name, fmt::format("'{}' is already a choice of {}", name.text, param.name));
        }
        if (const auto [earlier, fresh] = lines_.try_emplace(name.text, name.line); !fresh)
            throw errorAt(name, fmt::format("'{}' is already declared on line {}", name.text, earlier->second));
    }

    void addState(const Global& global, std::string_view text) {
        if (!global.qualifiers.empty())
            throw errorAt(global.qualifiers.front(),
                          fmt::format("a global of the initializer cannot be '{}'", global.qualifiers.front().text),
                          "expected TYPE NAME; or const TYPE NAME = VALUE;");
        if (!isGlslValueType(global.type.text))
            throw errorAt(global.type,
                          fmt::format("a global of the initializer cannot have type '{}'", global.type.text),
                          "valid: float, int, uint, bool, their vectors, and matrices of float");
        for (const Declarator& declarator : global.declarators) {
            checkName(declarator.name);
            StateVariable variable{std::string(global.type.text),
                                   std::string(declarator.name.text),
                                   0,
                                   std::string(sourceOf(text, declarator.value)),
                                   declarator.name.line,
                                   declarator.name.column};
            if (declarator.is_array) {
                const std::optional<long> size = SizeExpression(declarator.array, constants_).value();
                if (!size || *size < 1 || *size > 4096)
                    throw errorAt(declarator.name,
                                  fmt::format("the size of '{}' is no constant from 1 to 4096", declarator.name.text),
                                  "write a number, or const int globals with + - * /");
                variable.array_size = static_cast<int>(*size);
            }
            result_.state.push_back(std::move(variable));
        }
    }

    // Only init() writes State, in whatever section a function stands.
    void checkWrites() const {
        std::set<std::string_view> state;
        for (const StateVariable& variable : result_.state) state.insert(variable.name);
        std::list<std::vector<Token>> tokens;
        std::vector<Outline> outlines;
        OutParameters out_parameters;
        for (const BssrdfSection* section : {&file_.initializer, &file_.diffuse_reflectance, &file_.shader}) {
            if (!section->present()) continue;
            outlines.push_back(outline(tokens.emplace_back(tokenize(section->text, section->first_line))));
            collectOutParameters(outlines.back(), out_parameters);
        }
        for (const Outline& sections : outlines)
            for (const Function& function : sections.functions)
                if (!function.body.empty() && !(function.name.text == "init" && function.parameters.empty()))
                    checkStateWrites(function, state, out_parameters);
    }

    const BssrdfFile& file_;
    Initializer result_;
    std::map<std::string_view, long> constants_;
    std::map<std::string_view, int> lines_;
};

}  // namespace

Initializer splitInitializer(const BssrdfFile& file) {
    try {
        return Splitter(file).run();
    } catch (const Error& error) {
        throw error.at(file.path);
    }
}

}  // namespace searchlight
