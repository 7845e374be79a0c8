// Media at the ends of what a model may be given.
#pragma once

#include <string>
#include <vector>

#include "models.h"

namespace searchlight {

struct LimitCase {
    std::string name;
    Medium medium;
};

/// Whatever a shipped model is asked of these, it answers with a number.
inline std::vector<LimitCase> limitCases() {
    std::vector<LimitCase> cases{
        {"no absorption", ofAlbedo(1, 1.3)},          {"no absorption, matched", ofAlbedo(1, 1)},
        {"albedo nearly 1", ofAlbedo(1 - 1e-6, 1.3)}, {"albedo .02", ofAlbedo(0.02, 1.3)},
        {"albedo .02, matched", ofAlbedo(0.02, 1)},   {"matched", ofAlbedo(0.9, 1)},
        {"thinner inside", ofAlbedo(0.9, 0.75)},      {"dense", grey(1, 1000, 0, 1.4)},
        {"thin", grey(1e-4, 1e-2, 0, 1.4)},           {"forward", ofAlbedo(0.99, 1.33, 0.95)}};
    for (LimitCase& each : cases) each.medium.channels = 3;
    return cases;
}

/// Straight down, and 80 degrees from it: at an index below 1 that is beyond total reflection.
inline std::vector<Query> limitQueries(const Medium& medium) {
    const Vec3 up{0, 0, 1};
    const double mean_free_path = 1 / medium.sigmaTp().r;
    std::vector<Query> queries;
    for (const double angle_deg : {0.0, 80.0})
        for (const double r : {0.0, 1e-6, 1e-3, 1.0, 30.0, 1e3, 1e6})
            for (const double azimuth_deg : {0.0, 90.0, 180.0}) {
                const double angle = angle_deg * pi / 180, azimuth = azimuth_deg * pi / 180;
                const Vec3 wi{-std::sin(angle), 0, std::cos(angle)};
                const Vec3 xo{r * mean_free_path * std::cos(azimuth), r * mean_free_path * std::sin(azimuth), 0};
                queries.push_back({{}, wi, up, xo, up, up});
            }
    return queries;
}

/// Every setting of the model's choice and bool parameters, the others at their defaults.
inline std::vector<ParamValues> settings(const Model& model) {
    std::vector<ParamValues> all(1);
    for (const Param& param : model.file.parameters) {
        std::vector<ParamValue> options;
        if (param.type == ParamType::choice) options.assign(param.choices.begin(), param.choices.end());
        if (param.type == ParamType::toggle) options = {true, false};
        if (options.empty()) continue;
        std::vector<ParamValues> more;
        for (const ParamValues& values : all)
            for (const ParamValue& option : options) (more.emplace_back(values))[param.name] = option;
        all = std::move(more);
    }
    return all;
}

inline std::string settingText(const ParamValues& values) {
    std::string text;
    for (const auto& [name, value] : values) text += " " + name + "=" + valueText(value);
    return text;
}

/// Mirrored sources of a layer thinner than their distance turn the flux back (docs/errata.md).
inline bool mayBeNegative(const ParamValues& parameters) {
    const auto boundary = parameters.find("Boundary");
    return boundary != parameters.end() && boundary->second == ParamValue(std::string("extrapolated"));
}

/// At r = 0 a model may diverge, but it is never NaN; elsewhere it is finite. What is below the range of float counts
/// as 0.
inline void expectNumbers(Evaluator& evaluator, const Model& model) {
    for (const ParamValues& parameters : settings(model))
        for (const auto& [name, medium] : limitCases()) {
            evaluator.set(medium, parameters);
            const std::vector<Query> queries = limitQueries(medium);
            std::vector<Rgb> values(queries.size());
            evaluator.evaluate(queries, values);
            for (std::size_t i = 0; i < values.size(); ++i) {
                const double r = length(queries[i].xo), value = values[i].r;
                EXPECT_TRUE(r == 0 ? !std::isnan(value) : std::isfinite(value))
                    << model.id << settingText(parameters) << ", " << name << ", r " << r << " mm, wi.z "
                    << queries[i].wi.z << ": " << value;
                if (model.file.radial && !mayBeNegative(parameters)) {
                    EXPECT_GE(value, -1e-38) << model.id << settingText(parameters) << ", " << name;
                }
            }
        }
}

}  // namespace searchlight
