#include "language/parameter_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/error.h"
#include "base/text.h"
#include "language/glsl_names.h"

namespace searchlight {

namespace {

Error errorAt(const Word& word, std::string message, std::string hint = {}) {
    return inputError(std::move(message), std::move(hint)).at({}, word.line, word.column);
}

bool isIdentifier(std::string_view text) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
    const auto inner = [&](char c) { return letter(c) || (c >= '0' && c <= '9'); };
    return !text.empty() && letter(text[0]) && std::ranges::all_of(text, inner);
}

SourceLine cut(const SourceLine& line, std::size_t begin, std::size_t end) {
    const std::string_view part = line.text.substr(begin, end - begin);
    const std::size_t blank = std::min(part.find_first_not_of(" \t"), part.size());
    return {trim(part), line.line, line.column + static_cast<int>(begin + blank)};
}

class ParameterLine {
public:
    explicit ParameterLine(const SourceLine& line) : line_(line) {
        std::size_t end = line.text.size();
        if (const std::size_t hash = line.text.find('#'); hash != std::string_view::npos) {
            param_.doc = trim(line.text.substr(hash + 1));
            end = hash;
        }
        if (const std::size_t open = line.text.substr(0, end).find('['); open != std::string_view::npos) {
            readUnit(cut(line, open, end));
            end = open;
        }
        words_ = words(cut(line, 0, end));
        if (words_.empty()) throw errorAt(line, "a unit without a parameter");
    }

    Param read() {
        const Word& type = words_[0];
        if (type.text == "float")
            readFloat();
        else if (type.text == "bool")
            readBool();
        else if (type.text == "color")
            readColor();
        else if (type.text == "choice")
            readChoice();
        else
            throw unknownName(ErrorKind::input, "parameter type", type.text, {"float", "bool", "color", "choice"})
                .at({}, type.line, type.column);
        return std::move(param_);
    }

    const Word& name() const { return words_[1]; }

private:
    void readUnit(const SourceLine& text) {
        const std::size_t close = text.text.find(']');
        if (close == std::string_view::npos) throw errorAt(text, "this unit never ends", "expected ']'");
        if (close + 1 < text.text.size())
            throw errorAt(cut(text, close + 1, text.text.size()), "text after the unit", "a comment starts with #");
        param_.unit = trim(text.text.substr(1, close - 1));
        if (param_.unit.empty()) throw errorAt(text, "empty unit", "leave [] out for a number without unit");
    }

    // Checks the number of words and the name, which every kind of line has.
    void readName(std::size_t least, std::size_t most, const char* form) {
        if (words_.size() < least)
            throw inputError("the line ends early", fmt::format("expected {}", form))
                .at({}, line_.line, words_.back().column + static_cast<int>(words_.back().text.size()));
        if (words_.size() > most)
            throw errorAt(words_[most], fmt::format("unexpected '{}'", words_[most].text),
                          fmt::format("expected {}", form));
        if (!isIdentifier(name().text))
            throw errorAt(name(), fmt::format("'{}' cannot be a name", name().text),
                          "letters, digits and _, not starting with a digit");
        if (const std::string why = whyReserved(name().text); !why.empty())
            throw errorAt(name(), fmt::format("a parameter cannot be called '{}'", name().text), why);
        param_.name = name().text;
    }

    double number(std::size_t index) const {
        const std::optional<double> value = parseNumber(words_[index].text);
        if (!value) throw errorAt(words_[index], fmt::format("'{}' is no finite number", words_[index].text));
        return *value;
    }

    void readFloat() {
        readName(5, 5, "float NAME MIN MAX DEFAULT");
        param_.type = ParamType::number;
        param_.min = number(2);
        param_.max = number(3);
        const double value = number(4);
        if (param_.min >= param_.max)
            throw errorAt(words_[2], fmt::format("the range {} to {} is empty", words_[2].text, words_[3].text),
                          "expected MIN below MAX");
        if (value < param_.min || value > param_.max)
            throw errorAt(words_[4], fmt::format("the default {} is outside {} to {}", words_[4].text, words_[2].text,
                                                 words_[3].text));
        param_.value = value;
    }

    void readBool() {
        readName(3, 3, "bool NAME 0|1|false|true");
        param_.type = ParamType::toggle;
        const std::string_view text = words_[2].text;
        if (text != "0" && text != "1" && text != "false" && text != "true")
            throw errorAt(words_[2], fmt::format("'{}' is no bool", text), "expected 0, 1, false or true");
        param_.value = text == "1" || text == "true";
    }

    void readColor() {
        readName(5, 5, "color NAME RED GREEN BLUE");
        param_.type = ParamType::color;
        param_.max = 1e30;  // colours weigh as well as tint: no upper end
        Rgb value;
        for (int channel = 0; channel < 3; ++channel) {
            const std::size_t index = 2 + static_cast<std::size_t>(channel);
            value[channel] = number(index);
            if (value[channel] < 0 || value[channel] > param_.max)
                throw errorAt(words_[index], fmt::format("the colour {} is outside 0 to 1e30", words_[index].text));
        }
        param_.value = value;
    }

    void readChoice() {
        readName(3, 4, "choice NAME A|B|C [DEFAULT]");
        param_.type = ParamType::choice;
        int column = words_[2].column;
        for (const std::string_view part : split(words_[2].text, '|')) {
            const Word word{part, line_.line, column};
            column += static_cast<int>(part.size()) + 1;
            if (!isIdentifier(part))
                throw errorAt(word, fmt::format("'{}' cannot name a choice", part),
                              "letters, digits and _, separated by | without blanks");
            if (std::ranges::find(param_.choices, part) != param_.choices.end())
                throw errorAt(word, fmt::format("choice '{}' is named twice", part));
            if (const std::string constant = fmt::format("{}_{}", param_.name, part);
                constant.find("__") != std::string::npos)
                throw errorAt(word, fmt::format("the constant of this choice would be called '{}'", constant),
                              "GLSL keeps names with two underscores");
            param_.choices.emplace_back(part);
        }
        if (param_.choices.size() < 2) throw errorAt(words_[2], "a choice needs two names or more");
        if (words_.size() == 4 && std::ranges::find(param_.choices, words_[3].text) == param_.choices.end())
            throw unknownName(ErrorKind::input, "choice", words_[3].text, param_.choices)
                .at({}, line_.line, words_[3].column);
        param_.value = words_.size() == 4 ? std::string(words_[3].text) : param_.choices.front();
    }

    SourceLine line_;
    std::vector<Word> words_;
    Param param_;
};

}  // namespace

std::vector<Word> words(const SourceLine& line) {
    std::vector<Word> found;
    for (std::size_t at = 0; (at = line.text.find_first_not_of(" \t", at)) != std::string_view::npos;) {
        const std::size_t end = std::min(line.text.find_first_of(" \t", at), line.text.size());
        found.push_back({line.text.substr(at, end - at), line.line, line.column + static_cast<int>(at)});
        at = end;
    }
    return found;
}

std::vector<Param> parseParameters(const std::vector<SourceLine>& lines) {
    std::vector<Param> params;
    std::map<std::string, int, std::less<>> line_of;  // of parameters, and of the constants of their choices
    for (const SourceLine& line : lines) {
        if (line.text.empty() || line.text.starts_with('#')) continue;
        ParameterLine reader(line);
        Param param = reader.read();
        std::vector<std::string> names = {param.name};
        for (const std::string& choice : param.choices) names.push_back(param.name + "_" + choice);
        for (const std::string& name : names)
            if (const auto [earlier, fresh] = line_of.try_emplace(name, line.line); !fresh)
                throw errorAt(reader.name(), fmt::format("'{}' is already declared on line {}", name, earlier->second));
        params.push_back(std::move(param));
    }
    return params;
}

}  // namespace searchlight
