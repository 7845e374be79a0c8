#include "scene/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>

#include "base/csv.h"
#include "base/embedded.h"
#include "base/error.h"
#include "base/files.h"
#include "base/text.h"

namespace searchlight {

namespace {

// Columns of one quantity: "sigma_a" for all channels, or "sigma_a_R", "sigma_a_G", "sigma_a_B".
using ChannelColumns = std::vector<std::size_t>;

const std::vector<std::string>& columnNames() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list{"id", "name", "aliases", "eta", "note"};
        for (const std::string quantity : {"sigma_a", "sigma_s", "sigma_sp", "g", "Rd"})
            for (const std::string channel : {"", "_R", "_G", "_B"}) list.push_back(quantity + channel);
        return list;
    }();
    return names;
}

std::optional<ChannelColumns> findChannels(const CsvTable& table, const std::string& quantity) {
    ChannelColumns columns;
    for (const char* channel : {"_R", "_G", "_B"})
        if (const auto column = table.find(quantity + channel)) columns.push_back(*column);
    const std::optional<std::size_t> single = table.find(quantity);
    const CsvCell& header = table.header.front();
    if (columns.size() % 3 != 0 || (single && !columns.empty()))
        throw inputError(fmt::format("incomplete columns for {0}", quantity),
                         fmt::format("expected {0}, or {0}_R, {0}_G and {0}_B", quantity))
            .at(table.path, header.line, header.column);
    if (single) columns = {*single};
    if (columns.empty()) return std::nullopt;
    return columns;
}

std::vector<double> numbers(const CsvTable& table, std::size_t row, const ChannelColumns& columns) {
    std::vector<double> list;
    for (const std::size_t column : columns) list.push_back(table.number(row, column));
    return list;
}

// 1/mm per unit of the table; nothing for a table that does not know its unit.
std::optional<double> unitFactor(const CsvTable& table) {
    const std::string_view unit = table.meta("unit");
    if (unit == "unknown") return std::nullopt;
    if (unit == "1/mm") return 1;
    if (unit == "1/cm") return 0.1;
    if (unit == "1/m") return 0.001;
    throw inputError(unit.empty() ? "the table states no unit" : fmt::format("unknown unit '{}'", unit),
                     "expected a line '# unit: 1/mm', 1/cm, 1/m or unknown")
        .at(table.path);
}

// Reads rows of one table; the columns are looked up once.
class MaterialReader {
public:
    explicit MaterialReader(const CsvTable& table) : table_(table), header_(table.header.front()) {
        for (const CsvCell& cell : table.header)
            if (std::ranges::find(columnNames(), cell.text) == columnNames().end())
                throw unknownName(ErrorKind::input, "column", cell.text, columnNames())
                    .at(table.path, cell.line, cell.column);
        if (table.meta("citation").empty())
            throw inputError("the table states no source", "expected a line '# citation: ...'").at(table.path);
        unit_ = unitFactor(table);
        id_ = require(table.find("id"), "id");
        eta_ = require(table.find("eta"), "eta");
        sigma_a_ = require(findChannels(table, "sigma_a"), "sigma_a");
        sigma_s_ = findChannels(table, "sigma_s");
        sigma_sp_ = findChannels(table, "sigma_sp");
        g_ = findChannels(table, "g");
        published_Rd_ = findChannels(table, "Rd");
        if (!sigma_s_ && !sigma_sp_) fail("no column sigma_s", "or sigma_sp, where the reduced one was published");
        if (sigma_s_ && sigma_sp_) fail("sigma_s beside sigma_sp", "keep the one that was published");
        if (sigma_sp_ && g_)
            fail("g beside sigma_sp", "a reduced coefficient stands with g = 0; give sigma_s or drop g");
    }

    Material read(std::size_t row) const {
        const CsvCell& id = table_.rows[row][id_];
        if (id.text.empty() || id.text != lowerSnake(id.text))
            throw inputError(fmt::format("'{}' is no id", id.text), "expected lower_snake_case")
                .at(table_.path, id.line, id.column);
        Material material;
        material.id = id.text;
        material.name = text(row, "name");
        if (material.name.empty()) material.name = id.text;
        for (const std::string_view alias : split(text(row, "aliases"), ' '))
            if (!alias.empty()) material.aliases.emplace_back(alias);
        material.source = std::filesystem::path(table_.path).stem().string();
        material.citation = table_.meta("citation");
        material.note = table_.meta("note");
        if (const std::string_view doubt = text(row, "note"); !doubt.empty())
            material.note += (material.note.empty() ? "" : "; ") + std::string(doubt);
        material.reduced = sigma_sp_.has_value();
        material.unit_known = unit_.has_value();
        material.medium = medium(row);
        if (published_Rd_) {
            const std::vector<double> Rd = numbers(table_, row, *published_Rd_);
            material.published_Rd = {Rd.front(), Rd[Rd.size() / 2], Rd.back()};
        }
        return material;
    }

private:
    [[noreturn]] void fail(std::string message, std::string hint) const {
        throw inputError(std::move(message), std::move(hint)).at(table_.path, header_.line, header_.column);
    }

    template <class T>
    T require(const std::optional<T>& columns, std::string_view name) const {
        if (!columns)
            fail(fmt::format("no column {}", name), "every table has id, eta, sigma_a, and sigma_s or sigma_sp");
        return *columns;
    }

    std::string_view text(std::size_t row, std::string_view name) const {
        const std::optional<std::size_t> column = table_.find(name);
        return column ? std::string_view(table_.rows[row][*column].text) : std::string_view();
    }

    Medium medium(std::size_t row) const {
        const auto coefficients = [&](const ChannelColumns& columns) {
            std::vector<double> list = numbers(table_, row, columns);
            for (double& value : list) value *= unit_.value_or(1);
            return list;
        };
        const std::vector<double> g = g_ ? numbers(table_, row, *g_) : std::vector<double>{0};
        try {
            return makeMedium(coefficients(sigma_a_), coefficients(sigma_sp_ ? *sigma_sp_ : *sigma_s_), g,
                              table_.number(row, eta_));
        } catch (const Error& error) {
            throw error.at(table_.path, table_.rows[row].front().line, 1);
        }
    }

    const CsvTable& table_;
    const CsvCell& header_;
    std::optional<double> unit_;
    std::size_t id_ = 0, eta_ = 0;
    ChannelColumns sigma_a_;
    std::optional<ChannelColumns> sigma_s_, sigma_sp_, g_, published_Rd_;
};

// The id within its table.
std::string_view shortId(const Material& material) {
    const std::string_view id = material.id;
    return id.substr(id.rfind(':') + 1);
}

bool answersTo(const Material& material, std::string_view id) {
    return shortId(material) == id || std::ranges::find(material.aliases, id) != material.aliases.end();
}

std::vector<Material> parseEmbedded() {
    std::vector<Material> all;
    for (const EmbeddedFile& file : embeddedFiles()) {
        if (!file.path.starts_with("data/materials/")) continue;
        for (Material& material : parseMaterials(file.text, file.path)) all.push_back(std::move(material));
    }
    std::stable_partition(all.begin(), all.end(), [](const Material& material) { return material.unit_known; });
    std::map<std::string, int> uses;
    for (const Material& material : all) ++uses[material.id];
    for (Material& material : all)
        if (uses[material.id] > 1) material.id = material.source + ":" + material.id;
    return all;
}

Material findInFile(std::string_view path, std::string_view id) {
    const std::vector<Material> rows = parseMaterials(readFile(path), path);
    std::vector<std::string> ids;
    for (const Material& material : rows) {
        if (id.empty() ? rows.size() == 1 : answersTo(material, id)) return material;
        ids.push_back(material.id);
    }
    if (id.empty())
        throw usageError(fmt::format("{} has {} materials", path, rows.size()), fmt::format("write {}:ID", path));
    throw unknownName(ErrorKind::usage, fmt::format("material in {}", path), id, ids);
}

}  // namespace

std::vector<Material> parseMaterials(std::string_view text, std::string_view path) {
    const CsvTable table = parseCsv(text, path);
    const MaterialReader reader(table);
    std::vector<Material> rows;
    std::map<std::string, int, std::less<>> line_of;  // of ids and aliases
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const int line = table.rows[row].front().line;
        rows.push_back(reader.read(row));
        std::vector<std::string> names = rows.back().aliases;
        names.push_back(rows.back().id);
        for (const std::string& name : names)
            if (const auto [first, added] = line_of.emplace(name, line); !added)
                throw inputError(fmt::format("'{}' already names the material of line {}", name, first->second))
                    .at(path, line, 1);
    }
    return rows;
}

const std::vector<Material>& materials() {
    static const std::vector<Material> all = parseEmbedded();
    return all;
}

Material findMaterial(std::string_view id) {
    constexpr std::string_view ending = ".csv";
    if (id.ends_with(ending)) return findInFile(id, {});
    if (const std::size_t at = id.rfind(".csv:"); at != std::string_view::npos)
        return findInFile(id.substr(0, at + ending.size()), id.substr(at + ending.size() + 1));

    const std::size_t colon = id.find(':');
    const std::string_view source = colon == std::string_view::npos ? std::string_view() : id.substr(0, colon);
    std::vector<const Material*> found;
    std::vector<std::string> ids;
    for (const Material& material : materials()) {
        const std::string qualified = fmt::format("{}:{}", material.source, shortId(material));
        ids.push_back(source.empty() ? material.id : qualified);
        if (source.empty() ? answersTo(material, id)
                           : material.source == source && answersTo(material, id.substr(colon + 1)))
            found.push_back(&material);
    }
    if (found.empty()) throw unknownName(ErrorKind::usage, "material", id, ids);
    if (found.size() == 1) return *found.front();
    std::vector<std::string> choices;
    for (const Material* material : found) choices.push_back(material->id);
    throw usageError(fmt::format("'{}' names {} materials", id, found.size()), "write " + join(choices, " or "));
}

}  // namespace searchlight
