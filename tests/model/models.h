// Models under test, with their double-precision evaluators.
#pragma once

#include <numbers>

#include "base/csv.h"
#include "base/files.h"
#include "model/plane.h"

namespace searchlight {

constexpr double pi = std::numbers::pi;

/// The same in all channels.
inline Medium grey(double sigma_a, double sigma_s, double g, double eta) {
    return {{sigma_a, sigma_a, sigma_a}, {sigma_s, sigma_s, sigma_s}, {g, g, g}, eta, 1};
}

/// The medium with sigma_t' = 1/mm.
inline Medium ofAlbedo(double alpha_prime, double eta, double g = 0) {
    return grey(1 - alpha_prime, alpha_prime / (1 - g), g, eta);
}

struct LoadedModel {
    Model model;
    Medium medium;
    std::unique_ptr<Evaluator> evaluator;

    double Rd(double r_mm) const {
        const double radii[] = {r_mm};
        return radialRd(*evaluator, model, medium, 0, radii)[0].r;
    }
    double total() const { return totalRd(*evaluator, model, medium).r; }
    double closedForm() const { return evaluator->diffuseReflectance(medium.alphaPrime()).r; }
};

inline LoadedModel load(std::string_view id, const Medium& medium, const ParamValues& parameters = {}) {
    LoadedModel loaded{loadModel(id), medium, nullptr};
    loaded.evaluator = makeNativeEvaluator(loaded.model);
    loaded.evaluator->set(medium, parameters);
    return loaded;
}

/// A table of tests/data.
inline CsvTable table(const std::string& name) {
    const std::string path = std::string(SEARCHLIGHT_SOURCE_DIR) + "/tests/data/" + name;
    return parseCsv(readFile(path), path);
}

}  // namespace searchlight
