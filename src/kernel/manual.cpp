#include "kernel/manual.h"

#include <array>

#include "base/error.h"
#include "kernel/gaussians.h"

namespace searchlight {

SeparableKernel twoGaussians(const TwoGaussians& options) {
    SeparableKernel kernel{.method = "manual", .terms = std::vector<KernelTerm>(1)};
    for (int c = 0; c < Rgb::channels; ++c) {
        const std::array<double, 2> weights{options.near_weight, 1 - options.near_weight};
        const std::array<double, 2> variances{options.near_mm[c] * options.near_mm[c],
                                              options.far_mm[c] * options.far_mm[c]};
        LineKernel& line = kernel.terms[0].lines[static_cast<std::size_t>(c)] = gaussianLine(weights, variances);
        kernel.extent_mm = std::max(kernel.extent_mm, line.extent());
    }
    return kernel;
}

std::span<const TwoGaussiansPreset> twoGaussiansPresets() {
    static constexpr std::array<TwoGaussiansPreset, 5> presets{
        {{"apple", {{0.0495, 0.0455, 0.0372}, {1.1, 1.08, 0.926}, 0.368}},
         {"ketchup", {{0.0907, 0.0331, 0.0331}, {1.5, 0.118, 0.0966}, 0.665}},
         {"marble", {{0.0371, 0.0207, 0.015}, {0.663, 0.616, 0.558}, 0.234}},
         {"skin1", {{0.429, 0.211, 0.03}, {1.15, 0.69, 0.471}, 0.533}},
         {"whole_milk", {{0.0846, 0.0846, 0.0583}, {1.5, 1.39, 1.17}, 0.407}}}};
    return presets;
}

const TwoGaussians& twoGaussiansPreset(std::string_view material) {
    std::vector<std::string> names;
    for (const TwoGaussiansPreset& preset : twoGaussiansPresets()) {
        if (preset.material == material) return preset.values;
        names.emplace_back(preset.material);
    }
    throw unknownName(ErrorKind::usage, "set of two Gaussians", material, names);
}

}  // namespace searchlight
