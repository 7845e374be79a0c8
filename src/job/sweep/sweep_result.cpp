#include "job/sweep/sweep_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/version.h"
#include "draw/contact_sheet.h"
#include "job/json.h"

namespace searchlight {

namespace {

namespace fs = std::filesystem;

Json withoutOutput(Json job) {
    job.erase("output");
    return job;
}

// Which of the table's rows or columns: the axes' values as digits, the last changing fastest.
std::size_t placeOf(const std::vector<std::size_t>& axes, const Sweep& sweep, const SweepCell& cell) {
    std::size_t place = 0;
    for (const std::size_t axis : axes) place = place * sweep.axes[axis].labels.size() + cell.choices[axis];
    return place;
}

std::vector<std::string> headingsOf(const std::vector<std::size_t>& axes, const Sweep& sweep) {
    std::vector<std::string> headings{""};
    for (const std::size_t axis : axes) {
        std::vector<std::string> longer;
        for (const std::string& heading : headings)
            for (const std::string& label : sweep.axes[axis].labels)
                longer.push_back(heading.empty() ? label : heading + ", " + label);
        headings = std::move(longer);
    }
    return headings;
}

std::string titleOf(const std::vector<std::size_t>& axes, const Sweep& sweep) {
    std::vector<std::string> titles;
    for (const std::size_t axis : axes) titles.push_back(sweep.axes[axis].title);
    return join(titles, ", ");
}

// Mean radiance of what is covered, per channel, and how much is.
struct Mean {
    Rgb radiance;
    double coverage = 0;  ///< fraction of the picture
};

Mean meanOf(const Image& image) {
    Mean mean;
    for (const Rgba& pixel : image.pixels) {
        mean.radiance = mean.radiance + Rgb{pixel.r, pixel.g, pixel.b};
        mean.coverage += pixel.a;
    }
    if (mean.coverage > 0) mean.radiance = (1 / mean.coverage) * mean.radiance;
    mean.coverage /= static_cast<double>(image.pixels.size());
    return mean;
}

// Stops per cell: those of the brightest picture that shares them, so that none is clipped.
std::vector<double> exposuresOf(const Sweep& sweep, const std::vector<Json>& documents) {
    const SheetPlan& plan = sweep.sheet;
    const auto group = [&](const SweepCell& cell) -> std::size_t {
        switch (plan.shared) {
            case SharedExposure::sheet: return 0;
            case SharedExposure::row: return placeOf(plan.rows, sweep, cell);
            case SharedExposure::column: return placeOf(plan.columns, sweep, cell);
            case SharedExposure::cell: return cell.number;
        }
        return 0;
    };
    std::map<std::size_t, double> least;
    for (std::size_t i = 0; i < documents.size(); ++i) {
        const double stops = plan.stops.value_or(documents[i].at("exposure").get<double>());
        const auto [known, first] = least.try_emplace(group(sweep.cells[i]), stops);
        if (!first) known->second = std::min(known->second, stops);
    }
    std::vector<double> stops;
    for (const SweepCell& cell : sweep.cells) stops.push_back(least.at(group(cell)));
    return stops;
}

std::string exposureText(const Sweep& sweep, const std::vector<double>& stops) {
    constexpr std::string_view shared[] = {"One exposure for all", "One exposure per row", "One exposure per column",
                                           "Each picture with its own exposure"};
    const bool one = sweep.sheet.stops || sweep.sheet.shared == SharedExposure::sheet;
    std::string text(shared[one ? 0 : static_cast<std::size_t>(sweep.sheet.shared)]);
    if (one) text += fmt::format(": {}{:.2f} stops", stops.front() < 0 ? "−" : "+", std::abs(stops.front()));
    return text + ".";
}

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
    return result + "\"";
}

// A row per cell, of what summary.json says.
std::string csvOf(const Sweep& sweep, const Json& summary) {
    std::vector<std::vector<std::string>> rows(1, {"cell"});
    for (const SweepAxis& axis : sweep.axes) rows[0].push_back(quoted(axis.key));
    for (const char* column : {"mean_R", "mean_G", "mean_B", "coverage", "error_bound", "total_ms", "file"})
        rows[0].emplace_back(column);
    for (const Json& cell : summary.at("cells")) {
        std::vector<std::string>& row = rows.emplace_back();
        row.push_back(cell.at("cell").dump());
        for (const SweepAxis& axis : sweep.axes) row.push_back(quoted(cell.at("values").at(axis.key)));
        for (const Json& mean : cell.at("mean_radiance")) row.push_back(mean.dump());
        const Json& bound = cell.at("error_bound");
        row.push_back(cell.at("coverage").dump());
        row.push_back(bound.is_null() ? "" : bound.dump());
        row.push_back(cell.at("ms").at("total").dump());
        row.push_back(quoted(cell.at("file")));
    }
    std::string csv = fmt::format("# Searchlight {}\n", version());
    csv += "# mean_R, mean_G, mean_B: radiance per coverage; total_ms: without what earlier cells left\n";
    for (const std::vector<std::string>& row : rows) csv += fmt::format("{}\n", fmt::join(row, ","));
    return csv;
}

Json cellJson(const Sweep& sweep, const SweepCell& cell, const Json& document, const Mean& mean,
              const std::string& file) {
    Json json;
    json["cell"] = cell.number;
    json["file"] = file;
    for (std::size_t axis = 0; axis < sweep.axes.size(); ++axis)
        json["values"][sweep.axes[axis].key] = sweep.axes[axis].labels[cell.choices[axis]];
    json["mean_radiance"] = {mean.radiance.r, mean.radiance.g, mean.radiance.b};
    json["coverage"] = mean.coverage;
    for (const char* key : {"technique", "device", "points", "receivers", "error_bound", "exposure", "notes", "ms"})
        json[key] = document.value(key, Json());
    return json;
}

}  // namespace

fs::path cellPath(const fs::path& folder, const SweepCell& cell, const char* ending) {
    return folder / fmt::format("cell_{:04}{}", cell.number, ending);
}

bool isDone(const fs::path& folder, const SweepCell& cell) {
    const fs::path numbers = cellPath(folder, cell, ".json");
    // The numbers are written after the picture.
    if (std::error_code error; !fs::exists(numbers, error) || !fs::exists(cellPath(folder, cell, ".exr"), error))
        return false;
    const Json document = Json::parse(readFile(numbers), nullptr, false);
    if (!document.is_object() || !document.contains("job") || !document["job"].is_object()) return false;
    return document.value("version", Json()) == Json(version()) &&
           withoutOutput(document["job"]) == withoutOutput(Json::parse(jobJson(cell.job)));
}

std::vector<fs::path> writeSummary(const Sweep& sweep, const fs::path& folder, const fs::path& sheet_path) {
    const SheetPlan& plan = sweep.sheet;
    std::vector<Json> documents;
    for (const SweepCell& cell : sweep.cells)
        documents.push_back(Json::parse(readFile(cellPath(folder, cell, ".json"))));
    const std::vector<double> stops = exposuresOf(sweep, documents);

    ContactSheet sheet;
    sheet.title = sweep.title;
    sheet.caption = sweep.caption + (sweep.caption.empty() ? "" : " ") + exposureText(sweep, stops);
    sheet.columns = headingsOf(plan.columns, sweep);
    sheet.rows = headingsOf(plan.rows, sweep);
    sheet.column_title = titleOf(plan.columns, sweep);
    sheet.row_title = titleOf(plan.rows, sweep);
    sheet.cells.resize(sweep.cells.size());
    sheet.metadata = {{"Software", fmt::format("Searchlight {}", version())}};

    Json summary;
    summary["format"] = "searchlight-sweep-summary/1";
    summary["version"] = version();
    summary["title"] = sweep.title;
    summary["axes"] = Json::array();
    for (const SweepAxis& axis : sweep.axes)
        summary["axes"].push_back({{"key", axis.key}, {"title", axis.title}, {"labels", axis.labels}});
    summary["cells"] = Json::array();
    for (std::size_t i = 0; i < sweep.cells.size(); ++i) {
        const SweepCell& cell = sweep.cells[i];
        const fs::path path = cellPath(folder, cell, ".exr");
        ImageFile file = readImage(path.string());
        if (i == 0) {
            const int width = plan.width > 0 ? plan.width : std::clamp(file.image.width / 2, 60, 480);
            sheet.picture_width = width;
            sheet.picture_height =
                std::max(1, static_cast<int>(std::lround(1.0 * width * file.image.height / file.image.width)));
        }
        summary["cells"].push_back(cellJson(sweep, cell, documents[i], meanOf(file.image), path.filename().string()));
        file.layers.clear();
        file.metadata.clear();
        const std::size_t place =
            placeOf(plan.rows, sweep, cell) * sheet.columns.size() + placeOf(plan.columns, sweep, cell);
        sheet.cells[place].png = imageBytes("sheet.png", file, {.exposure = stops[i], .curve = plan.curve});
    }
    const std::vector<fs::path> paths{sheet_path, folder / "summary.csv", folder / "summary.json"};
    drawSheet(sheet, paths[0]);
    writeFile(paths[1], csvOf(sweep, summary));
    writeFile(paths[2], jsonText(summary) + "\n");
    return paths;
}

}  // namespace searchlight
