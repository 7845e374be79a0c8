// Tables as text: a header row, '#' comments, and "# key: value" lines as metadata.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace searchlight {

struct CsvCell {
    std::string text;  ///< without quotes and surrounding blanks
    int line = 0;      ///< 1-based, in the file
    int column = 0;    ///< 1-based, in bytes
};

struct CsvTable {
    std::string path;                                           ///< for messages
    std::vector<std::pair<std::string, std::string>> metadata;  ///< of "# key: value" lines, key in lower_snake_case
    std::vector<CsvCell> header;
    std::vector<std::vector<CsvCell>> rows;  ///< each as long as the header

    /// The value of a metadata line; empty when there is none.
    std::string_view meta(std::string_view key) const;

    /// Index of the column of that name.
    std::optional<std::size_t> find(std::string_view column) const;

    /// The cell as a finite number. Throws an input Error at the cell.
    double number(std::size_t row, std::size_t column) const;
};

/// Parses comma-separated text: double quotes around a field ("" inside is one quote), CRLF, a byte order mark, empty
/// lines. Throws an input Error with file, line and column.
CsvTable parseCsv(std::string_view text, std::string_view path);

}  // namespace searchlight
