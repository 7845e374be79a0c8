#include "validate/profile_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "base/csv.h"
#include "base/error.h"
#include "base/text.h"
#include "model/plane.h"

namespace searchlight {

namespace {

constexpr const char* valid_columns =
    "expected r_mm, or r0_mm and r1_mm; R_d, or R, G, B; and perhaps R_d_stderr, or R_stderr, G_stderr, B_stderr";

struct Columns {
    std::optional<std::size_t> r, r0, r1;
    std::vector<std::size_t> value, error;
};

Columns columnsOf(const CsvTable& table) {
    static constexpr std::array<std::string_view, 11> known = {
        "r_mm", "r0_mm", "r1_mm", "R_d", "R", "G", "B", "R_d_stderr", "R_stderr", "G_stderr", "B_stderr"};
    for (const CsvCell& cell : table.header)
        if (std::ranges::find(known, cell.text) == known.end())
            throw inputError(fmt::format("unexpected column '{}'", cell.text), valid_columns)
                .at(table.path, cell.line, cell.column);
    const auto all = [&](const std::vector<std::string_view>& names) {
        std::vector<std::size_t> found;
        for (const std::string_view name : names)
            if (const auto at = table.find(name)) found.push_back(*at);
        if (!found.empty() && found.size() < names.size())
            throw inputError(fmt::format("only some of the columns of {}", names.front()), valid_columns)
                .at(table.path, table.header.front().line, 1);
        return found;
    };
    Columns columns{table.find("r_mm"), table.find("r0_mm"), table.find("r1_mm"), all({"R_d"}), all({"R_d_stderr"})};
    const std::vector<std::size_t> rgb = all({"R", "G", "B"}), rgb_error = all({"R_stderr", "G_stderr", "B_stderr"});
    const bool radii = columns.r ? !columns.r0 && !columns.r1 : columns.r0 && columns.r1;
    const bool values =
        columns.value.empty() ? !rgb.empty() && columns.error.empty() : rgb.empty() && rgb_error.empty();
    if (!radii || !values)
        throw inputError("the columns are no profile", valid_columns).at(table.path, table.header.front().line, 1);
    if (columns.value.empty()) columns.value = rgb, columns.error = rgb_error;
    return columns;
}

double entering(const CsvTable& table, double eta) {
    const std::string_view per = table.meta("per");
    if (per.empty() || per == "transmitted") return 1;
    if (per != "incident")
        throw inputError(fmt::format("a profile per '{}'", per), "expected '# per: transmitted' or '# per: incident'")
            .at(table.path);
    if (eta == 0)
        throw inputError("a profile per incident flux needs the refractive index", "a line such as '# eta: 1.4'")
            .at(table.path);
    return pencilBeam(eta, 0).transmittance;
}

double etaOf(const CsvTable& table) {
    if (table.meta("eta").empty()) return 0;
    const std::optional<double> eta = parseNumber(table.meta("eta"));
    if (!eta || *eta < 0.25 || *eta > 4)
        throw inputError(fmt::format("'{}' is no eta", table.meta("eta")), "expected 0.25 to 4").at(table.path);
    return *eta;
}

// Radii, and the edges of annuli, which follow on each other.
void readRadii(const CsvTable& table, const Columns& columns, FitData& data) {
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const std::size_t first = columns.r ? *columns.r : *columns.r0;
        const CsvCell& cell = table.rows[row][first];
        const double r = table.number(row, first);
        const double before = columns.r ? (row > 0 ? data.radii_mm.back() : -1) : 0;
        if (r < 0 || (columns.r && r <= before))
            throw inputError(fmt::format("radius {} does not ascend", cell.text),
                             "radii are at least 0 and grow from line to line")
                .at(table.path, cell.line, cell.column);
        if (columns.r) {
            data.radii_mm.push_back(r);
            continue;
        }
        const double r1 = table.number(row, *columns.r1);
        if (row > 0 && r != data.edges_mm.back())
            throw inputError(fmt::format("the annulus from {} does not begin where the last ended", cell.text),
                             fmt::format("expected {}", numberText(data.edges_mm.back())))
                .at(table.path, cell.line, cell.column);
        if (!(r1 > r))
            throw inputError(fmt::format("the annulus from {} has no width", cell.text), "r1_mm is above r0_mm")
                .at(table.path, cell.line, cell.column);
        if (row == 0) data.edges_mm.push_back(r);
        data.edges_mm.push_back(r1);
        data.radii_mm.push_back(0.5 * (r + r1));
    }
}

}  // namespace

ProfileData parseProfileData(std::string_view text, std::string_view path) {
    const CsvTable table = parseCsv(text, path);
    const Columns columns = columnsOf(table);
    ProfileData profile;
    profile.title = table.meta("title").empty() ? std::string(path.substr(path.find_last_of("/\\") + 1))
                                                : std::string(table.meta("title"));
    profile.eta = etaOf(table);
    const double entered = entering(table, profile.eta);
    if (table.rows.size() < 3)
        throw inputError(fmt::format("the table has {} rows", table.rows.size()), "a fit needs at least 3 radii")
            .at(path);
    FitData radii;
    readRadii(table, columns, radii);
    for (std::size_t c = 0; c < columns.value.size(); ++c) {
        FitData data = radii;
        for (std::size_t row = 0; row < table.rows.size(); ++row) {
            data.value.push_back(table.number(row, columns.value[c]) / entered);
            if (columns.error.empty()) continue;
            const double error = table.number(row, columns.error[c]);
            const CsvCell& cell = table.rows[row][columns.error[c]];
            if (error < 0)
                throw inputError(fmt::format("the standard error {} is negative", cell.text))
                    .at(path, cell.line, cell.column);
            data.standard_error.push_back(error / entered);
        }
        profile.channels.push_back(std::move(data));
    }
    return profile;
}

FitData between(const FitData& data, double min_mm, double max_mm) {
    FitData part;
    for (std::size_t i = 0; i < data.radii_mm.size(); ++i) {
        const bool annuli = !data.edges_mm.empty();
        const double from = annuli ? data.edges_mm[i] : data.radii_mm[i];
        const double to = annuli ? data.edges_mm[i + 1] : data.radii_mm[i];
        if (from < min_mm || (max_mm > 0 && to > max_mm)) continue;
        part.radii_mm.push_back(data.radii_mm[i]);
        part.value.push_back(data.value[i]);
        if (!data.standard_error.empty()) part.standard_error.push_back(data.standard_error[i]);
        if (!annuli) continue;
        if (part.edges_mm.empty()) part.edges_mm.push_back(from);
        part.edges_mm.push_back(to);
    }
    return part;
}

}  // namespace searchlight
