// A table of pictures, with a heading for each row and column.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/figure.h"

namespace searchlight {

struct SheetCell {
    std::string png;   ///< the bytes of a PNG file, ready for display; empty: nothing is shown
    std::string note;  ///< in small letters below the picture; may be empty
};

struct ContactSheet {
    std::string title;
    std::string caption;                            ///< what is the same everywhere: exposure, light
    std::string column_title, row_title;            ///< what changes along them: "Model", "Material"; may be empty
    std::vector<std::string> columns, rows;         ///< one heading each
    std::vector<SheetCell> cells;                   ///< row by row, rows.size() * columns.size()
    std::optional<Axis> color;                      ///< the scale of pictures in false colour, drawn beside them
    int picture_width = 240, picture_height = 240;  ///< on the sheet, px; a PNG has two pixels for one
    /// Version, sweep...: written into the file, not drawn.
    std::vector<std::pair<std::string, std::string>> metadata;
};

/// As an <svg> element with the pictures inside, for a page.
std::string sheetElement(const ContactSheet& sheet);

/// As an SVG document with the pictures inside.
std::string sheetSvg(const ContactSheet& sheet);

/// Chooses by ending: .svg; with Qt also .png and .jpg. Throws a usage Error for another ending, naming what this build
/// draws.
void drawSheet(const ContactSheet& sheet, const std::filesystem::path& path);

/// The endings that drawSheet takes in this build, the best for pictures first.
std::vector<std::string> sheetFormats();

}  // namespace searchlight
