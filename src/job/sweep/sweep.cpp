#include "job/sweep/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "base/error.h"
#include "base/text.h"
#include "job/command.h"
#include "job/json.h"
#include "job/render/kept_renderer.h"
#include "job/sweep/sweep_axis.h"
#include "scene/json_text.h"

namespace searchlight {

namespace {

constexpr std::string_view format_name = "searchlight-sweep/";
constexpr int format_version = 1;
constexpr std::size_t max_cells = 10'000;  // more is a slip of the pen

class SweepReader {
public:
    explicit SweepReader(const JsonText& text) : text_(text), root_(text.root()) {}

    Sweep read() {
        checkFormat();
        checkKeys(root_, "", {"format", "title", "caption", "base", "render", "seed", "axes", "sheet"});
        Sweep sweep;
        sweep.title = textAt("title");
        sweep.caption = textAt("caption");
        const CellText base = readBase();
        const std::vector<AxisValues> axes = readAxes(base);
        for (const AxisValues& axis : axes) sweep.axes.push_back(axis.axis);
        sweep.sheet = readSheet(sweep.axes);
        sweep.cells = cellsOf(base, axes, sweep);
        return sweep;
    }

private:
    void checkFormat() const {
        const std::string expected = fmt::format("{}{}", format_name, format_version);
        if (!root_.is_object())
            throw text_.error("", "a sweep is a JSON object", fmt::format("{{\"format\": \"{}\", ...}}", expected));
        const auto format = root_.find("format");
        if (format == root_.end())
            throw text_.error("", "no format", fmt::format("expected \"format\": \"{}\"", expected));
        const std::string name = format->is_string() ? format->get<std::string>() : format->dump();
        if (name == expected) return;
        if (!name.starts_with(format_name))
            throw text_.error("/format", fmt::format("'{}' is no sweep", name), "expected " + expected);
        const std::optional<double> version = parseNumber(std::string_view(name).substr(format_name.size()));
        if (version && *version > format_version)
            throw text_.error("/format", fmt::format("'{}' is newer than this program", name), "it reads " + expected);
        throw text_.error("/format", fmt::format("unknown version '{}'", name), "expected " + expected);
    }

    void checkKeys(const nlohmann::json& object, const std::string& pointer,
                   const std::vector<std::string>& keys) const {
        if (!object.is_object()) throw text_.error(pointer, "expected an object");
        for (const auto& [key, value] : object.items())
            if (std::ranges::find(keys, key) == keys.end()) {
                const Error unknown = unknownName(ErrorKind::input, "key", key, keys);
                throw text_.errorAtKey(pointer + pointerStep(key), unknown.message, unknown.hint);
            }
    }

    std::string textAt(const char* key) const {
        if (!root_.contains(key)) return {};
        if (!root_[key].is_string()) throw text_.error(std::string("/") + key, "expected text");
        return root_[key];
    }

    // Everything that no axis changes, checked where it stands in the file.
    CellText readBase() const {
        CellText base;
        base.scene = Json::parse(sceneJson(root_.contains("base") ? readScene(text_, "/base") : Scene{}));
        if (root_.contains("render")) {
            const nlohmann::json& options = root_["render"];
            if (!options.is_object()) throw text_.error("/render", "expected an object");
            for (const auto& [name, value] : options.items()) {
                const std::string pointer = "/render" + pointerStep(name);
                try {
                    text_.value(pointer, value, findParam(sweptOptions(), name, "option of render"));
                } catch (const Error& unknown) {
                    if (unknown.kind != ErrorKind::usage) throw;
                    throw text_.errorAtKey(pointer, unknown.message, unknown.hint);
                }
            }
            base.options = Json::parse(options.dump());
        }
        if (root_.contains("seed")) {
            base.seed = Json::parse(root_["seed"].dump());
            checked(base, "/seed");
        }
        return base;
    }

    // The job of a cell; what is wrong with it is said of the value at `pointer`, which completed it.
    Job checked(const CellText& cell, const std::string& pointer) const {
        try {
            return jobOf(cell);
        } catch (const Error& error) {
            // What the job calls by the same pointer needs no second one.
            const std::string prefix = pointer + ": ";
            const bool same = error.message.starts_with(prefix);
            throw text_.error(pointer, error.message.substr(same ? prefix.size() : 0), error.hint);
        }
    }

    std::vector<AxisValues> readAxes(const CellText& base) const {
        const auto list = root_.find("axes");
        if (list == root_.end()) throw text_.error("", "no axes", "such as \"axes\": [{\"key\": \"material\", ...}]");
        if (!list->is_array() || list->empty()) throw text_.error("/axes", "expected a list of axes");
        std::vector<AxisValues> axes;
        std::size_t cells = 1;
        for (std::size_t i = 0; i < list->size(); ++i) {
            const std::string pointer = fmt::format("/axes/{}", i);
            const nlohmann::json& json = (*list)[i];
            checkKeys(json, pointer, {"key", "title", "values", "labels", "from", "to", "steps", "count"});
            AxisValues axis = readAxis(text_, json, pointer);
            for (const AxisValues& other : axes)
                if (other.axis.key == axis.axis.key)
                    throw text_.error(pointer + "/key", fmt::format("'{}' has an axis already", axis.axis.key));
            for (std::size_t k = 0; k < axis.values.size(); ++k) {
                const std::string place =
                    json.contains("values") ? fmt::format("{}/values/{}", pointer, k) : pointer + "/key";
                CellText cell = base;
                try {
                    applyValue(axis.axis.key, axis.values[k], cell);
                } catch (const Error& error) {
                    throw text_.error(pointer + "/key", error.message, error.hint);
                }
                checked(cell, place);
            }
            if (axis.values.size() > max_cells / cells)
                throw text_.error("/axes", fmt::format("more than {} cells", max_cells));
            cells *= axis.values.size();
            axes.push_back(std::move(axis));
        }
        return axes;
    }

    // Axes by key: one name, or a list of them.
    std::vector<std::size_t> axesAt(const nlohmann::json& json, const std::string& pointer,
                                    const std::vector<SweepAxis>& axes) const {
        std::vector<std::string> keys;
        for (const SweepAxis& axis : axes) keys.push_back(axis.key);
        std::vector<std::size_t> found;
        const auto add = [&](const nlohmann::json& name, const std::string& at) {
            const std::string key = name.is_string() ? name.get<std::string>() : name.dump();
            const auto known = std::ranges::find(keys, key);
            if (known == keys.end()) {
                const Error unknown = unknownName(ErrorKind::input, "axis", key, keys);
                throw text_.error(at, unknown.message, unknown.hint);
            }
            const auto index = static_cast<std::size_t>(known - keys.begin());
            if (std::ranges::find(found, index) != found.end())
                throw text_.error(at, fmt::format("'{}' stands twice", key));
            found.push_back(index);
        };
        if (!json.is_array())
            add(json, pointer);
        else
            for (std::size_t i = 0; i < json.size(); ++i) add(json[i], fmt::format("{}/{}", pointer, i));
        return found;
    }

    SheetPlan readSheet(const std::vector<SweepAxis>& axes) const {
        SheetPlan plan;
        const nlohmann::json sheet = root_.value("sheet", nlohmann::json::object());
        checkKeys(sheet, "/sheet", {"columns", "rows", "exposure", "curve", "width"});
        if (sheet.contains("rows")) plan.rows = axesAt(sheet["rows"], "/sheet/rows", axes);
        const auto inRows = [&](std::size_t axis) { return std::ranges::find(plan.rows, axis) != plan.rows.end(); };
        if (sheet.contains("columns")) {
            plan.columns = axesAt(sheet["columns"], "/sheet/columns", axes);
            for (const std::size_t axis : plan.columns)
                if (inRows(axis))
                    throw text_.error("/sheet/columns", fmt::format("'{}' is in the rows already", axes[axis].key));
        } else {
            for (std::size_t axis = axes.size(); axis-- > 0 && plan.columns.empty();)
                if (!inRows(axis)) plan.columns.push_back(axis);
        }
        // The sheet shows every cell: what it does not mention goes on in the rows.
        for (std::size_t axis = 0; axis < axes.size(); ++axis)
            if (!inRows(axis) && std::ranges::find(plan.columns, axis) == plan.columns.end()) plan.rows.push_back(axis);

        if (sheet.contains("exposure") && sheet["exposure"].is_number()) {
            const Param stops{.name = "exposure", .min = -64, .max = 64};
            plan.stops = std::get<double>(text_.value("/sheet/exposure", sheet["exposure"], stops));
        } else if (sheet.contains("exposure")) {
            const Param shared{
                .name = "exposure", .type = ParamType::choice, .choices = {"sheet", "row", "column", "cell"}};
            const std::string name = std::get<std::string>(text_.value("/sheet/exposure", sheet["exposure"], shared));
            plan.shared = static_cast<SharedExposure>(std::ranges::find(shared.choices, name) - shared.choices.begin());
        }
        if (sheet.contains("curve")) {
            const Param curve{.name = "curve", .type = ParamType::choice, .choices = {"srgb", "filmic"}};
            const bool filmic = std::get<std::string>(text_.value("/sheet/curve", sheet["curve"], curve)) == "filmic";
            plan.curve = filmic ? ToneMap::Curve::filmic : ToneMap::Curve::srgb;
        }
        if (sheet.contains("width")) {
            const Param width{.name = "width", .type = ParamType::integer, .unit = "px", .min = 16, .max = 4096};
            plan.width = static_cast<int>(std::get<double>(text_.value("/sheet/width", sheet["width"], width)));
        }
        return plan;
    }

    std::vector<SweepCell> cellsOf(const CellText& base, const std::vector<AxisValues>& axes,
                                   const Sweep& sweep) const {
        std::size_t count = 1;
        for (const AxisValues& axis : axes) count *= axis.values.size();
        std::vector<SweepCell> cells(count);
        for (std::size_t i = 0; i < count; ++i) {
            SweepCell& cell = cells[i];
            cell.number = i + 1;
            cell.choices.resize(axes.size());
            std::size_t rest = i;
            for (std::size_t axis = axes.size(); axis-- > 0; rest /= axes[axis].values.size())
                cell.choices[axis] = rest % axes[axis].values.size();
            CellText spelled = base;
            try {
                for (std::size_t axis = 0; axis < axes.size(); ++axis)
                    applyValue(axes[axis].axis.key, axes[axis].values[cell.choices[axis]], spelled);
                cell.job = jobOf(spelled);
                renderSettings(cell.job);
            } catch (const Error& error) {
                throw text_.error("/axes",
                                  fmt::format("cell {} ({}): {}", cell.number, cellName(sweep, cell), error.message),
                                  error.hint);
            }
        }
        return cells;
    }

    const JsonText& text_;
    const nlohmann::json& root_;
};

}  // namespace

Sweep parseSweep(std::string_view source, std::string_view path) {
    const JsonText text(source, path);
    return SweepReader(text).read();
}

std::string cellName(const Sweep& sweep, const SweepCell& cell) {
    std::vector<std::string> labels;
    for (std::size_t axis = 0; axis < sweep.axes.size(); ++axis)
        labels.push_back(sweep.axes[axis].labels[cell.choices[axis]]);
    return join(labels, ", ");
}

std::vector<const SweepCell*> cellsInOrder(const Sweep& sweep, std::size_t first, std::size_t step) {
    std::vector<std::size_t> axes(sweep.axes.size());
    std::iota(axes.begin(), axes.end(), std::size_t{0});
    std::ranges::stable_sort(axes, {}, [&](std::size_t axis) { return stageOf(sweep.axes[axis].key); });
    std::vector<const SweepCell*> cells;
    for (std::size_t i = first; i < sweep.cells.size(); i += step) cells.push_back(&sweep.cells[i]);
    std::ranges::stable_sort(cells, [&](const SweepCell* a, const SweepCell* b) {
        for (const std::size_t axis : axes)
            if (a->choices[axis] != b->choices[axis]) return a->choices[axis] < b->choices[axis];
        return false;
    });
    return cells;
}

}  // namespace searchlight
