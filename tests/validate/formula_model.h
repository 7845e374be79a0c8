// A model made of a C++ function, so that every check can be tried without GL.
#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "base/error.h"
#include "validate/check.h"

namespace searchlight {

struct FormulaModel {
    using Value = std::function<double(const Medium&, int channel, const ParamValues&, const Query&)>;

    Model model;
    Value value;
    std::function<double(double alpha_prime)> total;

    /// A correct one: a'/2 s^2 / (2 pi) exp(-s r), which integrates to a'/2. s = 2 sigma_t'.
    FormulaModel() {
        model.id = "formula";
        model.shipped = true;
        model.file.title = "Formula";
        model.file.radial = model.file.no_wi = model.file.no_wo = model.file.reciprocal = true;
        model.file.attributes = {"radial", "no_wi", "no_wo", "reciprocal"};
        model.file.shader = {"vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return vec3(0.0); }\n", 2};
        model.file.diffuse_reflectance = {"vec3 DiffuseReflectance(vec3 A) { return 0.5 * A; }\n", 5};
        value = correct;
        total = [](double alpha_prime) { return alpha_prime / 2; };
    }

    static double correct(const Medium& medium, int channel, const ParamValues&, const Query& query) {
        const double s = 2 * medium.sigmaTp()[channel];
        const double r = length(query.xo - query.xi);
        return medium.alphaPrime()[channel] / 2 * s * s / (2 * std::numbers::pi) * std::exp(-s * r);
    }

    /// As a shipped model on a machine without GL.
    EvaluatorFactory factory() const {
        return [this](const Model&, std::string_view backend) -> std::unique_ptr<Evaluator> {
            if (backend == "gl") throw deviceError("no GL in this test");
            return std::make_unique<FormulaEvaluator>(*this);
        };
    }

private:
    struct FormulaEvaluator : Evaluator {
        explicit FormulaEvaluator(const FormulaModel& formula_) : formula(formula_) {}
        void set(const Medium& medium_, const ParamValues& parameters_) override {
            medium = medium_;
            parameters = parameters_;
        }
        void evaluate(std::span<const Query> queries, std::span<Rgb> values) override {
            for (std::size_t i = 0; i < queries.size(); ++i)
                for (int c = 0; c < Rgb::channels; ++c) values[i][c] = formula.value(medium, c, parameters, queries[i]);
        }
        Rgb diffuseReflectance(Rgb a) override { return {formula.total(a.r), formula.total(a.g), formula.total(a.b)}; }
        std::string backend() const override { return "cpu double"; }

        const FormulaModel& formula;
        Medium medium;
        ParamValues parameters;
    };
};

/// The results by the name of the check.
inline std::map<std::string, CheckResult> checksOf(const FormulaModel& formula, const ParamValues& parameters = {}) {
    Observer observer;
    std::map<std::string, CheckResult> results;
    for (const CheckResult& result : checkModel(formula.model, parameters, formula.factory(), observer))
        results[result.name] = result;
    return results;
}

/// The names of the checks with that outcome, in alphabetical order.
inline std::vector<std::string> namesOf(const std::map<std::string, CheckResult>& results,
                                        CheckResult::Outcome outcome) {
    std::vector<std::string> names;
    for (const auto& [name, result] : results)
        if (result.outcome == outcome) names.push_back(name);
    return names;
}

}  // namespace searchlight
