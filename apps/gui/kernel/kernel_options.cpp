#include "gui/kernel/kernel_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "gui/state/command_line.h"
#include "job/kernel/kernel_judged.h"
#include "kernel/signals.h"

namespace searchlight::gui {

namespace {

constexpr double largest_mm = 100;

const std::string& text(const State& state, std::string_view name) {
    return std::get<std::string>(optionOf(state, "kernel", name));
}

Rgb lengths(const State& state, std::string_view name) {
    const auto& list = std::get<std::vector<double>>(optionOf(state, "kernel", name));
    return list.size() == 3 ? Rgb{list[0], list[1], list[2]} : Rgb{list[0], list[0], list[0]};
}

Param lengthParam(std::string name, double value, std::string doc) {
    return {.name = std::move(name),
            .type = ParamType::channels,
            .unit = "mm",
            .min = 0,
            .max = largest_mm,
            .value = std::vector<double>{value},
            .doc = std::move(doc)};
}

}  // namespace

std::vector<Param> kernelOptions() {
    std::vector<std::string> names, pictures;
    for (const NamedMethod& method : namedMethods(17)) names.push_back(method.name);
    for (const Signal& signal : signals()) pictures.emplace_back(signal.name);
    return {
        {.name = "view",
         .type = ParamType::choice,
         .value = std::string("curves"),
         .choices = {"curves", "edge", "pictures", "table"},
         .doc = "the kernel beside the truth, what it makes of an edge and of pictures, or all methods"},
        {.name = "method",
         .type = ParamType::choice,
         .value = std::string("preintegrated"),
         .choices = names,
         .doc = "the kernel that is looked at"},
        {.name = "channel",
         .type = ParamType::choice,
         .value = std::string("R"),
         .choices = {"R", "G", "B"},
         .doc = "which channel curves are of"},
        {.name = "signal",
         .type = ParamType::choice,
         .value = std::string("discs"),
         .choices = pictures,
         .doc = "the light that is filtered"},
        {.name = "taps",
         .type = ParamType::choice,
         .value = std::string("17"),
         .choices = {"7", "11", "17", "25", "41"},
         .doc = "samples of each pass"},
        {.name = "truth",
         .type = ParamType::choice,
         .value = std::string("walks"),
         .choices = {"walks", "model"},
         .doc = "what kernels stand in for: the reference of 10⁶ walks, or the active model"},
        {.name = "by_hand", .type = ParamType::toggle, .value = false, .doc = "the two Gaussians are set, not fitted"},
        lengthParam("near", 0.2, "width of the near Gaussian"),
        lengthParam("far", 1, "width of the far Gaussian"),
        {.name = "near_weight", .min = 0, .max = 1, .value = 0.5, .doc = "the near Gaussian's part of the energy"},
    };
}

std::vector<NamedMethod> namedMethods(int taps) {
    std::vector<NamedMethod> list;
    for (MethodOptions& options : allMethods(taps)) {
        std::string name = options.method;
        if (name == "svd" || name == "optimised") name += fmt::format(" {}", options.rank);
        if (name == "guided") name += fmt::format(" k={:g}", options.guided.k);
        if (name == "gaussians") name += fmt::format(" {}", options.count);
        list.push_back({std::move(name), std::move(options)});
    }
    return list;
}

std::string KernelWish::truthKey() const {
    Scene scene;
    scene.material = material;
    // (Rdr, ld) is turned into coefficients by a model.
    if (of_model || material.inverted()) scene.model = model;
    return fmt::format("{} {} {}", of_model, seed, sceneJson(scene));
}

std::string KernelWish::rowKey(const std::string& row) const {
    std::string key = fmt::format("{} {}", row, taps);
    if (row == "manual" && manual)
        key += fmt::format(" {} {} {} {} {} {} {}", manual->near_mm.r, manual->near_mm.g, manual->near_mm.b,
                           manual->far_mm.r, manual->far_mm.g, manual->far_mm.b, manual->near_weight);
    return key;
}

KernelWish kernelWish(const State& state) {
    const Scene scene = sceneOf(state, state.active);
    KernelWish wish{.material = scene.material, .model = scene.model, .seed = state.seed};
    wish.of_model = text(state, "truth") == "model";
    wish.taps = std::stoi(text(state, "taps"));
    if (std::get<bool>(optionOf(state, "kernel", "by_hand")))
        wish.manual = TwoGaussians{lengths(state, "near"), lengths(state, "far"),
                                   std::get<double>(optionOf(state, "kernel", "near_weight"))};
    wish.method = text(state, "method");
    wish.view = text(state, "view");
    wish.channel = text(state, "channel") == "R" ? 0 : text(state, "channel") == "G" ? 1 : 2;
    const auto found = std::ranges::find(signals(), text(state, "signal"), &Signal::name);
    wish.signal = static_cast<std::size_t>(found - signals().begin());
    return wish;
}

void setManual(State& state, const TwoGaussians& values) {
    ParamValues& options = state.options["kernel"];
    const auto list = [](Rgb value) {
        std::vector<double> three;
        for (int c = 0; c < Rgb::channels; ++c) three.push_back(std::clamp(value[c], 0.0, largest_mm));
        return three;
    };
    options["by_hand"] = true;
    options["near"] = list(values.near_mm);
    options["far"] = list(values.far_mm);
    options["near_weight"] = std::clamp(values.near_weight, 0.0, 1.0);
}

QString kernelCommandLine(const State& state) {
    const KernelWish wish = kernelWish(state);
    if (wish.method == "manual" && wish.manual) return {};
    QString line = QStringLiteral("searchlight kernel");
    const auto add = [&](const char* flag, const std::string& value) {
        line += QStringLiteral(" %1 %2").arg(QLatin1String(flag), QString::fromStdString(value));
    };
    for (const std::string& flag : materialFlags(wish.material, &wish.model))
        line += QLatin1Char(' ') + QString::fromStdString(flag);
    for (const NamedMethod& method : namedMethods(wish.taps)) {
        if (method.name != wish.method) continue;
        add("--method", method.options.method);
        if (method.options.method == "svd" || method.options.method == "optimised")
            add("--rank", fmt::format("{}", method.options.rank));
        if (method.options.method == "guided") add("--k", fmt::format("{:g}", method.options.guided.k));
        if (method.options.method == "gaussians") add("--count", fmt::format("{}", method.options.count));
    }
    add("--taps", fmt::format("{}", wish.taps));
    if (wish.of_model) {
        add("--model", shellWord(wish.model.id));
        std::vector<std::string> settings;
        for (const auto& [name, value] : wish.model.parameters)
            settings.push_back(fmt::format("{}={}", name, valueText(value)));
        if (!settings.empty()) add("--set", shellWord(join(settings, ",")));
    } else if (wish.seed != 1) {
        add("--seed", fmt::format("{}", wish.seed));
    }
    return line + QStringLiteral(" --export hlsl");
}

}  // namespace searchlight::gui
