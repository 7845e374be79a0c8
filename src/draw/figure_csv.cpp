#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "draw/draw.h"

namespace searchlight {

namespace {

// A field as RFC 4180 wants it.
std::string csvField(std::string_view text) {
    if (text.find_first_of(",\"\r\n#") == std::string_view::npos) return std::string(text);
    std::string field = "\"";
    for (const char c : text) {
        if (c == '"') field += '"';
        field += c;
    }
    return field + '"';
}

// Every line of the text stays a comment.
std::string comment(std::string_view key, std::string_view text) {
    std::string lines;
    for (const std::string_view line : split(text, '\n')) {
        lines += fmt::format("# {}: {}\n", key, trim(line));
        key = "  ";
    }
    return lines;
}

std::string axisComment(std::string_view key, const Axis& axis) {
    constexpr std::string_view names[] = {"linear", "logarithmic", "square root"};
    const std::string unit = axis.unit.empty() ? "" : fmt::format(" [{}]", axis.unit);
    return comment(key, fmt::format("{}{}, shown {}", axis.label, unit, names[static_cast<int>(axis.scale)]));
}

// Rows of one panel: curves over x, maps over x and y.
std::string panelRows(const Figure& panel) {
    std::string rows;
    const std::string name = csvField(panel.title);
    for (const Series& series : panel.series) {
        const bool steps = series.style == SeriesStyle::steps;
        for (size_t i = 0; i < series.y.size(); ++i)
            rows += fmt::format("{},{},{},{},,,{},{},{}\n", name, csvField(series.label), numberText(series.x[i]),
                                steps ? numberText(series.x[i + 1]) : "", numberText(series.y[i]),
                                series.lower.empty() ? "" : numberText(series.lower[i]),
                                series.upper.empty() ? "" : numberText(series.upper[i]));
    }
    if (!panel.map) return rows;
    const FalseColor& map = *panel.map;
    const size_t columns = map.x_edges.size() - 1;
    for (size_t i = 0; i < map.values.size(); ++i) {
        const size_t column = i % columns, row = i / columns;
        const double value = map.values[i], error = map.standard_error.empty() ? 0 : map.standard_error[i];
        rows += fmt::format("{},map,{},{},{},{},{},", name, numberText(map.x_edges[column]),
                            numberText(map.x_edges[column + 1]), numberText(map.y_edges[row]),
                            numberText(map.y_edges[row + 1]), numberText(value));
        rows += map.standard_error.empty()
                    ? ",\n"
                    : fmt::format("{},{}\n", numberText(value - error), numberText(value + error));
    }
    return rows;
}

// One table for all panels; the axes are those of the first that has each.
std::string panelsCsv(const Figure& figure) {
    std::string csv = comment("title", figure.title);
    if (!figure.caption.empty()) csv += comment("caption", figure.caption);
    const std::vector<Figure>& panels = figure.panels;
    const Figure& first = panels.empty() ? figure : panels.front();
    csv += axisComment("x", first.x) + axisComment(first.map ? "y" : "value", first.y);
    const bool has_map = first.map || std::any_of(panels.begin(), panels.end(), [](auto& p) { return p.map; });
    if (has_map) csv += axisComment("value of map", figure.color) + comment("bounds of map", "one standard error");
    for (const auto& [key, value] : figure.metadata) csv += comment(key, value);
    csv += "panel,series,x,x_end,y,y_end,value,lower,upper\n";
    if (panels.empty()) return csv + panelRows(figure);
    for (const Figure& panel : panels) csv += panelRows(panel);
    return csv;
}

}  // namespace

std::string figureCsv(const Figure& figure) {
    if (figure.map || !figure.panels.empty()) return panelsCsv(figure);
    std::string csv = comment("title", figure.title);
    if (!figure.caption.empty()) csv += comment("caption", figure.caption);
    csv += axisComment("x", figure.x) + axisComment("y", figure.y);
    for (const auto& [key, value] : figure.metadata) csv += comment(key, value);
    csv += "series,x,x_end,y,lower,upper\n";
    for (const Series& series : figure.series) {
        const bool steps = series.style == SeriesStyle::steps;
        for (size_t i = 0; i < series.y.size(); ++i) {
            csv += fmt::format("{},{},{},{}", csvField(series.label), numberText(series.x[i]),
                               steps ? numberText(series.x[i + 1]) : "", numberText(series.y[i]));
            csv += series.lower.empty()
                       ? ",,\n"
                       : fmt::format(",{},{}\n", numberText(series.lower[i]), numberText(series.upper[i]));
        }
    }
    return csv;
}

}  // namespace searchlight
