#include "language/state_writes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/error.h"
#include "language/glsl_names.h"

namespace searchlight {

namespace {

using Names = std::set<std::string_view>;

bool isAssignment(const Token& token) {
    constexpr std::array<std::string_view, 13> operators = {
        "=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>=", "++", "--"};
    return token.kind == TokenKind::punctuation && std::ranges::find(operators, token.text) != operators.end();
}

// Walks a function body, minding locals and parameters.
class StateWrites {
public:
    StateWrites(const Names& state, const OutParameters& out_parameters, const Function& function)
        : state_(state), out_parameters_(out_parameters), function_(function) {}

    void check() {
        scopes_.emplace_back();
        for (const Function::Parameter& parameter : function_.parameters) declare(parameter.declarator.name);
        const std::span<const Token> body = function_.body;
        for (at_ = 0; at_ < body.size(); ++at_) {
            const Token& token = body[at_];
            if (token.text == "{") scopes_.emplace_back();
            if (token.text == "}") scopes_.pop_back();
            if (token.kind != TokenKind::identifier) {
                followDeclaration(token);
                continue;
            }
            if (startsDeclarator()) {
                declare(token);
                in_declaration_ = true;
                depth_ = 0;
            } else if (state_.contains(token.text) && !hidden(token.text) && isWritten()) {
                throw inputError(fmt::format("{} writes '{}'", function_.name.text, token.text),
                                 "globals of the initializer are the model's state: only init() may change them")
                    .at({}, token.line, token.column);
            }
        }
    }

private:
    // Two names in a row, or type[n] name, stand only where something is declared.
    bool startsDeclarator() const {
        if (at_ == 0) return false;
        const std::span<const Token> body = function_.body;
        const Token& before = body[at_ - 1];
        if (in_declaration_ && depth_ == 0 && before.text == ",") return true;
        if (before.kind == TokenKind::identifier)
            return isGlslValueType(before.text) || !isGlslKeyword(before.text) || before.text == "const";
        return before.text == "]" && afterArrayType();
    }

    bool afterArrayType() const {
        std::size_t i = at_ - 1;
        while (i > 0 && function_.body[i].text != "[") --i;
        return i > 0 && isGlslValueType(function_.body[i - 1].text);
    }

    void followDeclaration(const Token& token) {
        if (token.text == "(" || token.text == "[" || token.text == "{") ++depth_;
        if (token.text == ")" || token.text == "]" || token.text == "}") --depth_;
        if (token.text == ";" || depth_ < 0) in_declaration_ = false;
    }

    bool isWritten() const {
        const std::span<const Token> body = function_.body;
        if (body[at_ - 1].text == "++" || body[at_ - 1].text == "--") return true;
        const std::size_t after = behindSuffixes();
        return after < body.size() && (isAssignment(body[after]) || isOutArgument(after));
    }

    // The token behind "[i]" and ".x" that follow the name.
    std::size_t behindSuffixes() const {
        const std::span<const Token> body = function_.body;
        std::size_t after = at_ + 1;
        while (after + 1 < body.size()) {
            if (body[after].text == "[")
                after = closingBracket(body, after) + 1;
            else if (body[after].text == ".")
                after += 2;
            else
                break;
        }
        return after;
    }

    // Whether the name stands alone between the commas of a call, where the function called writes.
    bool isOutArgument(std::size_t after) const {
        const std::span<const Token> body = function_.body;
        const std::string_view before = body[at_ - 1].text, behind = body[after].text;
        if ((before != "(" && before != ",") || (behind != ")" && behind != ",")) return false;
        std::size_t position = 0, open = at_ - 1;
        for (int depth = 0; open > 0; --open) {
            const std::string_view text = body[open].text;
            if (text == ")" || text == "]") ++depth;
            if (text == "[") --depth;
            if (text == "(" && depth-- == 0) break;
            if (text == "," && depth == 0) ++position;
            if (text == ";" || text == "{") return false;
        }
        if (open == 0) return false;
        const auto writer = out_parameters_.find(body[open - 1].text);
        return writer != out_parameters_.end() && position < writer->second.size() && writer->second[position];
    }

    void declare(const Token& name) { scopes_.back().insert(name.text); }
    bool hidden(std::string_view name) const {
        return std::ranges::any_of(scopes_, [&](const Names& names) { return names.contains(name); });
    }

    const Names& state_;
    const OutParameters& out_parameters_;
    const Function& function_;
    std::size_t at_ = 0;
    std::vector<Names> scopes_;
    bool in_declaration_ = false;
    int depth_ = 0;
};

}  // namespace

void collectOutParameters(const Outline& outline, OutParameters& into) {
    for (const Function& function : outline.functions)
        for (std::size_t i = 0; i < function.parameters.size(); ++i)
            for (const Token& qualifier : function.parameters[i].qualifiers) {
                if (qualifier.text != "out" && qualifier.text != "inout") continue;
                std::vector<bool>& writes = into[function.name.text];
                if (writes.size() <= i) writes.resize(i + 1);
                writes[i] = true;
            }
}

void checkStateWrites(const Function& function, const Names& state, const OutParameters& out_parameters) {
    StateWrites(state, out_parameters, function).check();
}

}  // namespace searchlight
