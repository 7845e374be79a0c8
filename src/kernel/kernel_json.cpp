#include <fmt/format.h>

#include "base/error.h"
#include "kernel/kernel_rows.h"
#include "scene/json_text.h"

namespace searchlight {

namespace {

using Json = nlohmann::json;

class KernelJson {
public:
    KernelJson(std::string_view text, std::string_view path) : json_(text, path) {}

    std::vector<KernelTable> run() const {
        const Json& root = json_.root();
        // An export has "terms" with "taps" of their own; what --json prints has "taps" for terms.
        const std::string key = root.contains("terms") ? "terms" : "taps";
        const Json& terms = member(root, "", key);
        const std::string at = "/" + key;
        if (!terms.is_array() || terms.empty() || terms.size() > most_kernel_tables)
            throw json_.error(at, fmt::format("expected 1 to {} terms", most_kernel_tables));
        std::vector<KernelTable> tables;
        for (std::size_t t = 0; t < terms.size(); ++t)
            tables.push_back(
                term(terms[t], fmt::format("{}/{}", at, t), static_cast<int>(t + 1), static_cast<int>(terms.size())));
        return tables;
    }

private:
    const Json& member(const Json& parent, const std::string& at, const char* key) const {
        return member(parent, at, std::string(key));
    }
    const Json& member(const Json& parent, const std::string& at, const std::string& key) const {
        if (!parent.is_object() || !parent.contains(key))
            throw json_.error(at, fmt::format("there is no \"{}\"", key), "expected the JSON of kernel --export json");
        return parent[key];
    }

    double number(const Json& value, const std::string& at) const {
        if (!value.is_number()) throw json_.error(at, "this is no number");
        return value.get<double>();
    }

    Rgb triple(const Json& value, const std::string& at) const {
        if (!value.is_array() || value.size() != 3) throw json_.error(at, "expected [R, G, B]");
        return {number(value[0], at + "/0"), number(value[1], at + "/1"), number(value[2], at + "/2")};
    }

    KernelTable term(const Json& from, const std::string& at, int index, int count) const {
        KernelTable table{.line = json_.error(at, {}).line, .index = index, .count = count};
        table.term.angle_deg = number(member(from, at, "angle_deg"), at + "/angle_deg");
        table.term.scale = triple(member(from, at, "scale"), at + "/scale");
        const Rgb delta = triple(member(from, at, "delta"), at + "/delta");
        std::vector<KernelRow> rows;
        const auto add = [&](double offset, Rgb weight) {
            if (offset == 0) weight = weight + delta;
            rows.push_back({{weight.r, weight.g, weight.b, offset}, 1});
        };
        const bool apart = from.contains("taps");
        const Json& offsets = member(from, at, apart ? "taps" : "offsets_mm");
        if (!offsets.is_array() || offsets.size() < 3 || offsets.size() > most_kernel_taps)
            throw json_.error(at, fmt::format("expected 3 to {} taps", most_kernel_taps));
        for (std::size_t i = 0; apart && i < offsets.size(); ++i) {
            const std::string tap = fmt::format("{}/taps/{}", at, i);
            add(number(member(offsets[i], tap, "offset"), tap + "/offset"),
                triple(member(offsets[i], tap, "weight"), tap + "/weight"));
        }
        if (!apart) {
            const Json& weights = member(from, at, "weights");
            if (!weights.is_array() || weights.size() != offsets.size())
                throw json_.error(at + "/weights", "expected as many weights as offsets");
            for (std::size_t i = 0; i < offsets.size(); ++i)
                add(number(offsets[i], fmt::format("{}/offsets_mm/{}", at, i)),
                    triple(weights[i], fmt::format("{}/weights/{}", at, i)));
        }
        const KernelTable head = table;
        try {
            return tableOfRows(head, rows);
        } catch (const Error& error) {
            throw json_.error(at, error.message, error.hint);
        }
    }

    JsonText json_;
};

}  // namespace

std::vector<KernelTable> kernelTablesOfJson(std::string_view text, std::string_view path) {
    return KernelJson(text, path).run();
}

}  // namespace searchlight
