#include "kernel/kernel_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/text.h"
#include "kernel/burley_width.h"
#include "model/convention/albedo_fits.h"

namespace searchlight {

namespace {

// Nine digits read back as the same float.
std::string digits(double value) { return fmt::format("{:.9g}", value); }

// GLSL and HLSL take "0" for a float, C with a suffix does not.
std::string literal(double value) {
    std::string text = digits(value);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
}

std::string comment(const KernelLabel& label, const Taps& taps, std::string_view mark) {
    std::vector<std::string> lines{
        fmt::format("Separable subsurface scattering kernel: {}", label.material),
        fmt::format("Method {}, rank {}, {} taps per pass; made from {}", label.method, taps.rank(),
                    taps.terms.empty() ? 0 : taps.terms[0].offsets_mm.size(), label.truth),
        "Units: weights are fractions of light, R, G, B; offsets are mm on the surface, to be scaled to the screen"};
    lines.insert(lines.end(), label.errors.begin(), label.errors.end());
    std::string text;
    for (std::string& line : lines) {
        // A name with a line break would end the comment.
        std::ranges::replace_if(
            line, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
        text += fmt::format("{} {}\n", mark, line);
    }
    return text;
}

std::string termComment(const Taps& taps, std::size_t t, std::string_view mark) {
    const TapTerm& term = taps.terms[t];
    std::string text =
        fmt::format("{} term {} of {}: angle_deg {}, scale {} {} {}\n", mark, t + 1, taps.rank(),
                    digits(term.angle_deg), digits(term.scale.r), digits(term.scale.g), digits(term.scale.b));
    if (term.delta != Rgb{})
        text += fmt::format("{} of the middle tap {} {} {} does not move\n", mark, digits(term.delta.r),
                            digits(term.delta.g), digits(term.delta.b));
    return text;
}

// The middle, then ascending.
std::vector<std::size_t> middleFirst(const TapTerm& term) {
    const std::size_t n = term.offsets_mm.size();
    std::vector<std::size_t> order{n / 2};
    for (std::size_t i = 0; i < n; ++i)
        if (i != n / 2) order.push_back(i);
    return order;
}

std::vector<std::size_t> oneSide(const TapTerm& term) {
    std::vector<std::size_t> order;
    for (std::size_t i = term.offsets_mm.size() / 2; i < term.offsets_mm.size(); ++i) order.push_back(i);
    return order;
}

std::string arrayName(const Taps& taps, std::size_t t) {
    return taps.rank() == 1 ? "kernel" : fmt::format("kernel_{}", t + 1);
}

struct Syntax {
    std::string_view head;  // with {name} and {count}
    std::string_view row;   // with {r} {g} {b} {x}
    std::string_view tail;
};

std::string tables(const Taps& taps, const KernelLabel& label, const Syntax& syntax,
                   std::vector<std::size_t> (*order)(const TapTerm&)) {
    std::string text = comment(label, taps, "//");
    for (std::size_t t = 0; t < taps.rank(); ++t) {
        const TapTerm& term = taps.terms[t];
        const std::vector<std::size_t> taken = order(term);
        text += termComment(taps, t, "//");
        text += fmt::format(fmt::runtime(syntax.head), fmt::arg("name", arrayName(taps, t)),
                            fmt::arg("count", taken.size()));
        for (std::size_t i = 0; i < taken.size(); ++i) {
            const Rgb weight = term.weight(taken[i]);
            text += fmt::format(fmt::runtime(syntax.row), fmt::arg("r", literal(weight.r)),
                                fmt::arg("g", literal(weight.g)), fmt::arg("b", literal(weight.b)),
                                fmt::arg("x", literal(term.offsets_mm[taken[i]])));
            text += i + 1 < taken.size() ? ",\n" : "\n";
        }
        text += syntax.tail;
    }
    return text;
}

std::string hlsl(const Taps& taps, const KernelLabel& label) {
    return tables(taps, label, {"static const float4 {name}[{count}] = {{\n", "    float4({r}, {g}, {b}, {x})", "};\n"},
                  middleFirst);
}

std::string glsl(const Taps& taps, const KernelLabel& label) {
    return tables(taps, label, {"const vec4 {name}[{count}] = vec4[](\n", "    vec4({r}, {g}, {b}, {x})", ");\n"},
                  middleFirst);
}

std::string c(const Taps& taps, const KernelLabel& label) {
    return tables(taps, label,
                  {"static const float {name}[{count}][4] = {{\n", "    {{{r}f, {g}f, {b}f, {x}f}}", "};\n"},
                  middleFirst);
}

std::string godot(const Taps& taps, const KernelLabel& label) {
    KernelLabel one_sided = label;
    one_sided.errors.push_back("One side: every tap but the first is taken at +offset and at -offset");
    return tables(taps, one_sided, {"const vec4 {name}[{count}] = vec4[](\n", "\tvec4({r}, {g}, {b}, {x})", ");\n"},
                  oneSide);
}

std::string quoted(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return result + "\"";
}

std::string json(const Taps& taps, const KernelLabel& label) {
    std::string text = fmt::format(
        "{{\n \"format\": \"searchlight-kernel/1\",\n \"material\": {},\n \"truth\": {},\n \"method\": {},\n \"rank\": "
        "{},\n \"unit\": \"mm\",\n \"notes\": [",
        quoted(label.material), quoted(label.truth), quoted(label.method), taps.rank());
    for (std::size_t i = 0; i < label.errors.size(); ++i) text += (i > 0 ? ", " : "") + quoted(label.errors[i]);
    text += "],\n \"terms\": [";
    const auto triple = [](Rgb value) {
        return fmt::format("[{}, {}, {}]", digits(value.r), digits(value.g), digits(value.b));
    };
    for (std::size_t t = 0; t < taps.rank(); ++t) {
        const TapTerm& term = taps.terms[t];
        text += fmt::format("{}\n  {{\"angle_deg\": {}, \"scale\": {}, \"delta\": {}, \"taps\": [", t > 0 ? "," : "",
                            digits(term.angle_deg), triple(term.scale), triple(term.delta));
        for (std::size_t i = 0; i < term.offsets_mm.size(); ++i)
            text += fmt::format("{}\n   {{\"offset\": {}, \"weight\": {}}}", i > 0 ? "," : "",
                                digits(term.offsets_mm[i]), triple(term.weights[i]));
        text += "]}";
    }
    return text + "\n ]\n}\n";
}

std::string color(Rgb value) { return fmt::format("{:.4g}, {:.4g}, {:.4g}", value.r, value.g, value.b); }

double largest(Rgb value) { return std::max({value.r, value.g, value.b}); }

}  // namespace

std::span<const TapsFormat> tapsFormats() {
    static constexpr std::array<TapsFormat, 5> list{{{"hlsl", "float4 arrays", hlsl},
                                                     {"glsl", "vec4 arrays", glsl},
                                                     {"c", "float arrays of four", c},
                                                     {"json", "all numbers, deltas apart", json},
                                                     {"godot", "vec4 arrays of one side", godot}}};
    return list;
}

std::span<const std::string_view> engineProfiles() {
    static constexpr std::array<std::string_view, 2> names{"unreal", "unity"};
    return names;
}

std::string engineProfile(std::string_view name, const GroundTruth& truth, const KernelLabel& label, double eta) {
    const Rgb width = burleyWidth(truth), A = truth.total();
    std::string text =
        fmt::format("# Subsurface profile: {}; made from {}\n# Normalized diffusion nearest in pictures: d = {} mm\n",
                    label.material, label.truth, color(width));
    if (name == "unreal") {
        // The engine blurs with d = mean free path / (0.6 s(A)), s of Eq. 5 (docs/converting.md); cm at a scale of 0.1.
        Rgb path_cm;
        for (int c = 0; c < Rgb::channels; ++c)
            path_cm[c] = 0.1 * 0.6 * width[c] * burleyScale(BurleyWidth::searchlight, A[c]);
        const double distance = largest(path_cm);
        return text + fmt::format(
                          "SurfaceAlbedo = {}\nMeanFreePathColor = {}\nMeanFreePathDistance = {:.4g}  # cm\n"
                          "WorldUnitScale = 0.1\nIOR = {:.4g}\n",
                          color(A), color((distance > 0 ? 1 / distance : 0) * path_cm), distance, eta);
    }
    if (name == "unity") {
        const double multiplier = largest(width);
        return text + fmt::format(
                          "# Base color of the material: {}\nScattering Color = {}\nMultiplier = {:.4g}  # mm\n"
                          "World Scale = 1\nIndex of Refraction = {:.4g}\n",
                          color(A), color((multiplier > 0 ? 1 / multiplier : 0) * width), multiplier, eta);
    }
    throw unknownName(ErrorKind::usage, "engine", name, {"unreal", "unity"});
}

}  // namespace searchlight
