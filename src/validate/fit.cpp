#include "validate/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "base/error.h"
#include "base/text.h"
#include "validate/minimise.h"

namespace searchlight {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Of the annulus of each value; points stand for the space between the middles of their neighbours.
std::vector<double> areas(const FitData& data) {
    std::vector<double> edges = data.edges_mm;
    if (edges.empty()) {
        const std::vector<double>& r = data.radii_mm;
        edges.push_back(r.size() > 1 ? std::max(0.0, 1.5 * r[0] - 0.5 * r[1]) : 0);
        for (std::size_t i = 0; i + 1 < r.size(); ++i) edges.push_back(0.5 * (r[i] + r[i + 1]));
        edges.push_back(r.size() > 1 ? 1.5 * r.back() - 0.5 * r[r.size() - 2] : 2 * r[0]);
    }
    std::vector<double> found;
    for (std::size_t i = 0; i + 1 < edges.size(); ++i)
        found.push_back(std::numbers::pi * (edges[i + 1] * edges[i + 1] - edges[i] * edges[i]));
    return found;
}

// A relative deviation counts where the profile carries this much of the flux that it carries elsewhere.
constexpr double least_flux = 1e-9;
// A datum of a larger relative error says nothing about a ratio.
constexpr double largest_error = 0.5;

double fluxPerOctave(const FitData& data, std::size_t i) { return data.value[i] * data.radii_mm[i] * data.radii_mm[i]; }

// The problem in logarithms.
class Problem {
public:
    Problem(const FitCurve& curve, const FitData& data, std::vector<double> weights, Observer& observer)
        : curve_(curve), data_(data), weights_(std::move(weights)), observer_(observer) {}

    std::vector<double> values(std::span<const double> x) {
        if (observer_.cancelled()) throw interruptedError();
        ++evaluations;
        std::vector<double> parameters;
        for (const double log : x) parameters.push_back(std::exp(log));
        return curve_.values(parameters);
    }

    std::vector<double> residuals(std::span<const double> x) {
        std::vector<double> r = values(x);
        for (std::size_t i = 0; i < r.size(); ++i) r[i] = weights_[i] > 0 ? weights_[i] * (r[i] - data_.value[i]) : 0;
        return r;
    }

    // By central differences: 1e-5 balances their error, 1e-10, with rounding.
    Matrix jacobian(std::span<const double> x) {
        constexpr double h = 1e-5;
        Matrix J(data_.value.size(), x.size());
        std::vector<double> moved(x.begin(), x.end());
        for (std::size_t j = 0; j < x.size(); ++j) {
            moved[j] = x[j] + h;
            const std::vector<double> above = residuals(moved);
            moved[j] = x[j] - h;
            const std::vector<double> below = residuals(moved);
            moved[j] = x[j];
            for (std::size_t i = 0; i < above.size(); ++i) J(i, j) = (above[i] - below[i]) / (2 * h);
        }
        return J;
    }

    double cost(std::span<const double> x, std::span<double> gradient) {
        const std::vector<double> r = residuals(x);
        if (!gradient.empty()) {
            const Matrix J = jacobian(x);
            for (std::size_t j = 0; j < x.size(); ++j) {
                gradient[j] = 0;
                for (std::size_t i = 0; i < r.size(); ++i) gradient[j] += 2 * J(i, j) * r[i];
            }
        }
        return squares(r);
    }

    // Steps of Gauss and Newton as long as they lower the cost: quadratic where the residuals are small.
    void polish(std::vector<double>& x, const std::vector<double>& lower, const std::vector<double>& upper) {
        double best = cost(x, {});
        for (int step = 0; step < 30; ++step) {
            const std::vector<double> d = leastSquares(jacobian(x), residuals(x));
            bool better = false;
            for (double length = 1; length > 1e-3 && !better; length *= 0.5) {
                std::vector<double> next = x;
                for (std::size_t j = 0; j < x.size(); ++j)
                    next[j] = std::clamp(x[j] - length * d[j], lower[j], upper[j]);
                const double value = cost(next, {});
                if (!(value < best)) continue;
                better = best - value > 1e-14 * best;
                best = value;
                x = std::move(next);
            }
            if (!better) return;
        }
    }

    int evaluations = 0;

    static double squares(const std::vector<double>& r) {
        const double sum = std::inner_product(r.begin(), r.end(), r.begin(), 0.0);
        return std::isfinite(sum) ? sum : std::numeric_limits<double>::max();
    }

private:
    const FitCurve& curve_;
    const FitData& data_;
    std::vector<double> weights_;
    Observer& observer_;
};

}  // namespace

FitWeight naturalWeight(const FitData& data) {
    return data.standard_error.empty() ? FitWeight::relative : FitWeight::standard_error;
}

std::vector<double> fitWeights(const FitData& data, FitWeight weight) {
    const std::vector<double> area = areas(data);
    double mean_square = 0, most = 0;
    for (std::size_t i = 0; i < area.size(); ++i) {
        mean_square += area[i] * std::pow(data.radii_mm[i] * data.value[i], 2);
        most = std::max(most, fluxPerOctave(data, i));
    }
    std::vector<double> weights;
    for (std::size_t i = 0; i < data.value.size(); ++i) {
        double w = 0;
        if (weight == FitWeight::flux)
            w = data.radii_mm[i] * std::sqrt(area[i] / mean_square);
        else if (weight == FitWeight::relative)
            w = fluxPerOctave(data, i) > least_flux * most ? 1 / data.value[i] : 0;
        else if (!data.standard_error.empty() && data.standard_error[i] > 0)
            w = 1 / data.standard_error[i];
        weights.push_back(std::isfinite(w) ? w : 0);
    }
    return weights;
}

double residualVariance(FitWeight weight, double reduced_chi2) {
    return weight == FitWeight::standard_error ? std::max(1.0, reduced_chi2) : reduced_chi2;
}

FitResiduals residualsOf(const FitData& data, const std::vector<double>& weights, std::vector<double> model) {
    FitResiduals result;
    const std::vector<double> area = areas(data);
    double squares = 0, difference = 0, sum = 0, most = 0;
    int relatives = 0;
    for (std::size_t i = 0; i < model.size(); ++i) most = std::max(most, fluxPerOctave(data, i));
    for (std::size_t i = 0; i < model.size(); ++i) {
        const double deviation = model[i] - data.value[i];
        result.relative.push_back(data.value[i] != 0 ? deviation / data.value[i] : nan);
        result.weighted.push_back(weights[i] * deviation);
        difference += std::abs(deviation) * area[i];
        sum += std::abs(data.value[i]) * area[i];
        if (!(weights[i] > 0)) continue;
        ++result.used;
        result.chi2 += result.weighted.back() * result.weighted.back();
        if (!(fluxPerOctave(data, i) > least_flux * most)) continue;
        if (!data.standard_error.empty() && data.standard_error[i] > largest_error * data.value[i]) continue;
        squares += result.relative.back() * result.relative.back();
        ++relatives;
    }
    result.rms_relative = relatives > 0 ? std::sqrt(squares / relatives) : 0;
    result.misplaced = sum > 0 ? difference / sum : 0;
    result.model = std::move(model);
    return result;
}

std::vector<std::string> fitWarnings(const std::vector<FitParameter>& parameters, const std::vector<double>& value,
                                     const Covariance& covariance, double reduced_chi2, FitWeight weight) {
    std::vector<std::string> warnings;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const FitParameter& parameter = parameters[i];
        // Standard errors are those of logarithms.
        if (!(covariance.standard_error[i] < 0.5))
            warnings.push_back(fmt::format("{} is ill-determined: its standard error is {} %", parameter.name,
                                           prettyNumber(100 * covariance.standard_error[i], 3)));
        if (value[i] <= 1.0001 * parameter.lower || value[i] >= 0.9999 * parameter.upper)
            warnings.push_back(fmt::format("{} is at the end of its range", parameter.name));
        for (std::size_t j = 0; j < i; ++j)
            if (const double correlation = covariance.correlation(i, j); std::abs(correlation) > 0.99)
                warnings.push_back(fmt::format("{} and {} are determined together only: their correlation is {:.4f}",
                                               parameters[j].name, parameter.name, correlation));
    }
    // Twice the noise, in quadrature: with tens of data chance stays well below.
    if (weight == FitWeight::standard_error && reduced_chi2 > 2)
        warnings.push_back(
            fmt::format("the curve misses the data by {:.3g} standard errors (rms): the model, not the "
                        "noise, limits the fit; the errors of the parameters are times that",
                        std::sqrt(reduced_chi2)));
    return warnings;
}

Fit fitCurve(const FitCurve& curve, const FitData& data, const FitOptions& options, Observer& observer) {
    const std::vector<double> weights = fitWeights(data, options.weight);
    const auto usable = static_cast<std::size_t>(std::ranges::count_if(weights, [](double w) { return w > 0; }));
    if (usable < curve.parameters.size() + 1)
        throw inputError(fmt::format("{} data cannot determine {} parameters", usable, curve.parameters.size()),
                         "values must be positive, and their errors too where they have any");
    std::vector<double> lower, upper;
    for (const FitParameter& parameter : curve.parameters) {
        lower.push_back(std::log(parameter.lower));
        upper.push_back(std::log(parameter.upper));
    }
    Problem problem(curve, data, weights, observer);

    struct Start {
        std::vector<double> x;
        double cost;
    };
    std::vector<Start> starts;
    for (const std::vector<double>& start : curve.starts) {
        std::vector<double> x;
        for (const double value : start) x.push_back(std::log(value));
        const double cost = problem.cost(x, {});
        starts.push_back({std::move(x), cost});
    }
    std::ranges::stable_sort(starts, {}, &Start::cost);
    starts.resize(std::min(starts.size(), static_cast<std::size_t>(options.best_starts)));
    Start best{{}, std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < starts.size(); ++i) {
        observer.progress("fit", i, starts.size(), "starts");
        // Of order 1, as the tolerances of the search expect.
        const double scale = 1 / std::max(starts[i].cost, std::numeric_limits<double>::min());
        const Objective objective = [&](std::span<const double> x, std::span<double> gradient) {
            const double cost = problem.cost(x, gradient);
            for (double& slope : gradient) slope *= scale;
            return scale * cost;
        };
        Minimum found = minimise(objective, starts[i].x, lower, upper, 300);
        problem.polish(found.x, lower, upper);
        const double cost = problem.cost(found.x, {});
        if (cost < best.cost) best = {std::move(found.x), cost};
    }
    observer.progress("fit", starts.size(), starts.size(), "starts");

    Fit fit;
    fit.residuals = residualsOf(data, weights, problem.values(best.x));
    const double freedom = static_cast<double>(usable - curve.parameters.size());
    fit.reduced_chi2 = fit.residuals.chi2 / freedom;
    Covariance covariance = covarianceOf(problem.jacobian(best.x), residualVariance(options.weight, fit.reduced_chi2));
    for (const double x : best.x) fit.value.push_back(std::exp(x));
    fit.warnings = fitWarnings(curve.parameters, fit.value, covariance, fit.reduced_chi2, options.weight);
    for (std::size_t i = 0; i < fit.value.size(); ++i)
        fit.standard_error.push_back(fit.value[i] * covariance.standard_error[i]);
    fit.correlation = std::move(covariance.correlation);
    fit.condition = covariance.condition;
    fit.evaluations = problem.evaluations;
    return fit;
}

}  // namespace searchlight
