#include "job/reference/slab_json.h"

#include <fmt/format.h>

#include <cmath>

#include "job/beam_option.h"

namespace searchlight {

namespace {

Json estimateJson(const Estimate& e) { return {{"mean", e.mean}, {"stderr", e.standard_error}}; }

Json seriesJson(const SlabSeries& series, const char* unit) {
    return {{"unit", unit}, {"mean", series.mean}, {"stderr", series.standard_error}};
}

Json layersJson(const SlabProblem& problem, const SlabResult& result) {
    Json layers = Json::array();
    for (std::size_t i = 0; i < problem.layers.size(); ++i) {
        const SlabLayer& layer = problem.layers[i];
        layers.push_back(
            {{"n", layer.n},
             {"sigma_a", layer.sigma_a},
             {"sigma_s", layer.sigma_s},
             {"g", layer.meanCosine()},
             {"phase", layer.phase ? "table" : "henyey_greenstein"},
             {"thickness_mm", std::isinf(layer.thickness_mm) ? Json("infinite") : Json(layer.thickness_mm)},
             {"absorbed", estimateJson(result.A_layer[i])}});
    }
    return layers;
}

// Totals of a walk; of a solution with more digits, and without what walks alone know.
std::string totalsText(const SlabProblem& problem, const SlabResult& result, bool exact) {
    std::string text = fmt::format("{:<26} {:.{}f}\n", "specular reflectance", result.specular, exact ? 9 : 6);
    const auto line = [&](const std::string& what, const Estimate& e) {
        text += exact ? fmt::format("{:<26} {:.9f} +- {:.0e}\n", what, e.mean, e.standard_error)
                      : fmt::format("{:<26} {:.6f} +- {:.6f}\n", what, e.mean, e.standard_error);
    };
    line("diffuse reflectance", result.R);
    if (!exact) line("  scattered once", result.R_single);
    if (result.R_unscattered.mean > 0) line("unscattered reflectance", result.R_unscattered);
    line("diffuse transmittance", result.T);
    line("unscattered transmittance", result.T_unscattered);
    line("absorbed", result.A);
    for (std::size_t i = 0; i < problem.layers.size() && problem.layers.size() > 1; ++i)
        line(fmt::format("  in layer {}", i + 1), result.A_layer[i]);
    return text;
}

// What a walk and a solution have in common; before the profiles.
Json totalsJson(const SlabProblem& problem, const SlabResult& result) {
    Json json;
    json["n_above"] = problem.n_above;
    json["n_below"] = problem.n_below;
    json["angle_deg"] = problem.angle_deg;
    json["beam"] = {{"shape", nameOf(problem.beam.kind)}, {"radius_mm", problem.beam.radius}};
    json["layers"] = layersJson(problem, result);
    json["specular"] = result.specular;
    json["R"] = estimateJson(result.R);
    json["R_unscattered"] = estimateJson(result.R_unscattered);
    json["T"] = estimateJson(result.T);
    json["T_unscattered"] = estimateJson(result.T_unscattered);
    json["A"] = estimateJson(result.A);
    return json;
}

}  // namespace

Json slabJson(const SlabProblem& problem, const SlabOptions& options, const SlabResult& result) {
    Json json = totalsJson(problem, result);
    json["R_single"] = estimateJson(result.R_single);
    json["R_multiple"] = estimateJson(result.R_multiple);
    json["edges_mm"] = options.edges_mm;
    json["R_r"] = seriesJson(result.R_r, "1/mm^2");
    json["R_r_single"] = seriesJson(result.R_r_single, "1/mm^2");
    json["R_r_multiple"] = seriesJson(result.R_r_multiple, "1/mm^2");
    json["T_r"] = seriesJson(result.T_r, "1/mm^2");
    json["angles"] = options.angles;
    json["R_a"] = seriesJson(result.R_a, "1/sr");
    json["T_a"] = seriesJson(result.T_a, "1/sr");
    json["depths"] = options.depths;
    json["depth_mm"] = options.depth_mm;
    json["A_z"] = seriesJson(result.A_z, "1/mm");
    json["fluence_z"] = seriesJson(result.fluence_z, "1");
    if (options.maps) {
        json["maps"] = {{"order", "row-major, the annulus first, then angle or depth"},
                        {"R_ra", seriesJson(result.R_ra, "1/(mm^2 sr)")},
                        {"T_ra", seriesJson(result.T_ra, "1/(mm^2 sr)")},
                        {"A_rz", seriesJson(result.A_rz, "1/mm^3")},
                        {"fluence_rz", seriesJson(result.fluence_rz, "1/mm^2")}};
    }
    if (options.grid > 0) {
        json["grid"] = {{"cells", options.grid},
                        {"extent_mm", options.grid_extent_mm},
                        {"order", "row-major over y then x"},
                        {"R_xy", seriesJson(result.R_xy, "1/mm^2")},
                        {"T_xy", seriesJson(result.T_xy, "1/mm^2")}};
    }
    json["walks"] = result.walks;
    json["collisions"] = result.collisions;
    json["seconds"] = result.seconds;
    json["threads"] = result.threads;
    json["instruction_set"] = result.instruction_set;
    return json;
}

std::string slabText(const SlabProblem& problem, const SlabResult& result) {
    std::string text = totalsText(problem, result, false);
    if (result.walks > 0)
        text += fmt::format("{:.3g} walks/s on {}, {:.3g} s\n", static_cast<double>(result.walks) / result.seconds,
                            result.instruction_set.starts_with("GL ")
                                ? result.instruction_set
                                : fmt::format("{} threads ({})", result.threads, result.instruction_set),
                            result.seconds);
    return text;
}

Json exactSlabJson(const SlabProblem& problem, const SlabOptions& options, const SlabResult& result) {
    Json json = totalsJson(problem, result);
    if (!result.R_r.mean.empty()) {
        json["edges_mm"] = options.edges_mm;
        json["R_r"] = seriesJson(result.R_r, "1/mm^2");
        json["T_r"] = seriesJson(result.T_r, "1/mm^2");
    }
    json["angles"] = options.angles;
    json["R_a"] = seriesJson(result.R_a, "1/sr");
    json["T_a"] = seriesJson(result.T_a, "1/sr");
    json["seconds"] = result.seconds;
    json["threads"] = result.threads;
    return json;
}

std::string exactSlabText(const SlabProblem& problem, const SlabResult& result) {
    return totalsText(problem, result, true) +
           fmt::format("{:.3g} s; +- estimates the numerical error; profiles and angles are in --json\n",
                       result.seconds);
}

}  // namespace searchlight
