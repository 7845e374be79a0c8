// Writes tokens of the portable GLSL subset as C++, line by line where they came from.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"
#include "language/outline.h"

namespace searchlight {

/// The input Error "not in the portable subset: WHAT" at a token's place.
Error notPortable(const Token& token, const std::string& what, std::string hint = {});

/// The C++ spelling of a GLSL identifier: words that C++ or the generated code keeps get a suffix.
std::string cppName(std::string_view name);

class CppWriter {
public:
    /// `functions` may be called.
    explicit CppWriter(const std::set<std::string, std::less<>>& functions) : functions_(functions) {}

    /// The next tokens stand in `path`: compiler messages name it and the line.
    void enterFile(std::string_view path);

    /// A line of the generator's own, at the depth of members.
    void line(std::string_view text);

    /// "static constexpr Real name = value;" for each declarator; without static, plain members.
    void constants(const Global& global, bool as_static);

    /// "Real name{};": State, without its initial value.
    void stateMember(const Global& global, const Declarator& declarator);

    /// "name = value;"
    void assignment(const Declarator& declarator);

    /// The function with its body. `before` goes before it ("static "), `after` behind its parameters (" const");
    /// declarators in `first` are assigned at the start of the body.
    void function(const Function& function, std::string_view before, std::string_view after,
                  std::span<const Declarator> first = {});

    const std::string& text() const { return text_; }

    /// Identifiers written so far that are neither types nor keywords.
    const std::set<std::string, std::less<>>& used() const { return used_; }

private:
    void place(const Token& token);
    void put(const Token& token, std::string_view text);
    void tokens(std::span<const Token> range);
    std::size_t identifier(std::span<const Token> range, std::size_t i);
    std::size_t type(std::span<const Token> range, std::size_t i);
    std::size_t declaration(std::span<const Token> range, std::size_t i, const Token& type,
                            std::span<const Token> type_array, bool is_array);
    std::size_t field(std::span<const Token> range, std::size_t i);
    std::string typeText(const Token& type, bool is_array, std::span<const Token> array,
                         std::span<const Token> value = {});
    std::string expression(std::span<const Token> range);
    void value(std::span<const Token> range);
    void declarator(std::string_view lead, const Token& type, const Declarator& item, bool with_type = true,
                    bool with_value = true);

    const std::set<std::string, std::less<>>& functions_;
    std::set<std::string, std::less<>> used_;
    std::string text_;
    std::string path_;
    int line_ = 0;                // of path_, that the text stands on; 0: somewhere else
    std::size_t end_offset_ = 0;  // of the last token, to keep blanks as they were
    int parentheses_ = 0;
    bool const_ = false;     // the declaration being read has the qualifier const
    bool in_value_ = false;  // inside an initial value or an array size, where nothing is declared
};

}  // namespace searchlight
