#include "validate/fit_medium.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "model/plane.h"

namespace searchlight {

namespace {

constexpr const char *sigma_a = "sigma_a", *sigma_sp = "sigma_sp";

// A model that depends on the direction of exit is an integral at every point: there the means come from a table, of
// which 64 radii keep to about 1e-3.
constexpr int table_size = 64;

std::vector<double> channelOf(const std::vector<Rgb>& values) {
    std::vector<double> list;
    for (const Rgb& value : values) list.push_back(value.r);
    return list;
}

std::vector<double> valuesOf(const FittedModel& fitted, const Medium& medium, const FitData& data) {
    if (data.edges_mm.empty()) return channelOf(radialRd(*fitted.evaluator, *fitted.model, medium, 0, data.radii_mm));
    if (fitted.model->file.no_wo)
        return channelOf(annulusMeans(*fitted.evaluator, *fitted.model, medium, 0, data.edges_mm));
    const double last = data.edges_mm.back();
    const double first = std::max(data.edges_mm.front(), 0.02 * data.radii_mm.front());
    std::vector<double> radii;
    for (int i = 0; i < table_size; ++i) radii.push_back(first * std::pow(last / first, i / (table_size - 1.0)));
    radii.back() = last;
    const std::vector<Rgb> Rd = radialRd(*fitted.evaluator, *fitted.model, medium, 0, radii);
    if (std::ranges::any_of(Rd, [](const Rgb& value) { return !std::isfinite(value.r); }))
        return std::vector<double>(data.value.size(), std::nan(""));
    const Profile profile(radii, Rd);
    std::vector<double> means;
    for (std::size_t i = 0; i + 1 < data.edges_mm.size(); ++i)
        means.push_back(profile.annulusMean(data.edges_mm[i], data.edges_mm[i + 1]).r);
    return means;
}

// Mean over an annulus, or the value at a point, of A (exp(-r/d) + exp(-r/3d)) / (8 pi d r).
double burleyValue(const FitData& data, std::size_t i, double A, double d) {
    if (data.edges_mm.empty()) {
        const double r = data.radii_mm[i];
        return A * (std::exp(-r / d) + std::exp(-r / (3 * d))) / (8 * std::numbers::pi * d * r);
    }
    const double r0 = data.edges_mm[i], r1 = data.edges_mm[i + 1];
    // Differences of the encircled flux 1 - e^(-r/d)/4 - 3 e^(-r/3d)/4, without cancellation.
    const auto ring = [&](double width) { return -std::exp(-r0 / width) * std::expm1((r0 - r1) / width); };
    return A * (0.25 * ring(d) + 0.75 * ring(3 * d)) / (std::numbers::pi * (r1 - r0) * (r1 + r0));
}

const Param& numberParameter(const Model& model, const std::string& name) {
    const Param& param = findParam(model.file.parameters, name, fmt::format("parameter of {}", model.id));
    if (param.type != ParamType::number || !(param.max > 0) || param.min < 0)
        throw usageError(fmt::format("{} of {} cannot be fitted", name, model.id),
                         "expected sigma_a, sigma_sp or a number whose range is positive");
    return param;
}

}  // namespace

double medianRadius(const FitData& data) {
    double sum = 0, all = 0;
    const auto flux = [&](std::size_t i) {
        const double width = data.edges_mm.empty()
                                 ? (i + 1 < data.radii_mm.size() ? data.radii_mm[i + 1] - data.radii_mm[i] : 0)
                                 : data.edges_mm[i + 1] - data.edges_mm[i];
        return std::max(0.0, data.value[i]) * data.radii_mm[i] * width;
    };
    for (std::size_t i = 0; i < data.radii_mm.size(); ++i) all += flux(i);
    for (std::size_t i = 0; i < data.radii_mm.size(); ++i)
        if ((sum += flux(i)) >= 0.5 * all && data.radii_mm[i] > 0) return data.radii_mm[i];
    return data.radii_mm.back();
}

std::vector<std::string> freeByDefault(const Model& model) {
    if (model.measured) return {};
    if (readsMedium(model)) return {sigma_a, sigma_sp};
    std::vector<std::string> names;
    for (const Param& param : model.file.parameters)
        if (param.type == ParamType::number && param.min >= 0) names.push_back(param.name);
    return names;
}

FitCurve modelFitCurve(const FittedModel& fitted, const FitData& data) {
    const double length = medianRadius(data);
    FitCurve curve;
    std::vector<std::vector<double>> starts{{}};
    const auto vary = [&](std::initializer_list<double> values) {
        std::vector<std::vector<double>> longer;
        for (const std::vector<double>& start : starts)
            for (const double value : values) {
                longer.push_back(start);
                longer.back().push_back(value);
            }
        starts = std::move(longer);
    };
    for (const std::string& name : fitted.free) {
        if (name == sigma_a || name == sigma_sp) {
            // Half the light leaves within about a free path; albedos from 0.5 to 0.999.
            curve.parameters.push_back({name, "1/mm", 1e-8 / length, 1e4 / length});
            if (name == sigma_a)
                vary({0.001 / length, 0.02 / length, 0.3 / length});
            else
                vary({0.3 / length, 1 / length, 4 / length});
            continue;
        }
        const Param& param = numberParameter(*fitted.model, name);
        const double lower = std::max(param.min, 1e-6 * param.max);
        curve.parameters.push_back({name, param.unit, lower, param.max});
        const double standard = std::clamp(std::get<double>(param.value), lower, param.max);
        vary({standard, std::sqrt(standard * lower), std::sqrt(standard * param.max)});
    }
    curve.starts = std::move(starts);
    curve.values = [&fitted, data](std::span<const double> values) {
        Medium medium{{1, 1, 1}, {1, 1, 1}, {fitted.g, fitted.g, fitted.g}, fitted.eta, 1};
        ParamValues parameters = fitted.fixed;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::string& name = fitted.free[i];
            const double value = values[i];
            if (name == sigma_a)
                medium.sigma_a = {value, value, value};
            else if (name == sigma_sp)
                medium.sigma_s = 1 / (1 - fitted.g) * Rgb{value, value, value};
            else
                parameters[name] = value;
        }
        fitted.evaluator->set(medium, parameters);
        return valuesOf(fitted, medium, data);
    };
    return curve;
}

FitCurve burleyFitCurve(const FitData& data) {
    const double length = medianRadius(data);
    double total = 0;
    for (std::size_t i = 0; i + 1 < data.radii_mm.size(); ++i)
        total += 2 * std::numbers::pi * data.radii_mm[i] * (data.radii_mm[i + 1] - data.radii_mm[i]) *
                 std::max(0.0, data.value[i]);
    FitCurve curve;
    curve.parameters = {{"A", "", 1e-9, 1e3}, {"d", "mm", 1e-6 * length, 1e4 * length}};
    for (const double factor : {0.3, 1.0, 3.0}) curve.starts.push_back({std::max(total, 1e-6), factor * length});
    curve.values = [data](std::span<const double> values) {
        std::vector<double> means;
        for (std::size_t i = 0; i < data.value.size(); ++i) means.push_back(burleyValue(data, i, values[0], values[1]));
        return means;
    };
    return curve;
}

}  // namespace searchlight
