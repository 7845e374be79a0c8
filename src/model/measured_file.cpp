#include "model/measured_file.h"

#include <fmt/format.h>

#include <array>
#include <optional>

#include "base/csv.h"
#include "base/error.h"
#include "base/text.h"
#include "model/plane.h"

namespace searchlight {

namespace {

// Where a metadata line has no place of its own the file is named.
double transmittance(const CsvTable& table) {
    const std::string_view per = table.meta("per");
    if (per.empty() || per == "transmitted") return 1;
    if (per != "incident")
        throw inputError(fmt::format("a profile per '{}'", per), "expected '# per: transmitted' or '# per: incident'")
            .at(table.path);
    const std::optional<double> eta = parseNumber(table.meta("eta"));
    if (!eta || *eta < 0.25 || *eta > 4)
        throw inputError("a profile per incident flux needs the refractive index",
                         "expected a line such as '# eta: 1.4', within 0.25 to 4")
            .at(table.path);
    return pencilBeam(*eta, 0).transmittance;
}

// Indices of the value columns of the three channels.
std::array<std::size_t, 3> valueColumns(const CsvTable& table) {
    const auto wrong_header = [&](const CsvCell& cell) {
        return inputError(fmt::format("unexpected column '{}'", cell.text), "expected r_mm, R, G, B or r_mm, R_d")
            .at(table.path, cell.line, cell.column);
    };
    static constexpr std::array<std::string_view, 4> rgb = {"r_mm", "R", "G", "B"}, single = {"r_mm", "R_d"};
    const bool is_single = table.header.size() == 2;
    for (std::size_t i = 0; i < table.header.size(); ++i)
        if (i >= rgb.size() || table.header[i].text != (is_single ? single : rgb)[i])
            throw wrong_header(table.header[i]);
    if (table.header.size() == 4) return {1, 2, 3};
    if (is_single) return {1, 1, 1};
    throw wrong_header(table.header.back());
}

}  // namespace

Model parseMeasured(std::string_view text, std::string_view path) {
    const CsvTable table = parseCsv(text, path);
    const double entered = transmittance(table);
    const std::array<std::size_t, 3> columns = valueColumns(table);
    std::vector<double> radii;
    std::vector<Rgb> values;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const CsvCell& cell = table.rows[row][0];
        const double r = table.number(row, 0);
        if (r < 0 || (!radii.empty() && r <= radii.back()))
            throw inputError(fmt::format("radius {} does not ascend", cell.text),
                             "radii are at least 0 and grow from line to line")
                .at(path, cell.line, cell.column);
        radii.push_back(r);
        values.emplace_back();
        for (int c = 0; c < Rgb::channels; ++c)
            values.back()[c] = table.number(row, columns[static_cast<std::size_t>(c)]) / entered;
    }
    if (radii.size() < 2)
        throw inputError(fmt::format("the table has {} rows", radii.size()), "a profile needs at least 2 radii")
            .at(path);

    Model model;
    model.measured = true;
    model.file.path = path;
    model.file.title = table.meta("title").empty() ? path.substr(path.find_last_of("/\\") + 1) : table.meta("title");
    model.file.radial = model.file.no_wi = model.file.no_wo = true;
    model.file.single_scattering = true;
    model.file.attributes = {"measured", "radial", "no_wi", "no_wo", "single_scattering"};
    model.profile = Profile(std::move(radii), std::move(values));
    return model;
}

}  // namespace searchlight
