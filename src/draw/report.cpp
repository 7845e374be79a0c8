#include "draw/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <string_view>

#include "base/text.h"
#include "draw/figure_layout.h"
#include "draw/svg.h"

namespace searchlight {

namespace {

constexpr std::string_view style = R"(
:root { color-scheme: light dark; --paper: #fdfdfc; --ink: #1c1c1c; --soft: #5c5c5c; --rule: #d8d8d4; }
@media (prefers-color-scheme: dark) { :root { --paper: #16181b; --ink: #e4e4e2; --soft: #a2a5a9; --rule: #3a3e43; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); line-height: 1.55;
       font: 16px/1.55 Charter, "Bitstream Charter", "Sitka Text", Cambria, "DejaVu Serif", Georgia, serif; }
main { max-width: 66rem; margin: 0 auto; padding: 3.5rem 1.5rem 2rem; }
h1 { font-size: 1.9rem; line-height: 1.2; font-weight: 600; margin: 0 0 1rem; text-wrap: balance; }
h2 { font-size: 1.25rem; font-weight: 600; margin: 3rem 0 .75rem; }
p, caption { max-width: 46rem; }
p { margin: 0 0 1rem; hyphens: auto; }
.summary { font-size: 1.1rem; color: var(--soft); border-left: 3px solid var(--rule); padding-left: 1rem; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(28rem, 100%), 1fr)); gap: 1.5rem; align-items: start; }
figure { margin: 0; }
figure svg { display: block; width: 100%; height: auto; background: #fff; border: 1px solid var(--rule); border-radius: 4px; }
.wide { overflow-x: auto; margin: 1.75rem 0; }
table { border-collapse: collapse; width: 100%; border-top: 1.5px solid var(--ink); border-bottom: 1.5px solid var(--ink);
        font: .875rem/1.4 Helvetica, Arial, "Liberation Sans", "DejaVu Sans", sans-serif; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--soft); padding: 0 0 .5rem; }
th, td { padding: .35rem .75rem; text-align: left; vertical-align: baseline; }
th:first-child, td:first-child { padding-left: 0; }
th:last-child, td:last-child { padding-right: 0; }
thead th { border-bottom: 1px solid var(--ink); font-weight: 600; }
tbody tr + tr td { border-top: 1px solid var(--rule); }
.number { text-align: right; white-space: nowrap; }
footer { margin-top: 4rem; border-top: 1px solid var(--rule); padding-top: 1rem; color: var(--soft); font-size: .8rem; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .15rem 1rem; margin: 0; font-family: Helvetica, Arial, sans-serif; }
dd { margin: 0; overflow-wrap: anywhere; }
@media print { main { padding: 0; max-width: none; } figure, table { break-inside: avoid; } }
)";

// "0.31", "-4.5 %", "1.2e-3 ± 4e-5", ">1000 %", or a dash: what reads better aligned at its right.
bool looksNumeric(std::string_view cell) {
    cell = trim(cell);
    if (cell.empty() || cell == "-" || cell == "–" || cell == "—" || cell == "n/a") return true;
    if (cell.front() == '>' || cell.front() == '<') cell.remove_prefix(1);
    const std::string_view first = cell.substr(0, cell.find_first_of(" %"));
    return parseNumber(first).has_value();
}

bool isNumericColumn(const ReportTable& table, size_t column) {
    const auto cell = [&](const std::vector<std::string>& row) -> std::string_view {
        return column < row.size() ? std::string_view(row[column]) : std::string_view();
    };
    const auto has_digit = [&](const auto& row) {
        return cell(row).find_first_of("0123456789") != std::string_view::npos;
    };
    return std::all_of(table.rows.begin(), table.rows.end(),
                       [&](const auto& row) { return looksNumeric(cell(row)); }) &&
           std::any_of(table.rows.begin(), table.rows.end(), has_digit);
}

std::string tableHtml(const ReportTable& table) {
    std::vector<std::string_view> classes;
    for (size_t i = 0; i < table.header.size(); ++i)
        classes.push_back(isNumericColumn(table, i) ? " class=\"number\"" : "");
    std::string html = "<div class=\"wide\"><table>\n";
    if (!table.caption.empty()) html += fmt::format("<caption>{}</caption>\n", escapeXml(table.caption));
    html += "<thead><tr>";
    for (size_t i = 0; i < table.header.size(); ++i)
        html += fmt::format("<th scope=\"col\"{}>{}</th>", classes[i], escapeXml(table.header[i]));
    html += "</tr></thead>\n<tbody>\n";
    for (const std::vector<std::string>& row : table.rows) {
        assert(row.size() == table.header.size());
        html += "<tr>";
        for (size_t i = 0; i < std::min(row.size(), classes.size()); ++i)
            html += fmt::format("<td{}>{}</td>", classes[i], escapeXml(row[i]));
        html += "</tr>\n";
    }
    return html + "</tbody>\n</table></div>\n";
}

std::string sectionHtml(const ReportSection& section) {
    std::string html = "<section>\n";
    if (!section.heading.empty()) html += fmt::format("<h2>{}</h2>\n", escapeXml(section.heading));
    for (const std::string& paragraph : section.paragraphs) html += fmt::format("<p>{}</p>\n", escapeXml(paragraph));
    for (const ReportTable& table : section.tables) html += tableHtml(table);
    if (!section.figures.empty()) html += "<div class=\"figures\">\n";
    for (const Figure& figure : section.figures)
        html += fmt::format("<figure>\n{}</figure>\n", svgElement(layoutFigure(figure), figure));
    if (!section.figures.empty()) html += "</div>\n";
    for (const ContactSheet& sheet : section.sheets)
        html += fmt::format("<figure>\n{}</figure>\n", sheetElement(sheet));
    return html + "</section>\n";
}

}  // namespace

std::string reportHtml(const Report& report) {
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{0}</title>\n"
        "<style>{1}</style>\n</head>\n<body>\n<main>\n<h1>{0}</h1>\n",
        escapeXml(report.title), style);
    if (!report.summary.empty()) html += fmt::format("<p class=\"summary\">{}</p>\n", escapeXml(report.summary));
    for (const ReportSection& section : report.sections) html += sectionHtml(section);
    html += "<footer><dl>\n";
    for (const auto& [key, value] : report.metadata)
        html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escapeXml(key), escapeXml(value));
    return html + "</dl></footer>\n</main>\n</body>\n</html>\n";
}

}  // namespace searchlight
