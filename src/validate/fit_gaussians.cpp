#include "validate/fit_gaussians.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "base/error.h"
#include "validate/fit_medium.h"
#include "validate/minimise.h"

namespace searchlight {

namespace {

// A row that holds the sum of the weights counts this much against all data together: the total is then met to 1e-10.
constexpr double total_weight = 1e5;

// d gaussianValue / d ln v.
double gaussianSlope(const FitData& data, std::size_t i, double v) {
    if (data.edges_mm.empty()) {
        const double q = data.radii_mm[i] * data.radii_mm[i] / (2 * v);
        return std::exp(-q) * (q - 1) / (2 * std::numbers::pi * v);
    }
    const double r0 = data.edges_mm[i], r1 = data.edges_mm[i + 1], q0 = r0 * r0 / (2 * v), q1 = r1 * r1 / (2 * v);
    return (q0 * std::exp(-q0) - q1 * std::exp(-q1)) / (std::numbers::pi * (r1 - r0) * (r1 + r0));
}

using Weights = std::vector<std::vector<double>>;  // [channel][k]

class GaussianProblem {
public:
    GaussianProblem(std::span<const FitData> data, const GaussianFitOptions& options, Observer& observer)
        : data_(data), options_(options), observer_(observer) {
        for (const FitData& channel : data) scales_.push_back(fitWeights(channel, options.weight));
    }

    const std::vector<std::vector<double>>& scales() const { return scales_; }
    std::size_t count() const { return static_cast<std::size_t>(options_.count); }

    // Best weights of these variances, and the cost; the gradient is that of the cost with its weights held, since at
    // the optimum they do not matter to first order.
    double project(std::span<const double> log_v, std::span<double> gradient, Weights& weights) {
        if (observer_.cancelled()) throw interruptedError();
        ++evaluations;
        weights.assign(data_.size(), {});
        std::ranges::fill(gradient, 0);
        double cost = 0;
        for (std::size_t c = 0; c < data_.size(); ++c) {
            const Matrix A = basis(c, log_v, gaussianValue);
            const std::vector<double> b = target(c);
            weights[c] = nonNegativeLeastSquares(A, b);
            const std::vector<double> r = residual(A, weights[c], b);
            cost += std::inner_product(r.begin(), r.end(), r.begin(), 0.0);
            if (gradient.empty()) continue;
            for (std::size_t k = 0; k < count(); ++k)
                for (std::size_t i = 0; i < data_[c].value.size(); ++i)
                    gradient[k] +=
                        2 * r[i] * scales_[c][i] * weights[c][k] * gaussianSlope(data_[c], i, std::exp(log_v[k]));
        }
        return cost;
    }

    // d residual / d (ln v of all, then every weight that is not 0), channel after channel.
    Matrix jacobian(std::span<const double> log_v, const Weights& weights, std::vector<double>& r) const {
        std::size_t columns = count(), rows = 0;
        for (std::size_t c = 0; c < data_.size(); ++c) {
            rows += target(c).size();
            columns += static_cast<std::size_t>(std::ranges::count_if(weights[c], [](double w) { return w > 0; }));
        }
        Matrix J(rows, columns);
        r.clear();
        std::size_t column = count();
        for (std::size_t c = 0; c < data_.size(); ++c) {
            const std::size_t first = r.size();
            const Matrix A = basis(c, log_v, gaussianValue), S = basis(c, log_v, gaussianSlope);
            const std::vector<double> part = residual(A, weights[c], target(c));
            r.insert(r.end(), part.begin(), part.end());
            for (std::size_t k = 0; k < count(); ++k) {
                if (!(weights[c][k] > 0)) continue;
                for (std::size_t i = 0; i < part.size(); ++i) {
                    // The row of the total does not know the variances.
                    if (i < data_[c].value.size()) J(first + i, k) = weights[c][k] * S(i, k);
                    J(first + i, column) = A(i, k);
                }
                ++column;
            }
        }
        return J;
    }

    int evaluations = 0;

private:
    template <class Function>
    Matrix basis(std::size_t c, std::span<const double> log_v, const Function& function) const {
        const FitData& data = data_[c];
        Matrix A(target(c).size(), count());
        for (std::size_t k = 0; k < count(); ++k) {
            for (std::size_t i = 0; i < data.value.size(); ++i)
                A(i, k) = scales_[c][i] * function(data, i, std::exp(log_v[k]));
            if (!options_.total.empty()) A(data.value.size(), k) = totalScale(c);
        }
        return A;
    }

    std::vector<double> target(std::size_t c) const {
        std::vector<double> b;
        for (std::size_t i = 0; i < data_[c].value.size(); ++i) b.push_back(scales_[c][i] * data_[c].value[i]);
        if (!options_.total.empty()) b.push_back(totalScale(c) * options_.total[c]);
        return b;
    }

    double totalScale(std::size_t c) const {
        double squares = 0;
        for (std::size_t i = 0; i < data_[c].value.size(); ++i)
            squares += std::pow(scales_[c][i] * data_[c].value[i], 2);
        return total_weight * std::sqrt(squares) / options_.total[c];
    }

    static std::vector<double> residual(const Matrix& A, const std::vector<double>& x, const std::vector<double>& b) {
        std::vector<double> r;
        for (std::size_t i = 0; i < A.rows; ++i) {
            double sum = -b[i];
            for (std::size_t k = 0; k < A.cols; ++k) sum += A(i, k) * x[k];
            r.push_back(sum);
        }
        return r;
    }

    std::span<const FitData> data_;
    const GaussianFitOptions& options_;
    Observer& observer_;
    std::vector<std::vector<double>> scales_;
};

// Gauss and Newton on the variances, the weights following by projection.
void polish(GaussianProblem& problem, std::vector<double>& log_v, Weights& weights) {
    double best = problem.project(log_v, {}, weights);
    for (int step = 0; step < 60; ++step) {
        std::vector<double> r;
        const Matrix J = problem.jacobian(log_v, weights, r);
        const std::vector<double> d = leastSquares(J, r);
        bool better = false;
        for (double length = 1; length > 1e-4 && !better; length *= 0.5) {
            std::vector<double> next = log_v;
            for (std::size_t k = 0; k < next.size(); ++k) next[k] -= length * std::clamp(d[k], -1.0, 1.0);
            Weights trial;
            const double cost = problem.project(next, {}, trial);
            if (!(cost < best)) continue;
            better = best - cost > 1e-13 * best;
            best = cost;
            log_v = std::move(next);
            weights = std::move(trial);
        }
        if (!better) return;
    }
}

void checkData(std::span<const FitData> data, const GaussianFitOptions& options) {
    if (options.count < 1 || options.count > most_gaussians)
        throw usageError(fmt::format("{} Gaussians", options.count), fmt::format("expected 1 to {}", most_gaussians));
    for (const FitData& channel : data) {
        const std::vector<double> weights = fitWeights(channel, options.weight);
        const auto usable = std::ranges::count_if(weights, [](double w) { return w > 0; });
        if (usable < 2 * options.count + 1)
            throw inputError(fmt::format("{} data cannot determine {} Gaussians", usable, options.count),
                             "values must be positive, and their errors too where they have any");
    }
}

// Variances by non-negative least squares on a fine grid of them, whose few weights that are not 0 stand in pairs about
// the variances that the data are made of.
std::vector<double> gridStart(std::span<const FitData> data, const GaussianFitOptions& options, double low,
                              double high) {
    constexpr int grid_size = 40;
    GaussianFitOptions fine = options;
    fine.count = grid_size;
    fine.total.clear();
    Observer silent;
    GaussianProblem problem(data, fine, silent);
    std::vector<double> log_v;
    for (int k = 0; k < grid_size; ++k) log_v.push_back(std::lerp(low, high, k / (grid_size - 1.0)));
    Weights weights;
    problem.project(log_v, {}, weights);

    struct Cluster {
        double weight = 0, moment = 0;  // sum of weights, and of weights times ln v
        double center() const { return moment / weight; }
    };
    std::vector<Cluster> clusters;
    bool before = false;
    for (std::size_t k = 0; k < log_v.size(); ++k) {
        double weight = 0;
        for (const std::vector<double>& channel : weights)
            weight += channel[k] / std::max(1e-300, std::accumulate(channel.begin(), channel.end(), 0.0));
        if (weight > 1e-9) {
            if (!before) clusters.emplace_back();
            clusters.back().weight += weight;
            clusters.back().moment += weight * log_v[k];
        }
        before = weight > 1e-9;
    }
    while (clusters.size() > static_cast<std::size_t>(options.count)) {
        // The nearest two become one, light ones first.
        std::size_t nearest = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k + 1 < clusters.size(); ++k) {
            const double loss = std::min(clusters[k].weight, clusters[k + 1].weight) *
                                std::pow(clusters[k + 1].center() - clusters[k].center(), 2);
            if (loss < least) least = loss, nearest = k;
        }
        clusters[nearest].weight += clusters[nearest + 1].weight;
        clusters[nearest].moment += clusters[nearest + 1].moment;
        clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(nearest) + 1);
    }
    std::vector<double> start;
    for (const Cluster& cluster : clusters) start.push_back(cluster.center());
    // Too few: the widest gap, or the one center, is split.
    while (start.size() < static_cast<std::size_t>(options.count)) {
        std::size_t at = 0;
        for (std::size_t k = 0; k + 1 < start.size(); ++k)
            if (start[k + 1] - start[k] > start[at + 1] - start[at]) at = k;
        const double middle = start.size() > 1 ? 0.5 * (start[at] + start[at + 1])
                              : start.empty()  ? 0.5 * (low + high)
                                               : start[0] + 1;
        start.push_back(middle);
        std::ranges::sort(start);
    }
    return start;
}

// Standard errors, and what the data do not say.
void judge(GaussianFit& fit, std::span<const double> log_v, const Matrix& J, double variance) {
    const Covariance covariance = covarianceOf(J, variance);
    fit.condition = covariance.condition;
    const std::size_t n = fit.variance_mm2.size();
    for (std::size_t k = 0; k < n; ++k) {
        fit.variance_error.push_back(std::exp(log_v[k]) * covariance.standard_error[k]);
        if (!(covariance.standard_error[k] < 0.5))
            fit.warnings.push_back(
                fmt::format("the variance {:.4g} mm^2 is ill-determined: its standard error is {:.3g} %",
                            fit.variance_mm2[k], 100 * covariance.standard_error[k]));
        if (k > 0 && log_v[k] - log_v[k - 1] < 0.1)
            fit.warnings.push_back(
                fmt::format("the variances {:.4g} and {:.4g} mm^2 are nearly one: fewer Gaussians "
                            "would do",
                            fit.variance_mm2[k - 1], fit.variance_mm2[k]));
        if (std::ranges::all_of(fit.weight, [&](const std::vector<double>& w) { return w[k] == 0; }))
            fit.warnings.push_back(
                fmt::format("the Gaussian of variance {:.4g} mm^2 has no weight: fewer would do", fit.variance_mm2[k]));
    }
    std::size_t column = n;
    for (std::size_t c = 0; c < fit.weight.size(); ++c) {
        fit.weight_error.emplace_back(n, 0);
        for (std::size_t k = 0; k < n; ++k)
            if (fit.weight[c][k] > 0) fit.weight_error[c][k] = covariance.standard_error[column++];
    }
}

}  // namespace

double gaussianValue(const FitData& data, std::size_t i, double v) {
    if (data.edges_mm.empty())
        return std::exp(-data.radii_mm[i] * data.radii_mm[i] / (2 * v)) / (2 * std::numbers::pi * v);
    const double r0 = data.edges_mm[i], r1 = data.edges_mm[i + 1], area = (r1 - r0) * (r1 + r0);
    return -std::exp(-r0 * r0 / (2 * v)) * std::expm1(-area / (2 * v)) / (std::numbers::pi * area);
}

GaussianFit fitGaussians(std::span<const FitData> data, const GaussianFitOptions& options, Observer& observer) {
    checkData(data, options);
    GaussianProblem problem(data, options, observer);
    const std::vector<double>& radii = data.front().radii_mm;
    const double first = radii.front() > 0 ? radii.front() : radii[1], last = radii.back();
    const std::size_t n = problem.count();
    // A Gaussian narrower than the first radius, or wider than the last by much, is seen by no datum.
    const double low = std::log(0.01 * first * first), high = std::log(last * last);
    const double median = std::log(std::pow(medianRadius(data.front()), 2));
    std::vector<std::vector<double>> starts;
    for (const double from : {std::log(0.25 * first * first), 0.5 * (low + median)})
        for (const double to : {std::log(0.02 * last * last), std::log(0.12 * last * last)}) {
            std::vector<double> start;
            for (std::size_t k = 0; k < n; ++k)
                start.push_back(n == 1 ? median
                                       : std::lerp(from, to, static_cast<double>(k) / static_cast<double>(n - 1)));
            std::ranges::sort(start);
            starts.push_back(std::move(start));
        }

    starts.push_back(gridStart(data, options, low, high));

    std::vector<double> best;
    Weights best_weights;
    double best_cost = std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s < starts.size(); ++s) {
        observer.progress("fit", s, starts.size(), "starts");
        Weights weights;
        const double scale = 1 / std::max(problem.project(starts[s], {}, weights), std::numeric_limits<double>::min());
        const Objective objective = [&](std::span<const double> x, std::span<double> gradient) {
            Weights ignored;
            const double cost = problem.project(x, gradient, ignored);
            for (double& slope : gradient) slope *= scale;
            return scale * cost;
        };
        std::vector<double> log_v = minimise(objective, starts[s], std::vector(n, low), std::vector(n, high), 400).x;
        polish(problem, log_v, weights);
        std::ranges::sort(log_v);
        const double cost = problem.project(log_v, {}, weights);
        if (cost >= best_cost) continue;
        best_cost = cost;
        best = std::move(log_v);
        best_weights = std::move(weights);
    }
    observer.progress("fit", starts.size(), starts.size(), "starts");

    GaussianFit fit;
    for (const double log_v : best) fit.variance_mm2.push_back(std::exp(log_v));
    fit.weight = best_weights;
    double chi2 = 0;
    int used = 0;
    for (std::size_t c = 0; c < data.size(); ++c) {
        std::vector<double> model(data[c].value.size());
        for (std::size_t i = 0; i < model.size(); ++i)
            for (std::size_t k = 0; k < n; ++k)
                model[i] += fit.weight[c][k] * gaussianValue(data[c], i, fit.variance_mm2[k]);
        fit.residuals.push_back(residualsOf(data[c], problem.scales()[c], std::move(model)));
        chi2 += fit.residuals.back().chi2;
        used += fit.residuals.back().used;
    }
    std::vector<double> r;
    const Matrix J = problem.jacobian(best, fit.weight, r);
    fit.reduced_chi2 = chi2 / std::max(1.0, used - static_cast<double>(J.cols));
    judge(fit, best, J, residualVariance(options.weight, fit.reduced_chi2));
    fit.evaluations = problem.evaluations;
    return fit;
}

}  // namespace searchlight
