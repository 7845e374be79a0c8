#include "render/brdf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/error.h"
#include "base/text.h"
#include "language/outline.h"
#include "language/parameter_lines.h"
#include "language/text_lines.h"
#include "language/tokens.h"

namespace searchlight {

namespace {

// As large as a model may be.
constexpr std::size_t max_bytes = std::size_t{1} << 20;

Error errorAt(const Word& word, std::string message, std::string hint = {}) {
    return inputError(std::move(message), std::move(hint)).at({}, word.line, word.column);
}

bool isBlank(const SourceLine& line) { return line.text.empty() || line.text.starts_with('#'); }
bool isMarker(const SourceLine& line) { return line.text.starts_with("::"); }

class BrdfParser {
public:
    BrdfParser(std::string_view text, std::string_view path) {
        file_.path = path;
        text_ = normalizeText(text, max_bytes);
        lines_ = splitLines(text_);
    }

    BrdfFile run() {
        std::size_t at = readFirstLine();
        while (at < lines_.size()) {
            if (isBlank(lines_[at]))
                ++at;
            else
                at = readSection(at);
        }
        if (file_.shader_first_line == 0)
            throw inputError("the file has no section shader", "expected ::begin shader")
                .at({}, static_cast<int>(lines_.size()), 1);
        return std::move(file_);
    }

private:
    std::size_t readFirstLine() {
        std::size_t at = 0;
        while (at < lines_.size() && isBlank(lines_[at])) ++at;
        if (at == lines_.size())
            throw inputError("the file holds no BRDF", "expected a first line 'analytic'").at({}, 1, 1);
        const Word first = words(lines_[at]).front();
        if (first.text != "analytic")
            throw errorAt(first, fmt::format("'{}' found where 'analytic' was expected", first.text.substr(0, 40)),
                          "measured BRDFs are not read");
        return at + 1;
    }

    // "::begin NAME" or "::end NAME", blanks after the colons or not.
    static std::vector<Word> markerWords(const SourceLine& line) {
        SourceLine rest = line;
        rest.text.remove_prefix(2);
        rest.column += 2;
        std::vector<Word> found = words(rest);
        if (found.size() < 2 || (found[0].text != "begin" && found[0].text != "end"))
            throw errorAt(
                line, fmt::format("'{}' found where ::begin NAME or ::end NAME was expected", line.text.substr(0, 40)));
        return found;
    }

    std::size_t readSection(std::size_t begin) {
        if (!isMarker(lines_[begin]))
            throw errorAt(lines_[begin], fmt::format("'{}' stands outside a section", lines_[begin].text.substr(0, 40)),
                          "expected ::begin NAME, or a comment that starts with #");
        const std::vector<Word> opening = markerWords(lines_[begin]);
        const Word name = opening[1];
        if (opening[0].text != "begin")
            throw errorAt(opening[0], fmt::format("::end {} without a ::begin {}", name.text, name.text));
        std::size_t end = begin + 1;
        while (end < lines_.size() && !isMarker(lines_[end])) ++end;
        if (end == lines_.size())
            throw errorAt(lines_[begin], fmt::format("section {} never ends", name.text),
                          fmt::format("expected ::end {}", name.text));
        const std::vector<Word> closing = markerWords(lines_[end]);
        if (closing[0].text != "end" || closing[1].text != name.text)
            throw errorAt(lines_[end], fmt::format("'{}' found where ::end {} was expected",
                                                   lines_[end].text.substr(0, 40), name.text));
        const auto [earlier, fresh] = section_lines_.try_emplace(std::string(name.text), name.line);
        if (!fresh) throw errorAt(name, fmt::format("section {} is already on line {}", name.text, earlier->second));
        const auto place = [&](std::size_t line) { return lines_.begin() + static_cast<std::ptrdiff_t>(line); };
        if (name.text == "parameters") file_.parameters = parseParameters({place(begin + 1), place(end)});
        if (name.text == "shader") readShader(name, begin + 1, end);
        return end + 1;
    }

    void readShader(const Word& name, std::size_t first, std::size_t last) {
        // A line's text is trimmed: take the raw lines, so that columns stay.
        const auto start = [&](std::size_t line) {
            return static_cast<std::size_t>(lines_[line].text.data() - text_.data()) -
                   static_cast<std::size_t>(lines_[line].column - 1);
        };
        file_.shader = text_.substr(start(first), start(last) - start(first));
        file_.shader_first_line = name.line + 1;
        const std::vector<Token> tokens = tokenize(file_.shader, file_.shader_first_line);
        const Outline found = outline(tokens);
        const std::string expected = "expected vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y)";
        const Function* function = found.find("BRDF");
        if (!function) throw errorAt(name, "section shader has no function BRDF", expected);
        const auto is_vec3 = [](const Function::Parameter& parameter) {
            return parameter.type.text == "vec3" && !parameter.declarator.is_array;
        };
        if (function->type.text != "vec3" || function->returns_array || function->parameters.size() != 5 ||
            !std::ranges::all_of(function->parameters, is_vec3))
            throw inputError("BRDF has another signature", expected).at({}, function->name.line, function->name.column);
    }

    std::string text_;
    std::vector<SourceLine> lines_;
    std::map<std::string, int> section_lines_;
    BrdfFile file_;
};

}  // namespace

BrdfFile parseBrdf(std::string_view text, std::string_view path) {
    try {
        return BrdfParser(text, path).run();
    } catch (const Error& error) {
        throw error.at(path);
    }
}

std::vector<ParamValue> brdfValues(const BrdfFile& file, const ParamValues& given) {
    for (const auto& [name, value] : given) findParam(file.parameters, name, fmt::format("parameter of {}", file.path));
    std::vector<ParamValue> values;
    for (const Param& param : file.parameters) {
        const auto found = given.find(param.name);
        values.push_back(found == given.end() ? param.value : parseValue(param, valueText(found->second)));
    }
    return values;
}

}  // namespace searchlight
