// Parameters of a curve that come nearest to a measured or walked profile, and how well they are known.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/observer.h"
#include "validate/least_squares.h"

namespace searchlight {

/// R_d of one channel, 1/mm^2 per unit flux that has entered: at points, or as means over annuli.
struct FitData {
    std::vector<double> radii_mm;        ///< n, ascending: points, or the middles of annuli
    std::vector<double> edges_mm;        ///< n + 1, or empty: values at points
    std::vector<double> value;           ///< n
    std::vector<double> standard_error;  ///< n, or empty: unknown
};

/// What a deviation counts against: its standard error; the value; or, of `flux`, what light there is at all:
/// deviations of 2 pi r^2 R_d add over the octaves of radius, so that neither a peak as 1/r nor a dim tail outweighs
/// the rest.
enum class FitWeight { standard_error, relative, flux };

/// "standard_error" where the data have errors, else "relative".
FitWeight naturalWeight(const FitData& data);

/// Weight of each residual; 0 for what cannot be used: no error; for `relative`, values that are not positive or carry
/// less than 1e-9 of the largest flux per octave. The weights of `flux` are such that residuals add to the squared
/// deviation over the squared mean.
std::vector<double> fitWeights(const FitData& data, FitWeight weight);

struct FitParameter {
    std::string name, unit;
    double lower = 0, upper = 0;  ///< positive: a parameter is varied as its logarithm
};

struct FitCurve {
    std::vector<FitParameter> parameters;
    std::vector<std::vector<double>> starts;  ///< at least one
    /// Values where the data are, as the data are (points or means).
    std::function<std::vector<double>(std::span<const double> parameters)> values;
};

struct FitOptions {
    FitWeight weight = FitWeight::relative;
    int best_starts = 3;  ///< how many of the starts are followed to their end
};

/// How a curve stands to the data.
struct FitResiduals {
    std::vector<double> model;     ///< the curve where the data are
    std::vector<double> relative;  ///< (model - data) / data; NaN where the data are 0
    std::vector<double> weighted;  ///< times its weight
    int used = 0;                  ///< data with a weight
    double chi2 = 0;               ///< sum of squares of `weighted`
    double rms_relative = 0;       ///< over the data that are used, known to 50 %, and of some flux
    double misplaced = 0;          ///< sum of |model - data| times area, over sum of data times area
};
/// Variance of a weighted residual: with standard errors 1, or chi2 per degree of freedom where that is larger (the
/// factor of [Birge1932]: what the model misses counts as noise); else the scatter of the residuals.
double residualVariance(FitWeight weight, double reduced_chi2);

FitResiduals residualsOf(const FitData& data, const std::vector<double>& weights, std::vector<double> model);

struct Fit {
    std::vector<double> value;
    /// From the curvature at the optimum: with standard errors as they are, otherwise with the scatter of the
    /// residuals.
    std::vector<double> standard_error;
    Matrix correlation{0, 0};
    double condition = 0;
    FitResiduals residuals;
    double reduced_chi2 = 0;            ///< chi2 over degrees of freedom
    std::vector<std::string> warnings;  ///< what a reader must know before using the numbers
    int evaluations = 0;
};

/// Minimises the sum of squared weighted residuals from the best starts, then polishes by Gauss and Newton. Throws an
/// input Error when there are fewer usable data than parameters, and interruptedError().
Fit fitCurve(const FitCurve& curve, const FitData& data, const FitOptions& options, Observer& observer);

/// Sentences about parameters that data do not determine: large errors, pairs of correlation above 0.99, ends of
/// ranges.
std::vector<std::string> fitWarnings(const std::vector<FitParameter>& parameters, const std::vector<double>& value,
                                     const Covariance& covariance, double reduced_chi2, FitWeight weight);

}  // namespace searchlight
