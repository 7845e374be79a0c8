#include "language/cpp_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "language/glsl_names.h"

namespace searchlight {

namespace {

// GLSL type -> C++ type. The vectors are aliases of the generated struct.
std::string_view cppType(std::string_view glsl) {
    static const std::map<std::string_view, std::string_view> types = {
        {"float", "Real"},  {"int", "int"},     {"uint", "std::uint32_t"}, {"bool", "bool"},
        {"vec2", "vec2"},   {"vec3", "vec3"},   {"vec4", "vec4"},          {"bvec2", "bvec2"},
        {"bvec3", "bvec3"}, {"bvec4", "bvec4"}, {"mat3", "mat3"},          {"void", "void"}};
    const auto found = types.find(glsl);
    return found == types.end() ? std::string_view{} : found->second;
}

bool isStatementWord(std::string_view text) {
    constexpr std::array<std::string_view, 13> words = {"if",      "else",  "for",      "while",  "do",
                                                        "return",  "break", "continue", "switch", "case",
                                                        "default", "true",  "false"};
    return std::ranges::find(words, text) != words.end();
}

bool isAssignment(std::string_view text) {
    return (text.ends_with('=') && text != "==" && text != "<=" && text != ">=" && text != "!=") || text == "++" ||
           text == "--";
}

bool isOpening(std::string_view text) { return text == "(" || text == "[" || text == "{"; }

// Component indices of ".xyz"; empty when it is no swizzle.
std::vector<int> swizzle(std::string_view text) {
    for (const std::string_view set : {"xyzw", "rgba", "stpq"}) {
        std::vector<int> components;
        for (const char c : text)
            if (const std::size_t at = set.find(c); at != std::string_view::npos)
                components.push_back(static_cast<int>(at));
        if (components.size() == text.size() && text.size() <= 4) return components;
    }
    return {};
}

std::string literal(const Token& token) {
    std::string_view text = token.text;
    if (text.ends_with("lf") || text.ends_with("LF")) throw notPortable(token, "a double literal");
    if (text.ends_with('f') || text.ends_with('F')) text.remove_suffix(1);
    return fmt::format("Real({})", text);
}

// Values in "float[](a, b, c)": what the size of an unsized array is.
int countValues(std::span<const Token> value) {
    int depth = 0, count = 0;
    for (const Token& token : value) {
        if (token.text == "(" && ++depth == 1) count = 1;
        if (token.text == ")") --depth;
        if (token.text == "," && depth == 1) ++count;
    }
    return count;
}

}  // namespace

Error notPortable(const Token& token, const std::string& what, std::string hint) {
    return inputError("not in the portable subset: " + what, std::move(hint)).at({}, token.line, token.column);
}

std::string cppName(std::string_view name) {
    static const std::set<std::string_view> kept = {
        // Words of C++ that GLSL leaves free.
        "alignas", "alignof", "and", "and_eq", "auto", "bitand", "bitor", "catch", "char", "char8_t", "char16_t",
        "char32_t", "co_await", "co_return", "co_yield", "compl", "concept", "const_cast", "consteval", "constexpr",
        "constinit", "decltype", "delete", "dynamic_cast", "explicit", "export", "friend", "mutable", "new", "noexcept",
        "not", "not_eq", "nullptr", "operator", "or", "or_eq", "private", "protected", "register", "reinterpret_cast",
        "requires", "signed", "static_assert", "static_cast", "thread_local", "throw", "try", "typeid", "typename",
        "virtual", "wchar_t", "xor", "xor_eq", "asm", "goto", "inline", "long", "short", "static", "this", "using",
        // Macros of the standard headers.
        "assert", "INFINITY", "NAN", "NULL", "HUGE_VAL", "HUGE_VALF", "errno", "EOF", "linux", "unix",
        // Names of the generated code.
        "Real", "Base", "Read", "read", "readParameters", "std", "glsl", "uses_normals", "has_diffuse_reflectance"};
    const bool keep =
        kept.contains(name) || name.starts_with("M_") || name.starts_with("FP_") || name.starts_with("SEARCHLIGHT_");
    return keep ? fmt::format("{}_glsl", name) : std::string(name);
}

void CppWriter::enterFile(std::string_view path) {
    path_ = path;
    line_ = 0;
}

void CppWriter::line(std::string_view text) {
    if (!text_.empty() && text_.back() != '\n') text_ += '\n';
    text_ += fmt::format("    {}\n", text);
    line_ = 0;
}

// Brings the text to the token's line: by line ends when it is near, else by a #line.
void CppWriter::place(const Token& token) {
    constexpr int near = 4;
    if (line_ == token.line) return;
    if (line_ > 0 && token.line > line_ && token.line - line_ <= near)
        text_.append(static_cast<std::size_t>(token.line - line_), '\n');
    else
        text_ +=
            fmt::format("{}#line {} \"{}\"\n", text_.empty() || text_.back() == '\n' ? "" : "\n", token.line, path_);
    text_.append(static_cast<std::size_t>(std::min(token.column + 3, 100)), ' ');
    line_ = token.line;
    end_offset_ = token.offset;
}

void CppWriter::put(const Token& token, std::string_view text) {
    place(token);
    if (token.offset > end_offset_ && text_.back() != ' ') text_ += ' ';
    text_ += text;
    end_offset_ = token.offset + token.text.size();
}

// On one line, wherever it stood.
std::string CppWriter::expression(std::span<const Token> range) {
    std::vector<Token> one_line(range.begin(), range.end());
    for (Token& token : one_line) token.line = range.front().line;
    CppWriter writer(functions_);
    writer.in_value_ = true;
    if (!range.empty()) {
        writer.line_ = range.front().line;
        writer.end_offset_ = range.front().offset;
    }
    writer.tokens(one_line);
    used_.insert(writer.used_.begin(), writer.used_.end());
    return writer.text_;
}

// After "name =".
void CppWriter::value(std::span<const Token> range) {
    for (const Token& token : range)
        if (token.text == "{") throw notPortable(token, "a list in { }", "write TYPE[](a, b) or a constructor");
    end_offset_ = 0;
    in_value_ = true;
    tokens(range);
    in_value_ = false;
}

std::string CppWriter::typeText(const Token& type, bool is_array, std::span<const Token> array,
                                std::span<const Token> value) {
    const std::string_view cpp = cppType(type.text);
    if (cpp.empty())
        throw notPortable(type, fmt::format("type '{}'", type.text),
                          "valid: float, int, uint, bool, vec2 to vec4, bvec2 to bvec4, mat3, and arrays of them");
    if (cpp == type.text && type.text != "int" && type.text != "bool" && type.text != "void")
        used_.insert(std::string(cpp));
    if (!is_array) return std::string(cpp);
    if (array.empty() && value.empty()) throw notPortable(type, "an array without a size");
    const std::string size = array.empty() ? std::to_string(countValues(value)) : expression(array);
    return fmt::format("glsl::Array<{}, {}>", cpp, size);
}

// "TYPE name = value" without the semicolon. `lead` goes before the type; without `with_type`, in its place.
void CppWriter::declarator(std::string_view lead, const Token& type, const Declarator& item, bool with_type,
                           bool with_value) {
    for (const Token& token : item.value)
        if (token.text == item.name.text)
            throw notPortable(token, fmt::format("'{}' in its own initial value", token.text),
                              "GLSL means the outer variable, C++ the new one: use another name");
    const std::string full_type = typeText(type, item.is_array, item.array, item.value);
    place(with_type && type.line == item.name.line ? type : item.name);
    if (text_.back() != ' ' && text_.back() != '(' && with_type) text_ += ' ';
    text_ += with_type ? fmt::format("{}{} ", lead, full_type) : lead;
    text_ += cppName(item.name.text);
    end_offset_ = item.name.offset + item.name.text.size();
    if (item.value.empty() || !with_value) {
        text_ += "{}";
    } else {
        text_ += " =";
        value(item.value);
    }
}

void CppWriter::constants(const Global& global, bool as_static) {
    for (const Declarator& item : global.declarators) {
        if (item.value.empty())
            throw notPortable(item.name, fmt::format("constant '{}' without value", item.name.text));
        declarator(as_static ? "static constexpr " : "", global.type, item);
        text_ += ";";
    }
}

void CppWriter::stateMember(const Global& global, const Declarator& item) {
    declarator("", global.type, item, true, false);
    text_ += ";";
}

void CppWriter::assignment(const Declarator& item) {
    put(item.name, cppName(item.name.text) + " =");
    value(item.value);
    text_ += ";";
}

void CppWriter::function(const Function& function, std::string_view before, std::string_view after,
                         std::span<const Declarator> first) {
    const std::string result = typeText(function.type, function.returns_array, function.type_array);
    put(function.type, fmt::format("{}{} {}(", before, result, cppName(function.name.text)));
    for (std::size_t i = 0; i < function.parameters.size(); ++i) {
        const Function::Parameter& parameter = function.parameters[i];
        const Declarator& item = parameter.declarator;
        std::string qualified = typeText(parameter.type, item.is_array, item.array);
        for (const Token& qualifier : parameter.qualifiers) {
            if (qualifier.text == "out" || qualifier.text == "inout")
                qualified += "&";
            else if (qualifier.text == "const")
                qualified = fmt::format("const {}", qualified);
            else if (qualifier.text != "in")
                throw notPortable(qualifier, fmt::format("qualifier '{}'", qualifier.text));
        }
        text_ += fmt::format("{}{} {}", i > 0 ? ", " : "", qualified, cppName(item.name.text));
    }
    text_ += fmt::format("){} ", after);
    put(function.body.front(), "{");
    for (const Declarator& item : first) assignment(item);
    tokens(function.body.subspan(1));
}

void CppWriter::tokens(std::span<const Token> range) {
    for (std::size_t i = 0; i < range.size();) {
        const Token& token = range[i];
        if (token.kind == TokenKind::float_literal) {
            put(token, literal(token));
            ++i;
        } else if (token.kind == TokenKind::identifier) {
            i = identifier(range, i);
        } else if (token.text == ".") {
            i = field(range, i);
        } else if (token.text == "^^") {
            throw notPortable(token, "operator ^^", "write a != b");
        } else {
            if (token.text == "(" || token.text == "[") ++parentheses_;
            if (token.text == ")" || token.text == "]") --parentheses_;
            put(token, token.text);
            ++i;
        }
    }
}

std::size_t CppWriter::identifier(std::span<const Token> range, std::size_t i) {
    const Token& token = range[i];
    const std::string_view next = i + 1 < range.size() ? range[i + 1].text : std::string_view{};
    if (token.text == "const") {
        const_ = true;
        return i + 1;
    }
    if (!cppType(token.text).empty()) return type(range, i);
    if (isStatementWord(token.text)) {
        put(token, token.text);
        return i + 1;
    }
    if (isGlslKeyword(token.text)) throw notPortable(token, fmt::format("'{}'", token.text));
    if (i + 1 < range.size() && range[i + 1].kind == TokenKind::identifier)
        throw notPortable(token, fmt::format("type '{}'", token.text), "structs are not in it");
    if (next == "(" && !functions_.contains(token.text))
        throw notPortable(token, fmt::format("function '{}'", token.text),
                          "it is neither the model's own, nor in physics/, nor a function of the subset");
    used_.insert(std::string(token.text));
    put(token, cppName(token.text));
    return i + 1;
}

// A type starts a declaration, or is a constructor: float(x), float[3](a, b, c).
std::size_t CppWriter::type(std::span<const Token> range, std::size_t i) {
    const Token& name = range[i++];
    const bool is_array = i < range.size() && range[i].text == "[";
    std::span<const Token> size;
    if (is_array) {
        const std::size_t close = closingBracket(range, i);
        size = range.subspan(i + 1, close - i - 1);
        i = close + 1;
    }
    if (i < range.size() && range[i].kind == TokenKind::identifier) return declaration(range, i, name, size, is_array);
    if (i >= range.size() || range[i].text != "(") throw notPortable(name, fmt::format("'{}' here", name.text));
    const std::string cpp = typeText(name, false, {});
    put(name, is_array ? fmt::format("glsl::arrayOf<{}>", cpp) : cpp);
    end_offset_ = range[i].offset;
    return i;
}

// range[i] is the first name. Each declarator becomes a statement of its own, except in for (...). Stops at what ends
// the declaration.
std::size_t CppWriter::declaration(std::span<const Token> range, std::size_t i, const Token& type,
                                   std::span<const Token> type_array, bool is_array) {
    if (in_value_) throw notPortable(type, "a declaration inside an expression");
    const std::string lead = const_ ? "const " : "";
    const_ = false;
    const bool in_parentheses = parentheses_ > 0;
    for (bool first = true;; first = false) {
        Declarator item{range[i], type_array, is_array, {}};
        if (item.name.kind != TokenKind::identifier) throw notPortable(item.name, "a declaration without a name");
        ++i;
        if (i < range.size() && range[i].text == "[") {
            const std::size_t close = closingBracket(range, i);
            item.is_array = true;
            item.array = range.subspan(i + 1, close - i - 1);
            i = close + 1;
        }
        if (i < range.size() && range[i].text == "=") {
            const std::size_t begin = ++i;
            while (i < range.size() && range[i].text != "," && range[i].text != ";" && range[i].text != ")")
                i = isOpening(range[i].text) ? closingBracket(range, i) + 1 : i + 1;
            item.value = range.subspan(begin, i - begin);
        }
        if (in_parentheses && item.is_array) throw notPortable(item.name, "an array declared inside ( )");
        const bool continues = !first && in_parentheses;
        declarator(continues ? ", " : lead, type, item, !continues);
        const bool ends = i >= range.size() || range[i].text == ";" || (in_parentheses && range[i].text == ")");
        if (ends) return i;
        if (range[i].text != ",") throw notPortable(range[i], "this declaration", "expected TYPE NAME = VALUE;");
        if (!in_parentheses) text_ += ";";
        if (++i >= range.size()) return i;
    }
}

// ".x" becomes [0], ".zyx" a call; ".length()" stays.
std::size_t CppWriter::field(std::span<const Token> range, std::size_t i) {
    const Token& dot = range[i];
    if (i + 1 >= range.size()) throw notPortable(dot, "'.' at the end");
    const Token& name = range[i + 1];
    const std::string_view next = i + 2 < range.size() ? range[i + 2].text : std::string_view{};
    if (name.text == "length" && next == "(") {
        put(dot, ".length");
        end_offset_ = range[i + 2].offset;
        return i + 2;
    }
    const std::vector<int> components = swizzle(name.text);
    if (components.empty()) throw notPortable(name, fmt::format("field '.{}'", name.text), "structs are not in it");
    if (components.size() == 1) {
        put(dot, fmt::format("[{}]", components[0]));
    } else {
        if (isAssignment(next))
            throw notPortable(name, fmt::format("writing to the swizzle '.{}'", name.text),
                              "write one component at a time, or the whole vector");
        put(dot, fmt::format(".template swizzle<{}>()", fmt::join(components, ", ")));
    }
    end_offset_ = name.offset + name.text.size();
    return i + 2;
}

}  // namespace searchlight
