#include "base/csv.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"

namespace searchlight {

namespace {

// The fields of one line. Blanks around a field do not count; blanks inside quotes do.
std::vector<CsvCell> parseLine(std::string_view line, int number) {
    constexpr std::string_view blanks = " \t";
    std::vector<CsvCell> cells;
    for (std::size_t at = 0;; ++at) {
        at = std::min(line.find_first_not_of(blanks, at), line.size());
        CsvCell cell{{}, number, static_cast<int>(at) + 1};
        if (at < line.size() && line[at] == '"') {
            for (++at;; ++at) {
                if (at >= line.size())
                    throw inputError("quoted field does not end on its line", "close it with \"")
                        .at({}, number, cell.column);
                if (line[at] != '"')
                    cell.text += line[at];
                else if (at + 1 < line.size() && line[at + 1] == '"')
                    cell.text += line[at++];
                else
                    break;
            }
            at = std::min(line.find_first_not_of(blanks, at + 1), line.size());
            if (at < line.size() && line[at] != ',')
                throw inputError("text after the closing quote", "expected a comma or the end of the line")
                    .at({}, number, static_cast<int>(at) + 1);
        } else {
            const std::size_t end = std::min(line.find(',', at), line.size());
            cell.text = trim(line.substr(at, end - at));
            at = end;
        }
        cells.push_back(std::move(cell));
        if (at == line.size()) return cells;
    }
}

void parseComment(std::string_view line, int number, CsvTable& table) {
    const std::string_view comment = trim(line.substr(1));
    const std::size_t colon = comment.find(':');
    if (colon == std::string_view::npos) return;
    const std::string_view key = comment.substr(0, colon);
    if (key.empty() || key != lowerSnake(key)) return;  // a sentence that has a colon
    for (const auto& [known, value] : table.metadata)
        if (known == key)
            throw inputError(fmt::format("'{}' is given twice", key))
                .at({}, number, static_cast<int>(line.find(key)) + 1);
    table.metadata.emplace_back(key, trim(comment.substr(colon + 1)));
}

void parseLines(std::string_view text, CsvTable& table) {
    int number = 0;
    for (std::string_view line : split(text, '\n')) {
        ++number;
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (const std::size_t odd = line.find('\0'); odd != std::string_view::npos)
            throw inputError("NUL byte", "expected text").at({}, number, static_cast<int>(odd) + 1);
        if (trim(line).empty()) continue;
        if (line.front() == '#') {
            parseComment(line, number, table);
            continue;
        }
        std::vector<CsvCell> cells = parseLine(line, number);
        if (table.header.empty()) {
            for (const CsvCell& cell : cells) {
                if (cell.text.empty()) throw inputError("column without a name").at({}, number, cell.column);
                if (table.find(cell.text))
                    throw inputError(fmt::format("column '{}' stands twice", cell.text)).at({}, number, cell.column);
                table.header.push_back(cell);
            }
            continue;
        }
        if (cells.size() != table.header.size())
            throw inputError(fmt::format("{} fields, expected {}", cells.size(), table.header.size()),
                             fmt::format("as in the header on line {}", table.header.front().line))
                .at({}, number, cells.size() > table.header.size() ? cells[table.header.size()].column : 1);
        table.rows.push_back(std::move(cells));
    }
    if (table.header.empty()) throw inputError("no header row", "the first line names the columns");
}

}  // namespace

std::string_view CsvTable::meta(std::string_view key) const {
    for (const auto& [known, value] : metadata)
        if (known == key) return value;
    return {};
}

std::optional<std::size_t> CsvTable::find(std::string_view column) const {
    for (std::size_t i = 0; i < header.size(); ++i)
        if (header[i].text == column) return i;
    return std::nullopt;
}

double CsvTable::number(std::size_t row, std::size_t column) const {
    const CsvCell& cell = rows[row][column];
    const std::optional<double> value = parseNumber(cell.text);
    if (!value)
        throw inputError(fmt::format("'{}' is no value for {}", cell.text, header[column].text),
                         "expected a finite number")
            .at(path, cell.line, cell.column);
    return *value;
}

CsvTable parseCsv(std::string_view text, std::string_view path) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    CsvTable table;
    table.path = path;
    try {
        parseLines(text, table);
    } catch (const Error& error) {
        throw error.at(path);
    }
    return table;
}

}  // namespace searchlight
