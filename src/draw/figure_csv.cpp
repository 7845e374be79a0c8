#include <fmt/format.h>

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

void appendRows(std::string& csv, const Figure& figure) {
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
}

}  // namespace

std::string figureCsv(const Figure& figure) {
    std::string csv = comment("title", figure.title);
    if (!figure.caption.empty()) csv += comment("caption", figure.caption);
    csv += axisComment("x", figure.x) + axisComment("y", figure.y);
    for (const auto& [key, value] : figure.metadata) csv += comment(key, value);
    csv += "series,x,x_end,y,lower,upper\n";
    appendRows(csv, figure);
    for (const Figure& panel : figure.below) {
        csv += axisComment("panel", panel.y);
        appendRows(csv, panel);
    }
    return csv;
}

}  // namespace searchlight
