#include "language/bssrdf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "base/error.h"
#include "base/text.h"
#include "language/outline.h"
#include "language/parameter_lines.h"
#include "language/text_lines.h"

namespace searchlight {

namespace {

// Far above any model (the largest shipped one has 8 kB), far below what would take time.
constexpr std::size_t max_bytes = std::size_t{1} << 20;

Error errorAt(const Word& word, std::string message, std::string hint = {}) {
    return inputError(std::move(message), std::move(hint)).at({}, word.line, word.column);
}

bool isBlank(const SourceLine& line) { return line.text.empty() || line.text.starts_with('#'); }

/// What stands between ::begin and ::end.
struct RawSection {
    Word name;
    std::size_t first = 0, last = 0;  // lines [first, last)
};

class BssrdfParser {
public:
    BssrdfParser(std::string_view text, std::string_view path) {
        file_.path = path;
        file_.title = stem(path);
        text_ = normalizeText(text, max_bytes);
        lines_ = splitLines(text_);
    }

    BssrdfFile run() {
        std::size_t at = readAttributes();
        while (at < lines_.size()) at = readSection(at);
        if (!file_.shader.present()) throw missingShader();
        return std::move(file_);
    }

private:
    static std::string stem(std::string_view path) {
        path.remove_prefix(path.find_last_of("/\\") == std::string_view::npos ? 0 : path.find_last_of("/\\") + 1);
        return std::string(path.substr(0, path.rfind('.')));
    }

    std::size_t readAttributes() {
        std::size_t at = 0;
        while (at < lines_.size() && isBlank(lines_[at])) {
            if (lines_[at].text.starts_with("# BSSRDF file format"))
                throw errorAt(lines_[at], fmt::format("this is another tool's format, '{}'", lines_[at].text.substr(2)),
                              "a Searchlight model starts with a line 'analytic ...'");
            ++at;
        }
        if (at == lines_.size())
            throw inputError("the file holds no model", "expected a first line 'analytic ...'").at({}, 1, 1);
        SourceLine line = lines_[at];
        line.text = trim(line.text.substr(0, line.text.find('#')));
        for (const Word& word : words(line)) readAttribute(word);
        return at + 1;
    }

    void readAttribute(const Word& word) {
        static const std::vector<std::pair<std::string, bool BssrdfFile::*>> flags = {
            {"radial", &BssrdfFile::radial},
            {"no_wi", &BssrdfFile::no_wi},
            {"no_wo", &BssrdfFile::no_wo},
            {"normals", &BssrdfFile::normals},
            {"single_scattering", &BssrdfFile::single_scattering},
            {"reciprocal", &BssrdfFile::reciprocal},
            {"energy_violation", &BssrdfFile::energy_violation},
            {"grosjean", &BssrdfFile::grosjean}};
        if (file_.attributes.empty() && word.text != "analytic")
            throw errorAt(word, fmt::format("'{}' found where 'analytic' was expected", word.text.substr(0, 40)),
                          "the first line lists the model's attributes");
        if (std::ranges::find(file_.attributes, word.text) != file_.attributes.end())
            throw errorAt(word, fmt::format("attribute '{}' is given twice", word.text));
        file_.attributes.emplace_back(word.text);
        if (word.text == "analytic") return;
        std::vector<std::string> valid = {"analytic"};
        for (const auto& [name, flag] : flags) {
            if (name == word.text) {
                file_.*flag = true;
                return;
            }
            valid.push_back(name);
        }
        throw unknownName(ErrorKind::input, "attribute", word.text, valid).at({}, word.line, word.column);
    }

    static bool isMarker(const SourceLine& line) { return line.text.starts_with("::"); }

    // "::begin NAME" and "::end NAME"; the listing of the thesis has blanks after the colons.
    static std::pair<Word, Word> readMarker(const SourceLine& line) {
        SourceLine rest = line;
        rest.text.remove_prefix(2);
        rest.column += 2;
        const std::vector<Word> found = words(rest);
        if (found.empty() || (found[0].text != "begin" && found[0].text != "end"))
            throw errorAt(line, fmt::format("'{}' found where ::begin or ::end was expected", line.text.substr(0, 40)));
        if (found.size() < 2) throw errorAt(line, fmt::format("::{} without the section's name", found[0].text));
        if (found.size() > 2 && !found[2].text.starts_with('#'))
            throw errorAt(found[2], fmt::format("unexpected '{}' after the section's name", found[2].text));
        return {found[0], found[1]};
    }

    std::size_t readSection(std::size_t at) {
        const SourceLine& line = lines_[at];
        if (isBlank(line)) return at + 1;
        if (!isMarker(line))
            throw errorAt(line, fmt::format("'{}' stands outside a section", line.text.substr(0, 40)),
                          "expected ::begin NAME, or a comment that starts with #");
        const auto [keyword, name] = readMarker(line);
        if (keyword.text == "end")
            throw errorAt(line, fmt::format("::end {} without a ::begin {}", name.text, name.text));
        const std::size_t first = at + 1;
        for (at = first; at < lines_.size(); ++at) {
            if (!isMarker(lines_[at])) continue;
            const auto [inner_keyword, inner_name] = readMarker(lines_[at]);
            if (inner_keyword.text == "begin")
                throw errorAt(lines_[at],
                              fmt::format("::begin {} inside section {}, which began on line {}", inner_name.text,
                                          name.text, name.line),
                              fmt::format("expected ::end {} first", name.text));
            if (inner_name.text != name.text)
                throw errorAt(inner_name,
                              fmt::format("::end {} ends section {}, which began on line {}", inner_name.text,
                                          name.text, name.line),
                              fmt::format("expected ::end {}", name.text));
            takeSection({name, first, at});
            return at + 1;
        }
        throw errorAt(line, fmt::format("section {} never ends", name.text),
                      fmt::format("expected ::end {}", name.text));
    }

    void takeSection(const RawSection& section) {
        const auto [earlier, fresh] = section_lines_.try_emplace(std::string(section.name.text), section.name.line);
        if (!fresh)
            throw errorAt(section.name,
                          fmt::format("section {} is already on line {}", section.name.text, earlier->second));
        const std::string_view name = section.name.text;
        if (name == "info")
            for (std::size_t i = section.first; i < section.last; ++i) readInfo(lines_[i]);
        else if (name == "parameters")
            file_.parameters = parseParameters({lines_.begin() + static_cast<std::ptrdiff_t>(section.first),
                                                lines_.begin() + static_cast<std::ptrdiff_t>(section.last)});
        else if (name == "initializer")
            file_.initializer = readGlsl(section, "void", "init", "", 0);
        else if (name == "diffuseReflectance")
            file_.diffuse_reflectance = readGlsl(section, "vec3", "DiffuseReflectance", "vec3 AlphaPrime", 1);
        else if (name == "shader")
            file_.shader = readGlsl(section, "vec3", "Bssrdf", "vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo", 4);
    }

    void readInfo(const SourceLine& line) {
        if (isBlank(line)) return;
        const std::map<std::string, std::string*, std::less<>> fields = {{"title", &info_title_},
                                                                         {"citation", &file_.citation},
                                                                         {"validity", &file_.validity},
                                                                         {"note", &file_.notes}};
        const Word key = words(line).front();
        const auto field = fields.find(key.text);
        if (field == fields.end())
            throw unknownName(ErrorKind::input, "info", key.text, {"title", "citation", "validity", "note"})
                .at({}, key.line, key.column);
        const std::string_view value = trim(line.text.substr(key.text.size()));
        if (value.empty()) throw errorAt(key, fmt::format("'{}' without text", key.text));
        if (!field->second->empty()) *field->second += ' ';
        *field->second += value;
        if (!info_title_.empty()) file_.title = info_title_;
    }

    BssrdfSection readGlsl(const RawSection& raw, std::string_view type, std::string_view name,
                           std::string_view parameters, std::size_t count) const {
        BssrdfSection section;
        section.first_line = raw.name.line + 1;
        // A line's text is trimmed: take the raw lines, so that columns stay.
        if (raw.first < raw.last) {
            const std::size_t begin = lineStart(raw.first);
            section.text = text_.substr(begin, lineStart(raw.last) - begin);
        }
        const std::vector<Token> tokens = tokenize(section.text, section.first_line);
        const Outline found = outline(tokens);
        const std::string expected = fmt::format("expected {} {}({})", type, name, parameters);
        const Function* function = found.find(name);
        if (!function)
            throw errorAt(raw.name, fmt::format("section {} has no function {}", raw.name.text, name), expected);
        const auto is_vec3 = [](const Function::Parameter& parameter) {
            return parameter.type.text == "vec3" && !parameter.declarator.is_array &&
                   std::ranges::all_of(parameter.qualifiers,
                                       [](const Token& token) { return token.text == "in" || token.text == "const"; });
        };
        if (function->type.text != type || function->returns_array || function->parameters.size() != count ||
            !std::ranges::all_of(function->parameters, is_vec3))
            throw inputError(fmt::format("{} has another signature", name), expected)
                .at({}, function->name.line, function->name.column);
        return section;
    }

    std::size_t lineStart(std::size_t line) const {
        return line < lines_.size() ? static_cast<std::size_t>(lines_[line].text.data() - text_.data()) -
                                          static_cast<std::size_t>(lines_[line].column - 1)
                                    : text_.size();
    }

    Error missingShader() const {
        std::vector<std::string> found;
        for (const auto& [name, line] : section_lines_) found.push_back(name);
        return inputError("the model has no section shader",
                          found.empty() ? "the file has no sections" : "sections found: " + join(found, ", "))
            .at({}, static_cast<int>(lines_.size()), 1);
    }

    std::string text_;
    std::vector<SourceLine> lines_;
    std::map<std::string, int> section_lines_;
    std::string info_title_;
    BssrdfFile file_;
};

}  // namespace

BssrdfFile parseBssrdf(std::string_view text, std::string_view path) {
    try {
        return BssrdfParser(text, path).run();
    } catch (const Error& error) {
        throw error.at(path);
    }
}

}  // namespace searchlight
