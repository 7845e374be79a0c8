// Quantized diffusion against other evaluations of its formulas, and against the limit of many Gaussians.
#include "model/physics.h"
#include "models.h"

namespace searchlight {
namespace {

const std::vector<Medium>& media() {
    static const std::vector<Medium> found = {grey(0.0041, 2.62, 0, 1.5), grey(0.032, 0.74, 0, 1.3),
                                              grey(0.01, 20, 0.9, 1.4),   ofAlbedo(0.5, 1),
                                              ofAlbedo(0.02, 1.33),       ofAlbedo(0.9, 0.75)};
    return found;
}

ParamValues gaussians(double count) { return {{"Gaussians", ParamValue(count)}}; }

// [dEonIrving2011] with erfc, exponential and subtractions as they are printed, in long double: fails far away, where
// it cancels, and at u > 100, where exp overflows.
double asPrinted(const Medium& medium, double r_mm) {
    using Real = long double;
    const Real a = medium.sigma_a.r, sp = medium.sigmaSp().r, tp = a + sp, albedo = sp / tp;
    const Real C1 = Physics<double>::fresnelMomentPublished(1, medium.eta);
    const Real C2 = Physics<double>::fresnelMomentPublished(2, medium.eta);
    const Real A = (1 + 3 * C2) / (1 - 2 * C1), C_phi = (1 - 2 * C1) / 4, C_E = (1 - 3 * C2) / 2;
    const Real D = (2 * a + sp) / (3 * tp * tp), d_e = 4 * A * D, golden = (1 + std::sqrt(Real{5})) / 2;
    const Real v0 = 5 * std::pow(Real{0.1}, -6.11L * albedo * albedo + 1.168L * albedo + 7.94L) / (sp * sp);
    Real sum = 0, begin = 0;
    for (int i = 0; i < 45; ++i) {
        const Real end = v0 / D * std::pow(golden, i), v = D * (begin + end);
        const Real weight = (std::exp(-a * begin) - std::exp(-a * end)) / a;
        begin = end;
        // Where erfc is 0 to the last of its digits the absorption has left nothing.
        if (tp * std::sqrt(v / 2) > 100) continue;
        const auto w_phi = [&](Real d) {
            return albedo * tp / 2 * std::exp(tp * d + tp * tp * v / 2) * std::erfc((d + tp * v) / std::sqrt(2 * v));
        };
        const auto w_E = [&](Real d) {
            return D * tp * (-w_phi(d) + albedo / std::sqrt(2 * Real{pi} * v) * std::exp(-d * d / (2 * v)));
        };
        const Real W = C_phi * (w_phi(0) - w_phi(d_e)) + C_E * (w_E(0) + w_E(d_e));
        sum += weight * W * std::exp(-r_mm * r_mm / (2 * v)) / (2 * Real{pi} * v);
    }
    return static_cast<double>(albedo * sum);
}

TEST(QuantizedDiffusion, HasThePublishedLadder) {
    const CsvTable values = table("beam_values.csv");
    const std::size_t column = values.find("quantized_diffusion").value();
    for (std::size_t row = 0; row < values.rows.size(); ++row) {
        const LoadedModel loaded =
            load("quantized_diffusion", grey(values.number(row, 1), values.number(row, 2), 0, values.number(row, 3)));
        // The table has 7 digits.
        const double expected = values.number(row, column);
        EXPECT_NEAR(loaded.Rd(values.number(row, 4)), expected, 1e-6 * expected);
    }
}

// Of the digits of long double the subtractions leave 10; the variances left out, of u > 100, hold less.
TEST(QuantizedDiffusion, IsTheFormulaAsPrinted) {
    for (const Medium& medium : media()) {
        const LoadedModel loaded = load("quantized_diffusion", medium);
        for (const double r : {0.0, 0.01, 0.1, 1.0, 5.0, 20.0}) {
            const double mm = r / medium.sigmaTp().r, expected = asPrinted(medium, mm);
            EXPECT_NEAR(loaded.Rd(mm) / expected, 1, 1e-9) << r << " alpha' " << medium.alphaPrime().r;
        }
    }
}

// Flux and fluence cancel: with erfc's asymptote green marble loses 5e-4 at 10 mm.
TEST(QuantizedDiffusion, KeepsItsDigitsInFloat) {
    const Medium marble = grey(static_cast<float>(0.0041), static_cast<float>(2.62), 0, 1.5);
    const LoadedModel loaded = load("quantized_diffusion", marble);
    const auto single = makeNativeEvaluator(loaded.model, Precision::single_);
    single->set(marble, {});
    for (const double r : {0.01, 0.1, 1.0, 10.0, 50.0}) {
        const double radii[] = {static_cast<float>(r)};
        EXPECT_NEAR(radialRd(*single, loaded.model, marble, 0, radii)[0].r / loaded.Rd(radii[0]), 1, 5e-6) << r;
    }
}

// Gaussians that share the time more finely come nearer to the integral over time, which is photon beam diffusion
// without its near field. A midpoint in each span of time leaves a deficit that is the same over decades of r; farther
// out absorption within a span shows, closer in the first Gaussian.
double deficitOf(double count, const Medium& medium) {
    const LoadedModel quantized = load("quantized_diffusion", medium, gaussians(count));
    const LoadedModel beam = load("photon_beam_diffusion_normal", medium, {{"NearField", ParamValue(false)}});
    double worst = 0;
    for (double r = 0.3; r < 10; r *= 1.2) {
        const double mm = r / medium.sigmaTp().r;
        worst = std::max(worst, std::abs(quantized.Rd(mm) / beam.Rd(mm) - 1));
    }
    return worst;
}

TEST(QuantizedDiffusion, IsPhotonBeamDiffusionWithoutNearFieldTo4Percent) {
    for (const Medium& medium : {grey(0.0041, 2.62, 0, 1.5), grey(0.032, 0.74, 0, 1.3)}) {
        const double deficit = deficitOf(45, medium);
        EXPECT_LT(deficit, 0.04);
        EXPECT_LT(deficitOf(60, medium), 0.7 * deficit);
        EXPECT_GT(deficitOf(30, medium), 1.5 * deficit);
    }
}

TEST(QuantizedDiffusion, TotalIsTheSumOfItsWeights) {
    for (const Medium& medium : media())
        for (const double count : {12.0, 45.0, 60.0}) {
            const LoadedModel loaded = load("quantized_diffusion", medium, gaussians(count));
            EXPECT_NEAR(loaded.total() / loaded.closedForm(), 1, 1e-11);
        }
}

// The exact integral over time and depth is that of a better dipole at every depth, whose total goes as exp(-s z):
// R = a'^2 / 2 / (1 + s) (C_E (1 + E) + C_phi / (s D) (1 - E)), E = exp(-4 A s D).
TEST(QuantizedDiffusion, TotalIsWithin3PercentOfTheIntegralOverTime) {
    for (const double albedo : {0.1, 0.5, 0.9, 0.99}) {
        const double D = (2 - albedo) / 3, s = std::sqrt((1 - albedo) / D), E = std::exp(-4 * s * D);
        const double exact = albedo * albedo / 2 / (1 + s) * (0.5 * (1 + E) + 0.25 / (s * D) * (1 - E));
        EXPECT_NEAR(load("quantized_diffusion", ofAlbedo(albedo, 1)).closedForm() / exact, 1, 0.03) << albedo;
    }
}

TEST(QuantizedDiffusion, RoundsTheNumberOfGaussians) {
    const Medium medium = ofAlbedo(0.9, 1.3);
    EXPECT_EQ(load("quantized_diffusion", medium, gaussians(44.6)).Rd(1), load("quantized_diffusion", medium).Rd(1));
    EXPECT_NE(load("quantized_diffusion", medium, gaussians(44)).Rd(1), load("quantized_diffusion", medium).Rd(1));
}

}  // namespace
}  // namespace searchlight
