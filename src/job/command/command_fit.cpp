// fit: parameters of a model from a measured or walked profile.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/version.h"
#include "draw/draw.h"
#include "job/command_table.h"
#include "job/json.h"
#include "job/plot/fit_input.h"
#include "job/shared_options.h"
#include "plot/fit.h"
#include "validate/fit_gaussians.h"
#include "validate/fit_medium.h"

namespace searchlight {

namespace {

constexpr int channel_colors[] = {3, 2, 0};  // vermilion, green, blue of the palette

// What every kind of fit hands over to be shown.
struct Result {
    std::string title;  ///< of the model
    std::vector<FitResiduals> residuals;
    std::vector<double> reduced_chi2;
    std::vector<std::vector<double>> curve;  ///< [channel] at curve_mm
    Json parameters = Json::array();
    std::string table;     ///< parameters as text
    std::string settings;  ///< what a command line takes
    std::vector<std::string> warnings;
    int evaluations = 0;
};

std::string channelLabel(const ProfileData& data, std::size_t c) {
    return data.channels.size() == 1 ? std::string() : std::string(1, "RGB"[c]);
}

Json numberJson(double value) { return std::isfinite(value) ? Json(value) : Json(); }

std::string rowText(const std::string& name, double value, double error, const std::string& unit) {
    return fmt::format("  {:<14} {:>16} +- {:<12} {}\n", name, prettyNumber(value, 8), prettyNumber(error, 2), unit);
}

FitWeight weightOf(const Options& options, const ProfileData& data) {
    const std::string& name = options.text("weight");
    if (name == "relative") return FitWeight::relative;
    if (name == "flux") return FitWeight::flux;
    // A sum of Gaussians is for rendering: flux in the wrong place is what is seen.
    if (name == "auto")
        return options.text("model") == "gaussians" ? FitWeight::flux : naturalWeight(data.channels.front());
    if (data.channels.front().standard_error.empty())
        throw usageError("--weight standard_error needs data with standard errors", "relative or flux");
    return FitWeight::standard_error;
}

std::string_view weightName(FitWeight weight) {
    return weight == FitWeight::standard_error ? "standard_error" : weight == FitWeight::flux ? "flux" : "relative";
}

// Smooth curves of the fit: radii within the data's range, which in annuli goes down to 0.
FitData curvePoints(const FitData& data) {
    FitData points;
    const double last = data.radii_mm.back();
    const double first = std::max(data.edges_mm.empty() ? data.radii_mm.front() : 0.0, 1e-4 * last);
    constexpr int count = 256;
    for (int i = 0; i < count; ++i) points.radii_mm.push_back(first * std::pow(last / first, i / (count - 1.0)));
    points.value.assign(points.radii_mm.size(), 1);
    return points;
}

Result fitSum(const Options& options, const ProfileData& data, FitWeight weight, Observer& observer) {
    GaussianFitOptions wanted;
    wanted.count = static_cast<int>(options.number("count"));
    wanted.weight = weight;
    if (options.given("total")) {
        const std::vector<double>& total = options.list("total");
        for (std::size_t c = 0; c < data.channels.size(); ++c) wanted.total.push_back(total[total.size() == 1 ? 0 : c]);
    }
    const GaussianFit fit = fitGaussians(data.channels, wanted, observer);

    Result result;
    result.title = fmt::format("{} Gaussian{}", wanted.count, wanted.count == 1 ? "" : "s");
    result.residuals = fit.residuals;
    result.reduced_chi2.assign(data.channels.size(), fit.reduced_chi2);
    result.warnings = fit.warnings;
    result.evaluations = fit.evaluations;
    result.settings = "--model gaussians --set Fit=custom";
    const FitData points = curvePoints(data.channels.front());
    result.curve.assign(data.channels.size(), std::vector<double>(points.radii_mm.size()));
    for (std::size_t k = 0; k < fit.variance_mm2.size(); ++k) {
        const double v = fit.variance_mm2[k];
        Json json{{"name", fmt::format("V{}", k + 1)},
                  {"value", v},
                  {"standard_error", numberJson(fit.variance_error[k])},
                  {"unit", "mm^2"}};
        result.parameters.push_back(json);
        result.table += rowText(fmt::format("V{}", k + 1), v, fit.variance_error[k], "mm^2");
        Json weights = Json::array(), errors = Json::array();
        std::vector<std::string> texts;
        for (std::size_t c = 0; c < data.channels.size(); ++c) {
            weights.push_back(fit.weight[c][k]);
            errors.push_back(numberJson(fit.weight_error[c][k]));
            texts.push_back(numberText(fit.weight[c][k]));
            result.table += rowText(fmt::format("W{} {}", k + 1, channelLabel(data, c)), fit.weight[c][k],
                                    fit.weight_error[c][k], "");
            for (std::size_t i = 0; i < points.radii_mm.size(); ++i)
                result.curve[c][i] += fit.weight[c][k] * gaussianValue(points, i, v);
        }
        if (texts.size() == 1) texts.assign(3, texts.front());
        result.parameters.push_back(
            {{"name", fmt::format("W{}", k + 1)}, {"value", weights}, {"standard_error", errors}, {"unit", "1"}});
        result.settings += fmt::format(",V{}={},W{}={}", k + 1, numberText(v), k + 1, join(texts, ","));
    }
    // Unused terms of the model have no weight but for the first.
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
        double total = 0;
        for (const double w : fit.weight[c]) total += w;
        result.table += fmt::format("  {:<14} {:>16}\n", "total " + channelLabel(data, c), prettyNumber(total, 8));
    }
    return result;
}

Result fitModel(const Options& options, const ProfileData& data, FitWeight weight, Engine& engine, Observer& observer) {
    const bool burley = options.text("model") == "burley";
    FittedModel fitted;
    LoadedModel loaded;
    Result result;
    fitted.eta = options.given("eta") || data.eta == 0 ? options.number("eta") : data.eta;
    fitted.g = options.number("g");
    if (burley)
        result.title = "Normalized diffusion, A and d";
    else {
        Medium any{{1, 1, 1}, {1, 1, 1}, {fitted.g, fitted.g, fitted.g}, fitted.eta, 1};
        loaded = engine.load(options.text("model"), options.names("set"), options.text("backend"), any);
        fitted.model = &loaded.model;
        fitted.evaluator = loaded.evaluator.get();
        fitted.fixed = loaded.parameters;
        fitted.free = options.given("free") ? options.names("free") : freeByDefault(loaded.model);
        if (fitted.free.empty())
            throw usageError(fmt::format("{} has nothing that could be fitted", loaded.model.id),
                             "a model that reads the medium, or has parameters that are numbers");
        for (const char* name : {"sigma_a", "sigma_sp"})
            if (readsMedium(loaded.model) && std::ranges::find(fitted.free, name) == fitted.free.end())
                throw usageError(fmt::format("{} reads the medium, so {} has to be free", loaded.model.id, name),
                                 "such as --free sigma_a,sigma_sp, and a parameter of the model if wanted");
        result.title = loaded.model.file.title;
    }
    FitOptions fit_options;
    fit_options.weight = weight;
    std::vector<std::vector<std::string>> values;  // [parameter][channel]
    std::vector<FitParameter> parameters;
    Json errors_json, values_json;
    std::vector<Fit> fits;
    for (const FitData& channel : data.channels) {
        const FitCurve curve = burley ? burleyFitCurve(channel) : modelFitCurve(fitted, channel);
        parameters = curve.parameters;
        fits.push_back(fitCurve(curve, channel, fit_options, observer));
        const FitData points = curvePoints(channel);
        result.curve.push_back(
            (burley ? burleyFitCurve(points) : modelFitCurve(fitted, points)).values(fits.back().value));
    }
    for (std::size_t j = 0; j < parameters.size(); ++j) {
        Json value = Json::array(), error = Json::array();
        std::vector<std::string> texts;
        for (std::size_t c = 0; c < fits.size(); ++c) {
            value.push_back(fits[c].value[j]);
            error.push_back(numberJson(fits[c].standard_error[j]));
            texts.push_back(numberText(fits[c].value[j]));
            result.table += rowText(parameters[j].name + " " + channelLabel(data, c), fits[c].value[j],
                                    fits[c].standard_error[j], parameters[j].unit);
        }
        values.push_back(std::move(texts));
        result.parameters.push_back({{"name", parameters[j].name},
                                     {"value", value},
                                     {"standard_error", error},
                                     {"unit", parameters[j].unit.empty() ? "1" : parameters[j].unit}});
    }
    for (std::size_t c = 0; c < fits.size(); ++c) {
        for (const std::string& warning : fits[c].warnings)
            result.warnings.push_back(fits.size() == 1 ? warning : channelLabel(data, c) + ": " + warning);
        result.reduced_chi2.push_back(fits[c].reduced_chi2);
        result.evaluations += fits[c].evaluations;
        result.residuals.push_back(std::move(fits[c].residuals));
    }
    std::string set;
    bool medium = false;
    result.settings = burley ? "" : fmt::format("--model {}", options.text("model"));
    for (std::size_t j = 0; j < parameters.size(); ++j) {
        if (parameters[j].name == "sigma_a")
            result.settings += fmt::format(" --sigma-a {}", join(values[j], ",")), medium = true;
        else if (parameters[j].name == "sigma_sp") {
            std::vector<std::string> sigma_s;
            for (const Json& value : result.parameters[j]["value"])
                sigma_s.push_back(numberText(value.get<double>() / (1 - fitted.g)));
            result.settings += fmt::format(" --sigma-s {}", join(sigma_s, ",")), medium = true;
        } else if (!burley)
            set += fmt::format("{}{}={}", set.empty() ? "" : ",", parameters[j].name, values[j].front());
    }
    if (!set.empty() && fits.size() > 1)
        result.warnings.push_back(
            "each channel was fitted apart, and a model has its parameters once: the line below has "
            "those of R");
    if (medium) result.settings += fmt::format(" --g {} --eta {}", numberText(fitted.g), numberText(fitted.eta));
    if (!set.empty()) result.settings += " --set " + set;
    if (burley)
        result.settings = fmt::format("convert --from burley --A {} --d {} --eta {}", join(values[0], ","),
                                      join(values[1], ","), numberText(fitted.eta));
    return result;
}

Figure figureOf(const Result& result, const ProfileData& data, const Job& job) {
    std::vector<FitPicture> pictures;
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
        const FitData& channel = data.channels[c];
        pictures.push_back({.label = channelLabel(data, c),
                            .color = channel_colors[c],
                            .radii_mm = channel.radii_mm,
                            .edges_mm = channel.edges_mm,
                            .value = channel.value,
                            .standard_error = channel.standard_error,
                            .curve_mm = curvePoints(channel).radii_mm,
                            .curve = result.curve[c],
                            .relative = result.residuals[c].relative});
    }
    Figure figure = fitFigure(pictures, fmt::format("{}, fitted to {}", result.title, data.title), result.title);
    figure.metadata = {{"program", fmt::format("Searchlight {}", version())}, {"job", jobJson(job)}};
    return figure;
}

Json residualsJson(const FitData& data, const FitResiduals& residuals, double reduced_chi2) {
    Json relative = Json::array();
    for (const double value : residuals.relative) relative.push_back(numberJson(value));
    Json json{{"radii_mm", data.radii_mm},
              {"data", data.value},
              {"fit", residuals.model},
              {"relative", relative},
              {"weighted", residuals.weighted},
              {"used", residuals.used},
              {"rms_relative", residuals.rms_relative},
              {"misplaced", residuals.misplaced},
              {"reduced_chi2", numberJson(reduced_chi2)}};
    if (!data.edges_mm.empty()) json["edges_mm"] = data.edges_mm;
    return json;
}

JobResult runFit(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    const std::string& model = options.text("model");
    if (options.given("count") && model != "gaussians")
        throw usageError("--count belongs to --model gaussians", "leave it out");
    if (options.given("total") && model != "gaussians")
        throw usageError("--total belongs to --model gaussians", "leave it out");
    if (model == "gaussians" || model == "burley")
        for (const char* name : {"set", "free"})
            if (options.given(name))
                throw usageError(fmt::format("--{} belongs to a model with parameters", name),
                                 fmt::format("--model {} has none to choose from", model));
    ProfileData data = readFitInput(options.text("profile"), options.text("order"));
    for (FitData& channel : data.channels)
        channel = between(channel, options.number("radii_min"), options.number("radii_max"));
    if (data.channels.front().radii_mm.size() < 3)
        throw usageError("fewer than 3 data lie between --radii-min and --radii-max", "widen the range");
    const FitWeight weight = weightOf(options, data);
    const Result result = model == "gaussians" ? fitSum(options, data, weight, observer)
                                               : fitModel(options, data, weight, engine, observer);

    Json document = documentJson("searchlight-fit/1", job);
    document["model"] = model;
    document["profile"] = data.title;
    document["weight"] = weightName(weight);
    document["parameters"] = result.parameters;
    document["settings"] = result.settings;
    document["warnings"] = result.warnings;
    document["residuals"] = Json::array();
    JobResult answer;
    answer.text = fmt::format("{}, fitted to {} ({}; {} evaluations)\n{}", result.title, data.title,
                              weight == FitWeight::standard_error ? "weighted by standard errors"
                              : weight == FitWeight::flux         ? "weighted by flux"
                                                                  : "relative deviations",
                              result.evaluations, result.table);
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
        document["residuals"].push_back(residualsJson(data.channels[c], result.residuals[c], result.reduced_chi2[c]));
        answer.text +=
            fmt::format("  {:<14} rms {} % relative, {} % of the flux misplaced{}\n",
                        "residual " + channelLabel(data, c), prettyNumber(100 * result.residuals[c].rms_relative, 3),
                        prettyNumber(100 * result.residuals[c].misplaced, 3),
                        weight == FitWeight::standard_error
                            ? fmt::format(", chi2 per degree of freedom {}", prettyNumber(result.reduced_chi2[c], 3))
                            : std::string());
    }
    answer.text += fmt::format("searchlight {}{}\n", model == "burley" ? "" : "profile ", result.settings);
    for (const std::string& warning : result.warnings) observer.log(LogLevel::warning, warning);
    if (!job.output.empty()) {
        drawFigure(figureOf(result, data, job), job.output);
        document["file"] = job.output;
        observer.log(LogLevel::info, fmt::format("wrote {}", job.output));
    }
    answer.json = jsonText(document);
    return answer;
}

}  // namespace

Command fitCommand() {
    Param model = option::model();
    model.value = std::string("gaussians");
    model.doc = "gaussians, burley (A and d), a model's id or a .bssrdf file";
    return {
        .name = "fit",
        .summary = "Fit a model, or a sum of Gaussians, to a profile",
        .example = "searchlight fit --model dipole --profile measured.csv --eta 1.4 -o fit.svg",
        .options =
            {{.name = "profile",
              .type = ParamType::path,
              .doc = "a .csv profile, or the .json of profile or reference halfspace",
              .required = true},
             std::move(model),
             option::set(),
             {.name = "order",
              .type = ParamType::choice,
              .value = std::string("all"),
              .choices = {"all", "multiple", "single"},
              .doc = "which part of a reference's light; multiple is what most dipoles are for"},
             {.name = "count",
              .type = ParamType::integer,
              .min = 1,
              .max = most_gaussians,
              .value = 4.0,
              .doc = "how many Gaussians"},
             {.name = "total",
              .type = ParamType::channels,
              .min = 0,
              .max = option::unlimited,
              .value = std::vector<double>{},
              .doc = "what the weights of the Gaussians add to; absent: free",
              .exclusive = true},
             {.name = "free",
              .type = ParamType::text,
              .value = std::string(),
              .doc = "what is fitted: sigma_a, sigma_sp, parameters of the model (default: the first two, "
                     "else all)"},
             {.name = "weight",
              .type = ParamType::choice,
              .value = std::string("auto"),
              .choices = {"auto", "standard_error", "relative", "flux"},
              .doc =
                  "what a deviation counts against; auto: its standard error, else the value, and flux for gaussians"},
             {.name = "eta",
              .min = .25,
              .max = 4,
              .value = 1.3,
              .doc = "refractive index, inside over outside, unless the file states it"},
             {.name = "g", .min = -.99, .max = .99, .value = 0.0, .doc = "mean cosine, to unreduce sigma_s'"},
             {.name = "radii_min",
              .unit = "mm",
              .min = 0,
              .max = option::unlimited,
              .value = 0.0,
              .doc = "data below are left out"},
             option::radiiMax(),
             option::backend()},
        .output = "figure: .svg, .png, .pdf or .csv",
        .run = runFit};
}

}  // namespace searchlight
