#include "draw/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "draw/drawing.h"
#include "draw/false_color.h"
#include "draw/plot_area.h"
#include "draw/svg.h"
#include "draw/text_width.h"
#ifdef SEARCHLIGHT_QT
#include "draw/paint_qt.h"
#endif

namespace searchlight {

namespace {

constexpr double margin = 16, gap = 6;  // px, around the sheet and between pictures
constexpr double title_size = 14, heading_size = 12, note_size = 10, caption_size = 11;
constexpr double title_line = 19, heading_line = 15, note_line = 14, caption_line = 15;
constexpr double bar_gap = 14, longest_bar = 300;
constexpr double widest_heading = 150;  // of a row: longer ones are broken
constexpr std::string_view soft_ink = "#4d4d4d";

using Lines = std::vector<std::string>;

// A name may be one long word, as ids are: it is broken behind an underscore or a comma where it must be.
Lines headingLines(const std::string& heading, double width) {
    std::string breakable;
    for (const char c : heading) {
        breakable += c;
        if (c == '_' && textWidth(heading, heading_size) > width) breakable += ' ';
    }
    Lines lines = wrapText(breakable, width, heading_size);
    for (std::string& line : lines)
        for (std::size_t at = 0; (at = line.find("_ ", at)) != std::string::npos;) line.erase(at + 1, 1);
    return lines;
}

struct Headings {
    std::vector<Lines> lines;
    std::size_t most = 0;  ///< lines of one
    double width = 0;      ///< px of the widest line
};

Headings headingsOf(const std::vector<std::string>& texts, double width) {
    Headings headings;
    for (const std::string& text : texts) {
        headings.lines.push_back(headingLines(text, width));
        headings.most = std::max(headings.most, headings.lines.back().size());
        for (const std::string& line : headings.lines.back())
            headings.width = std::max(headings.width, textWidth(line, heading_size));
    }
    return headings;
}

void drawLines(std::vector<Shape>& shapes, const Lines& lines, Point first, double step, double size, Anchor anchor,
               std::string_view color, bool bold = false) {
    for (const std::string& line : lines) {
        shapes.push_back(Text{first, line, size, anchor, color, bold});
        first.y += step;
    }
}

Drawing layoutSheet(const ContactSheet& sheet) {
    assert(sheet.cells.size() == sheet.rows.size() * sheet.columns.size());
    const double width = sheet.picture_width, height = sheet.picture_height;
    const bool noted = std::ranges::any_of(sheet.cells, [](const SheetCell& cell) { return !cell.note.empty(); });
    const double step_x = width + gap, step_y = height + gap + (noted ? note_line : 0);
    const auto columns = static_cast<double>(sheet.columns.size()), rows = static_cast<double>(sheet.rows.size());
    const Headings column_heads = headingsOf(sheet.columns, width);
    const Headings row_heads = headingsOf(sheet.rows, widest_heading);

    const double titles = sheet.row_title.empty() ? 0 : heading_line + 4;
    const double left = std::ceil(margin + titles + (row_heads.width > 0 ? row_heads.width + 10 : 0));
    Drawing drawing;
    const double right = left + columns * step_x - gap;
    drawing.width = std::max(right + (sheet.color ? bar_gap + colorBarWidth(*sheet.color) : 0) + margin, 320.0);
    const Lines title = wrapText(sheet.title, drawing.width - 2 * margin, title_size, true);
    const Lines caption = wrapText(sheet.caption, drawing.width - 2 * margin, caption_size);
    const double column_title = margin + title_line * static_cast<double>(title.size());
    const double heads = column_title + (sheet.column_title.empty() ? 0 : heading_line + 3);
    const double top = std::ceil(heads + heading_line * static_cast<double>(column_heads.most) + 6);
    const double bottom = top + rows * step_y - gap;
    drawing.height =
        std::ceil(bottom + (caption.empty() ? 0 : 8 + caption_line * static_cast<double>(caption.size())) + margin);

    std::vector<Shape>& shapes = drawing.shapes;
    shapes.push_back(Box{{0, 0, drawing.width, drawing.height}, "#ffffff"});
    drawLines(shapes, title, {margin, margin + title_size - 3}, title_line, title_size, Anchor::start, ink, true);
    const double middle = left + 0.5 * (columns * step_x - gap);
    if (!sheet.column_title.empty())
        shapes.push_back(
            Text{{middle, column_title + heading_size}, sheet.column_title, heading_size, Anchor::middle, soft_ink});
    if (!sheet.row_title.empty())
        shapes.push_back(Text{{margin + heading_size - 2, 0.5 * (top + bottom)},
                              sheet.row_title,
                              heading_size,
                              Anchor::middle,
                              soft_ink,
                              false,
                              true});
    for (std::size_t column = 0; column < sheet.columns.size(); ++column) {
        const Lines& lines = column_heads.lines[column];
        // Short headings stand on the pictures, not below the title.
        const double base = top - 7 - heading_line * (static_cast<double>(lines.size()) - 1);
        drawLines(shapes, lines, {left + static_cast<double>(column) * step_x + 0.5 * width, base}, heading_line,
                  heading_size, Anchor::middle, ink);
    }
    for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
        const Lines& lines = row_heads.lines[row];
        const double base = top + static_cast<double>(row) * step_y + 0.5 * height + 0.35 * heading_size -
                            0.5 * heading_line * (static_cast<double>(lines.size()) - 1);
        drawLines(shapes, lines, {left - 10, base}, heading_line, heading_size, Anchor::end, ink);
    }
    for (std::size_t i = 0; i < sheet.cells.size(); ++i) {
        const double x = left + static_cast<double>(i % sheet.columns.size()) * step_x;
        const double y = top + static_cast<double>(i / sheet.columns.size()) * step_y;
        if (!sheet.cells[i].png.empty()) shapes.push_back(Picture{{x, y, x + width, y + height}, sheet.cells[i].png});
        if (!sheet.cells[i].note.empty())
            shapes.push_back(
                Text{{x + 0.5 * width, y + height + 11}, sheet.cells[i].note, note_size, Anchor::middle, soft_ink});
    }
    if (sheet.color)
        drawColorBar(shapes, *sheet.color, {right + bar_gap, top, drawing.width, std::min(bottom, top + longest_bar)});
    drawLines(shapes, caption, {margin, bottom + 8 + caption_size}, caption_line, caption_size, Anchor::start,
              soft_ink);
    return drawing;
}

// What the writers of figures take a document's title and metadata from.
Figure documentOf(const ContactSheet& sheet) {
    Figure figure;
    figure.title = sheet.title;
    figure.caption = sheet.caption;
    figure.metadata = sheet.metadata;
    return figure;
}

struct Format {
    std::string_view ending;
    std::string (*write)(const ContactSheet&);
};

constexpr Format formats[] = {
#ifdef SEARCHLIGHT_QT
    {".png", [](const ContactSheet& sheet) { return drawingBitmap(layoutSheet(sheet), documentOf(sheet), "PNG"); }},
    {".jpg", [](const ContactSheet& sheet) { return drawingBitmap(layoutSheet(sheet), documentOf(sheet), "JPG"); }},
#endif
    {".svg", sheetSvg},
};

}  // namespace

std::string sheetElement(const ContactSheet& sheet) { return svgElement(layoutSheet(sheet), documentOf(sheet)); }

std::string sheetSvg(const ContactSheet& sheet) {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + sheetElement(sheet);
}

std::vector<std::string> sheetFormats() {
    std::vector<std::string> endings;
    for (const Format& format : formats) endings.emplace_back(format.ending);
    return endings;
}

void drawSheet(const ContactSheet& sheet, const std::filesystem::path& path) {
    const std::string ending = path.extension().string();
    const auto format = std::ranges::find(formats, ending, &Format::ending);
    if (format == std::end(formats))
        throw usageError(fmt::format("a contact sheet cannot be written as '{}'", ending),
                         "this build writes " + join(sheetFormats(), ", "))
            .at(path.string());
    writeFile(path, format->write(sheet));
}

}  // namespace searchlight
