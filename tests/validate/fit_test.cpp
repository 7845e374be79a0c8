#include "validate/fit.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"
#include "model/plane.h"
#include "validate/fit_gaussians.h"
#include "validate/fit_medium.h"
#include "validate/minimise.h"

namespace searchlight {
namespace {

struct Loaded {
    Model model;
    std::unique_ptr<Evaluator> evaluator;
};

Loaded load(std::string_view id) {
    Loaded loaded{loadModel(id), nullptr};
    loaded.evaluator = makeNativeEvaluator(loaded.model);
    return loaded;
}

Medium grey(double sigma_a, double sigma_s, double g, double eta) {
    return {{sigma_a, sigma_a, sigma_a}, {sigma_s, sigma_s, sigma_s}, {g, g, g}, eta, 1};
}

std::vector<double> logarithmic(double from, double to, int count) {
    std::vector<double> list;
    for (int i = 0; i < count; ++i) list.push_back(from * std::pow(to / from, i / (count - 1.0)));
    return list;
}

FitData points(Loaded& loaded, const Medium& medium, const ParamValues& parameters = {}) {
    loaded.evaluator->set(medium, parameters);
    FitData data{.radii_mm = logarithmic(0.02, 20, 60)};
    for (const Rgb& value : radialRd(*loaded.evaluator, loaded.model, medium, 0, data.radii_mm))
        data.value.push_back(value.r);
    return data;
}

FitData annuli(Loaded& loaded, const Medium& medium) {
    loaded.evaluator->set(medium, {});
    FitData data;
    for (int i = 0; i <= 40; ++i) data.edges_mm.push_back(20 * std::pow(i / 40.0, 2));
    for (const Rgb& value : annulusMeans(*loaded.evaluator, loaded.model, medium, 0, data.edges_mm))
        data.value.push_back(value.r);
    for (int i = 0; i < 40; ++i)
        data.radii_mm.push_back(
            0.5 * (data.edges_mm[static_cast<std::size_t>(i)] + data.edges_mm[static_cast<std::size_t>(i) + 1]));
    return data;
}

Observer silent;

class RecoversItself : public testing::TestWithParam<std::string> {};

// A profile without noise has one optimum, where the residuals are rounding; Gauss and Newton then end on it.
TEST_P(RecoversItself, FromPointsAndFromAnnuli) {
    Loaded loaded = load(GetParam());
    const Medium medium = grey(0.032, 0.74 / 0.2, 0.8, 1.3);
    for (const FitData& data : {points(loaded, medium), annuli(loaded, medium)}) {
        const FittedModel fitted{&loaded.model, loaded.evaluator.get(), {}, 1.3, 0.8, freeByDefault(loaded.model)};
        const Fit fit = fitCurve(modelFitCurve(fitted, data), data, {}, silent);
        ASSERT_EQ(fit.value.size(), 2u);
        EXPECT_NEAR(fit.value[0] / 0.032, 1, 1e-6);
        EXPECT_NEAR(fit.value[1] / 0.74, 1, 1e-6);
        EXPECT_LT(fit.residuals.rms_relative, 1e-7);
    }
}

INSTANTIATE_TEST_SUITE_P(Models, RecoversItself, testing::Values("dipole", "better_dipole", "normalized_diffusion"));

TEST(Fit, MeansOfATabulatedModelAreGoodToThousandths) {
    Loaded loaded = load("directional_dipole");
    const Medium medium = grey(0.032, 0.74, 0, 1.3);
    const FitData data = annuli(loaded, medium);
    const FittedModel fitted{&loaded.model, loaded.evaluator.get(), {}, 1.3, 0, freeByDefault(loaded.model)};
    const Fit fit = fitCurve(modelFitCurve(fitted, data), data, {.weight = FitWeight::flux}, silent);
    EXPECT_NEAR(fit.value[0] / 0.032, 1, 5e-3);
    EXPECT_NEAR(fit.value[1] / 0.74, 1, 5e-3);
}

TEST(Fit, FindsWidthAndAlbedoOfNormalizedDiffusion) {
    Loaded loaded = load("normalized_diffusion");
    const Medium medium = grey(0.032, 0.74, 0, 1.3);
    const FitData data = annuli(loaded, medium);
    const Fit fit = fitCurve(burleyFitCurve(data), data, {}, silent);
    loaded.evaluator->set(medium, {});
    // Means over annuli are quadratures of 1e-10 on one side, closed forms on the other.
    EXPECT_NEAR(fit.value[0], loaded.evaluator->diffuseReflectance(medium.alphaPrime()).r, 1e-8);
    EXPECT_NEAR(fit.value[1], 1.045827, 1e-5);  // Eq. 8 for skin1, red
}

// Noise of 1 %, many times: the errors stated are those that occur, and 1 in 3 lies beyond one of them.
TEST(Fit, StandardErrorsAreThoseOfRepeatedNoise) {
    Loaded loaded = load("dipole");
    const FitData clean = points(loaded, grey(0.05, 1, 0, 1.4));
    const FittedModel fitted{&loaded.model, loaded.evaluator.get(), {}, 1.4, 0, {"sigma_a", "sigma_sp"}};
    std::uint32_t state = 12345;
    const auto uniform = [&] { return (state = state * 1664525u + 1013904223u) / 4294967296.0; };
    const int repetitions = 60;
    double squares[2] = {}, chi2 = 0;
    for (int k = 0; k < repetitions; ++k) {
        FitData noisy = clean;
        for (double& value : noisy.value) {
            double normal = -6;
            for (int j = 0; j < 12; ++j) normal += uniform();
            noisy.standard_error.push_back(0.01 * value);
            value *= 1 + 0.01 * normal;
        }
        const Fit fit = fitCurve(modelFitCurve(fitted, noisy), noisy,
                                 {.weight = FitWeight::standard_error, .best_starts = 1}, silent);
        squares[0] += std::pow((fit.value[0] - 0.05) / fit.standard_error[0], 2);
        squares[1] += std::pow((fit.value[1] - 1) / fit.standard_error[1], 2);
        chi2 += fit.reduced_chi2;
        EXPECT_EQ(fit.warnings.size(), 0u);
    }
    // A mean of 60 squared normal deviates is 1 +- 0.18; four of these. chi2 over 58 degrees of freedom, 60 times:
    // 1 +- 0.024, and never counted below 1 into the errors.
    for (const double sum : squares) EXPECT_NEAR(sum / repetitions, 1, 0.73);
    EXPECT_NEAR(chi2 / repetitions, 1, 0.1);
}

TEST(Fit, SaysWhatTheDataDoNotDetermine) {
    Loaded loaded = load("dipole");
    // Near the source absorption does not matter.
    FitData data = points(loaded, grey(1e-5, 1, 0, 1.3));
    for (std::size_t i = 0; i < data.value.size(); ++i) {
        data.standard_error.push_back(0.02 * data.value[i]);
        data.value[i] *= 1 + (i % 2 ? 0.02 : -0.02);
    }
    FitData near{.radii_mm = {data.radii_mm.begin(), data.radii_mm.begin() + 25},
                 .value = {data.value.begin(), data.value.begin() + 25},
                 .standard_error = {data.standard_error.begin(), data.standard_error.begin() + 25}};
    const FittedModel fitted{&loaded.model, loaded.evaluator.get(), {}, 1.3, 0, {"sigma_a", "sigma_sp"}};
    const Fit fit = fitCurve(modelFitCurve(fitted, near), near, {.weight = FitWeight::standard_error}, silent);
    EXPECT_THAT(fit.warnings, testing::Contains(testing::StartsWith("sigma_a is ill-determined")));
}

TEST(Fit, RefusesTooFewDataAndWhatCannotBeFitted) {
    Loaded loaded = load("dipole");
    const FittedModel fitted{&loaded.model, loaded.evaluator.get(), {}, 1.3, 0, {"sigma_a", "sigma_sp"}};
    const FitData two{.radii_mm = {1, 2}, .value = {1, 0.5}};
    EXPECT_THROW(fitCurve(modelFitCurve(fitted, two), two, {}, silent), Error);
    const FitData dark{.radii_mm = {1, 2, 3}, .value = {0, 0, -1}};
    EXPECT_THROW(fitCurve(modelFitCurve(fitted, dark), dark, {}, silent), Error);
    const FittedModel choice{&loaded.model, loaded.evaluator.get(), {}, 1.3, 0, {"Fresnel"}};
    EXPECT_THROW(modelFitCurve(choice, two), Error);
    EXPECT_TRUE(freeByDefault(loadModel(SEARCHLIGHT_SOURCE_DIR "/tests/data/measured_profile.csv")).empty());
}

TEST(Fit, StopsWhenAsked) {
    struct Cancelled : Observer {
        bool cancelled() const override { return true; }
    } cancelled;
    Loaded loaded = load("dipole");
    const FitData data = points(loaded, grey(0.05, 1, 0, 1.4));
    const FittedModel fitted{&loaded.model, loaded.evaluator.get(), {}, 1.4, 0, {"sigma_a", "sigma_sp"}};
    EXPECT_THROW(fitCurve(modelFitCurve(fitted, data), data, {}, cancelled), Error);
    EXPECT_THROW(fitGaussians(std::span(&data, 1), {}, cancelled), Error);
}

// The published sums of Gaussians, from samples of themselves.
TEST(FitGaussians, RecoversTheSixOfDEonAndLuebke) {
    Loaded loaded = load("gaussians");
    loaded.evaluator->set(grey(1, 1, 0, 1.3), {});
    std::vector<FitData> channels(3);
    const std::vector<double> radii = logarithmic(0.01, 10, 120);
    const std::vector<Rgb> Rd = radialRd(*loaded.evaluator, loaded.model, grey(1, 1, 0, 1.3), 0, radii);
    for (int c = 0; c < 3; ++c) {
        channels[static_cast<std::size_t>(c)].radii_mm = radii;
        for (const Rgb& value : Rd) channels[static_cast<std::size_t>(c)].value.push_back(value[c]);
    }
    const GaussianFit fit = fitGaussians(channels, {.count = 6, .weight = FitWeight::flux}, silent);
    // [dEonLuebke2007], figure 14-13.
    const double variance[] = {0.0064, 0.0484, 0.187, 0.567, 1.99, 7.41};
    const double weight[3][6] = {{0.233, 0.100, 0.118, 0.113, 0.358, 0.078},
                                 {0.455, 0.336, 0.198, 0.007, 0.004, 0.000},
                                 {0.649, 0.344, 0.000, 0.007, 0.000, 0.000}};
    for (std::size_t k = 0; k < 6; ++k) {
        EXPECT_NEAR(fit.variance_mm2[k] / variance[k], 1, 1e-9);
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(fit.weight[c][k], weight[c][k], 1e-9);
    }
    EXPECT_TRUE(fit.warnings.empty());
}

FitData ofOneGaussian() {
    FitData data{.radii_mm = logarithmic(0.1, 5, 30)};
    for (const double r : data.radii_mm) data.value.push_back(0.7 * std::exp(-r * r / 2) / (2 * 3.14159265358979));
    return data;
}

TEST(FitGaussians, SayWhenFewerWouldDo) {
    const FitData data = ofOneGaussian();
    const GaussianFit one = fitGaussians(std::span(&data, 1), {.count = 1, .weight = FitWeight::flux}, silent);
    EXPECT_NEAR(one.variance_mm2[0], 1, 1e-9);
    EXPECT_NEAR(one.weight[0][0], 0.7, 1e-9);
    const GaussianFit three = fitGaussians(std::span(&data, 1), {.count = 3, .weight = FitWeight::flux}, silent);
    EXPECT_THAT(three.warnings, testing::Contains(testing::HasSubstr("would do")));
    double total = 0;
    for (const double weight : three.weight[0]) {
        EXPECT_GE(weight, 0);
        total += weight;
    }
    EXPECT_NEAR(total, 0.7, 1e-6);
}

TEST(FitGaussians, KeepTheTotalAskedFor) {
    const FitData data = ofOneGaussian();
    const GaussianFit fit =
        fitGaussians(std::span(&data, 1), {.count = 2, .weight = FitWeight::flux, .total = {0.8}}, silent);
    EXPECT_NEAR(fit.weight[0][0] + fit.weight[0][1], 0.8, 1e-8);
}

TEST(FitGaussians, RefuseCountsAndTooFewData) {
    const FitData data = ofOneGaussian();
    EXPECT_THROW(fitGaussians(std::span(&data, 1), {.count = 0}, silent), Error);
    EXPECT_THROW(fitGaussians(std::span(&data, 1), {.count = 7}, silent), Error);
    const FitData few{.radii_mm = {1, 2, 3}, .value = {1, 0.5, 0.2}};
    EXPECT_THROW(fitGaussians(std::span(&few, 1), {.count = 2}, silent), Error);
}

TEST(LeastSquares, NonNegativeWeightsMeetTheConditionsOfTheOptimum) {
    Matrix A(6, 3);
    for (std::size_t i = 0; i < 6; ++i) {
        A(i, 0) = 1;
        A(i, 1) = static_cast<double>(i);
        A(i, 2) = static_cast<double>(i * i);
    }
    const std::vector<double> b{1, 3, 4.5, 5.5, 6, 6.2};
    // Unconstrained, the parabola opens downwards.
    EXPECT_LT(leastSquares(A, b)[2], 0);
    const std::vector<double> x = nonNegativeLeastSquares(A, b);
    EXPECT_EQ(x[2], 0);
    for (std::size_t j = 0; j < 3; ++j) {
        double gradient = 0;
        for (std::size_t i = 0; i < 6; ++i)
            gradient += A(i, j) * (A(i, 0) * x[0] + A(i, 1) * x[1] + A(i, 2) * x[2] - b[i]);
        if (x[j] > 0) {
            EXPECT_NEAR(gradient, 0, 1e-12);
        } else {
            EXPECT_GE(gradient, -1e-12);
        }
    }
}

TEST(LeastSquares, CovarianceIsTheInverseOfTheNormalMatrix) {
    Matrix J(3, 2);
    J(0, 0) = 1, J(1, 0) = 2, J(2, 0) = 0, J(0, 1) = 0, J(1, 1) = 1, J(2, 1) = 3;
    // J^T J = (5 2; 2 10), whose inverse is (10 -2; -2 5) / 46.
    const Covariance covariance = covarianceOf(J, 4);
    EXPECT_NEAR(covariance.standard_error[0], std::sqrt(4 * 10 / 46.0), 1e-14);
    EXPECT_NEAR(covariance.standard_error[1], std::sqrt(4 * 5 / 46.0), 1e-14);
    EXPECT_NEAR(covariance.correlation(0, 1), -2 / std::sqrt(50.0), 1e-14);
}

TEST(Minimise, FindsTheValleyOfRosenbrock) {
    const Minimum found = minimise(
        [](std::span<const double> x, std::span<double> gradient) {
            const double a = 1 - x[0], b = x[1] - x[0] * x[0];
            if (!gradient.empty()) gradient[0] = -2 * a - 400 * x[0] * b, gradient[1] = 200 * b;
            return a * a + 100 * b * b;
        },
        {-1.2, 1}, {-5, -5}, {5, 5}, 500);
    EXPECT_NEAR(found.x[0], 1, 1e-4);
    EXPECT_NEAR(found.x[1], 1, 1e-4);
}

TEST(Minimise, HandsOutWhatTheObjectiveThrows) {
    const Objective objective = [](std::span<const double>, std::span<double>) -> double { throw interruptedError(); };
    EXPECT_THROW(minimise(objective, {1}, {0}, {2}, 10), Error);
}

// MCML's skin1 and marble, beyond two mean free paths, where single scattering is below 3 % of the light.
struct Tally {
    FitData data;
    double sigma_a, sigma_sp, eta;
};
Tally mcml(const std::string& name, double sigma_a, double sigma_sp, double eta) {
    const std::string path = SEARCHLIGHT_SOURCE_DIR "/../shared/data/mcml/mcml_" + name + ".csv";
    const CsvTable table = parseCsv(readFile(path), path);
    Tally tally{{}, sigma_a, sigma_sp, eta};
    const double dr = table.number(1, 0) - table.number(0, 0), entered = pencilBeam(eta, 0).transmittance;
    const double path_mm = 1 / (sigma_a + sigma_sp);
    for (std::size_t i = 0; i + 1 < table.rows.size(); ++i) {
        const double r = table.number(i, 0);
        if (r < 2 * path_mm || r > 20 * path_mm) continue;
        const double error = table.number(i, 2);  // the last bins have none
        if (error > 0.05) continue;
        if (tally.data.edges_mm.empty()) tally.data.edges_mm.push_back(r - 0.5 * dr);
        tally.data.edges_mm.push_back(r + 0.5 * dr);
        tally.data.radii_mm.push_back(r);
        tally.data.value.push_back(table.number(i, 1) / entered);
        tally.data.standard_error.push_back(error * tally.data.value.back());
    }
    return tally;
}

// Decay of light far from its source in an infinite medium of isotropic scatterers, in 1/sigma_t: the root of
// alpha atanh(k) = k, [Chandrasekhar1960].
double decay(double alpha) {
    double low = 1e-9, high = 1 - 1e-12;
    for (int step = 0; step < 100; ++step) {
        const double k = 0.5 * (low + high);
        (alpha * std::atanh(k) > k ? high : low) = k;
    }
    return low;
}

TEST(Fit, OfMonteCarloSaysWhatAModelMisses) {
    if (!std::filesystem::exists(SEARCHLIGHT_SOURCE_DIR "/../shared/data/mcml"))
        GTEST_SKIP() << "the tallies of MCML are not there";
    for (const Tally& tally : {mcml("skin1_red", 0.032, 0.74, 1.3), mcml("marble_green", 0.0041, 2.62, 1.5)}) {
        double chi2[2];
        for (const int k : {0, 1}) {
            Loaded loaded = load(k == 0 ? "dipole" : "better_dipole");
            const FittedModel fitted{&loaded.model, loaded.evaluator.get(), {}, tally.eta, 0, {"sigma_a", "sigma_sp"}};
            const Fit fit =
                fitCurve(modelFitCurve(fitted, tally.data), tally.data, {.weight = FitWeight::standard_error}, silent);
            chi2[k] = fit.reduced_chi2;
            EXPECT_THAT(fit.warnings, testing::Contains(testing::HasSubstr("the model, not the noise")));
            // Twenty mean free paths are five decay lengths of skin, and one of marble: that does not tell it.
            if (tally.eta != 1.3) continue;
            const double a = fit.value[0], tp = a + fit.value[1];
            const double sigma_tr = std::sqrt(3 * a * tp * (k == 1 ? tp / (a + tp) : 1));
            const double alpha = tally.sigma_sp / (tally.sigma_a + tally.sigma_sp);
            EXPECT_NEAR(sigma_tr / (decay(alpha) * (tally.sigma_a + tally.sigma_sp)), 1, 0.02) << loaded.model.id;
        }
        // The better dipole follows the tally several times more closely; neither is right.
        EXPECT_LT(chi2[1], 0.3 * chi2[0]);
    }
}

}  // namespace
}  // namespace searchlight
