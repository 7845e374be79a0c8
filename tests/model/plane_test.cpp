#include "base/error.h"
#include "model/physics.h"
#include "models.h"

namespace searchlight {
namespace {

/// Answers by a formula.
class FormulaEvaluator final : public Evaluator {
public:
    explicit FormulaEvaluator(std::function<double(const Query&)> formula) : formula_(std::move(formula)) {}

    void set(const Medium&, const ParamValues&) override {}
    void evaluate(std::span<const Query> queries, std::span<Rgb> values) override {
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const double value = formula_(queries[i]);
            values[i] = {value, value, value};
        }
    }
    Rgb diffuseReflectance(Rgb) override { return {}; }
    std::string backend() const override { return "formula"; }

private:
    std::function<double(const Query&)> formula_;
};

Model modelWith(bool radial, bool no_wo) {
    Model model;
    model.file.radial = radial;
    model.file.no_wo = no_wo;
    return model;
}

double distance(const Query& query) { return length(query.xo - query.xi); }

TEST(PencilBeam, EntersByFresnel) {
    EXPECT_NEAR(pencilBeam(1.5, 0).transmittance, 0.96, 1e-15);
    EXPECT_EQ(pencilBeam(1, 70).transmittance, 1);
    EXPECT_NEAR(length(pencilBeam(1.3, 40).wi), 1, 1e-15);
}

TEST(PencilBeam, LeansTowardsPositiveX) {
    EXPECT_LT(pencilBeam(1.3, 40).wi.x, 0);
    EXPECT_GT(pencilBeam(1.3, 40).wi.z, 0);
}

TEST(PencilBeam, RefusesGrazingIncidence) { EXPECT_THROW(pencilBeam(1.3, 90), Error); }

TEST(PlaneRd, OfConstantRadianceIsThatConstant) {
    FormulaEvaluator evaluator([](const Query&) { return 0.7; });
    const Medium medium = ofAlbedo(0.9, 1.4);
    const Vec3 points[] = {{1, 2, 0}};
    // T21 has a root at grazing exit, where 24 points leave 1e-8.
    EXPECT_NEAR(planeRd(evaluator, modelWith(false, false), medium, 30, points)[0].r, 0.7, 1e-7);
}

// Q = cos: the ratio of the second to the first moment of T21.
TEST(PlaneRd, IntegratesWhatDependsOnTheDirectionOut) {
    FormulaEvaluator evaluator([](const Query& query) { return query.wo.z + 0.2 * query.wo.x; });
    const double eta = 1.4;
    const Vec3 points[] = {{1, 2, 0}};
    const double first = 0.5 - Physics<double>::fresnelMoment(1, 1 / eta);
    const double second = 1.0 / 3 - Physics<double>::fresnelMoment(2, 1 / eta);
    EXPECT_NEAR(planeRd(evaluator, modelWith(false, false), ofAlbedo(0.9, eta), 0, points)[0].r, second / first, 1e-7);
}

TEST(RadialRd, IsTheMeanOverTheAzimuth) {
    FormulaEvaluator evaluator([](const Query& query) { return std::pow(query.xo.x / distance(query), 2); });
    const double radii[] = {0.3, 2};
    for (const Rgb& mean : radialRd(evaluator, modelWith(false, true), ofAlbedo(0.9, 1), 45, radii))
        EXPECT_NEAR(mean.r, 0.5, 1e-14);
}

TEST(AnnulusMeans, IntegrateOneOverRToTheCentre) {
    FormulaEvaluator evaluator([](const Query& query) { return 1 / distance(query); });
    const double edges[] = {0, 0.5, 2};
    const std::vector<Rgb> means = annulusMeans(evaluator, modelWith(true, true), ofAlbedo(0.9, 1), 0, edges);
    EXPECT_NEAR(means[0].r, 2 / 0.5, 1e-12);
    EXPECT_NEAR(means[1].r, 2 / 2.5, 1e-12);
}

// A wide bin over a narrow profile: panels follow the profile down to any width.
TEST(AnnulusMeans, SeeANarrowPeakInAWideBin) {
    const double width = 1e-4;
    FormulaEvaluator evaluator([=](const Query& query) {
        const double r = distance(query);
        return width / (2 * pi * std::pow(r * r + width * width, 1.5));
    });
    const double edges[] = {0, 10};
    const double mean = annulusMeans(evaluator, modelWith(true, true), ofAlbedo(0.9, 1), 0, edges)[0].r;
    EXPECT_NEAR(mean * pi * 100, 1 - width / std::hypot(10, width), 1e-12);
}

TEST(AnnulusMeans, AddUpToTheTotal) {
    const LoadedModel loaded = load("directional_dipole", ofAlbedo(0.8, 1.3));
    const double edges[] = {0, 0.1, 1, 3, 10, 200};
    const std::vector<Rgb> means = annulusMeans(*loaded.evaluator, loaded.model, loaded.medium, 0, edges);
    double sum = 0;
    for (std::size_t i = 0; i < means.size(); ++i)
        sum += pi * (edges[i + 1] * edges[i + 1] - edges[i] * edges[i]) * means[i].r;
    EXPECT_NEAR(sum, loaded.total(), 1e-8);
}

TEST(AnnulusMeans, AreEmptyWithoutAnAnnulus) {
    const LoadedModel loaded = load("dipole", ofAlbedo(0.8, 1.3));
    const double edges[] = {1};
    EXPECT_TRUE(annulusMeans(*loaded.evaluator, loaded.model, loaded.medium, 0, edges).empty());
}

TEST(TotalRd, IntegratesKnownProfiles) {
    const Medium medium = ofAlbedo(0.9, 1);
    const auto total = [&](std::function<double(double)> f) {
        FormulaEvaluator evaluator([&](const Query& query) { return f(distance(query)); });
        return totalRd(evaluator, modelWith(true, true), medium).r;
    };
    EXPECT_NEAR(total([](double r) { return std::exp(-r * r / 2) / (2 * pi); }), 1, 1e-10);
    EXPECT_NEAR(total([](double r) { return std::exp(-r) / (2 * pi * r); }), 1, 1e-10);
    EXPECT_NEAR(total([](double r) { return 0.01 / (2 * pi * std::pow(r * r + 1e-4, 1.5)); }), 1, 1e-10);
}

TEST(TotalRd, OfAnObliqueBeamIsTheIntegralOverThePlane) {
    const LoadedModel loaded = load("directional_dipole", ofAlbedo(0.6, 1.3));
    // Midpoints of a fine grid; what is left is the peak at the origin and the tail.
    std::vector<Vec3> points;
    constexpr int n = 600;
    const double h = 24.0 / n;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) points.push_back({-12 + (i + 0.5) * h, -12 + (k + 0.5) * h, 0});
    double sum = 0;
    for (const Rgb& value : planeRd(*loaded.evaluator, loaded.model, loaded.medium, 45, points)) sum += h * h * value.r;
    const double total = totalRd(*loaded.evaluator, loaded.model, loaded.medium, 45).r;
    EXPECT_NEAR(sum, total, 2e-3 * total);
}

class Tabulated : public testing::TestWithParam<std::string> {};

TEST_P(Tabulated, IsAsAccurateAsStatedBetweenItsSamples) {
    for (const Medium& medium : {grey(0.0041, 2.62, 0, 1.5), grey(3, 0.08, 0, 1.3),
                                 Medium{{0.032, 0.17, 0.48}, {0.74, 0.88, 1.01}, {}, 1.3, 3}}) {
        const LoadedModel loaded = load(GetParam(), medium);
        const Tabulation table = tabulate(*loaded.evaluator, loaded.model, medium);
        EXPECT_LE(table.max_relative_error, 1e-4);
        EXPECT_LT(table.tail, 1e-6);
        EXPECT_LT(table.profile.radii().size(), 1000u);
        std::vector<double> radii;
        const double first = std::max(table.profile.radii()[0], 1e-3 / medium.sigmaTp().r);
        for (double r = first; r < table.profile.radii().back(); r *= 1.0137) radii.push_back(r);
        const std::vector<Rgb> exact = radialRd(*loaded.evaluator, loaded.model, medium, 0, radii);
        Rgb largest;
        for (std::size_t i = 0; i < radii.size(); ++i)
            for (int c = 0; c < 3; ++c) largest[c] = std::max(largest[c], radii[i] * radii[i] * exact[i][c]);
        for (std::size_t i = 0; i < radii.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                if (radii[i] * radii[i] * exact[i][c] < 1e-6 * largest[c]) continue;
                // Three probes in an interval may miss the largest error between them by a little.
                EXPECT_NEAR(table.profile(radii[i])[c] / exact[i][c], 1, 1.2e-4) << radii[i];
            }
        const Rgb total = totalRd(*loaded.evaluator, loaded.model, medium);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(table.profile.total()[c] / total[c], 1, 2e-5);
    }
}

INSTANTIATE_TEST_SUITE_P(Models, Tabulated,
                         testing::Values("dipole", "better_dipole", "normalized_diffusion", "gaussians",
                                         "directional_dipole", "quantized_diffusion", "photon_beam_diffusion_normal"));

TEST(Tabulate, LeavesAChannelThatDoesNotScatterAtZero) {
    Medium medium = ofAlbedo(0.9, 1.3);
    medium.sigma_s.b = 0;
    medium.channels = 3;
    for (const char* id : {"dipole", "directional_dipole"}) {
        const LoadedModel loaded = load(id, medium);
        const Tabulation table = tabulate(*loaded.evaluator, loaded.model, medium);
        EXPECT_EQ(table.profile.total().b, 0) << id;
        EXPECT_GT(table.profile.total().r, 0.1) << id;
    }
}

TEST(Tabulate, RefusesAModelThatIsNotFinite) {
    FormulaEvaluator evaluator([](const Query& query) { return std::sqrt(1 - distance(query)); });
    EXPECT_THROW(tabulate(evaluator, modelWith(true, true), ofAlbedo(0.9, 1)), Error);
}

}  // namespace
}  // namespace searchlight
