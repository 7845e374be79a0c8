#include "model/convention/convention.h"

#include "base/error.h"
#include "models.h"

namespace searchlight {
namespace {

const Medium skin1{{0.032, 0.17, 0.48}, {0.74, 0.88, 1.01}, {}, 1.3, 3};
const Medium marble{{0.0021, 0.0041, 0.0071}, {2.19, 2.62, 3.00}, {}, 1.5, 3};

// A context whose model is the classical dipole.
class Conventions : public testing::Test {
protected:
    void SetUp() override {
        context.evaluator = dipole.evaluator.get();
        context.model = &dipole.model;
    }
    WrittenConvention write(const char* id, const Medium& medium) const {
        return writeConvention(findConvention(id), medium, context);
    }
    Medium read(const char* id, const ConventionValues& values) const {
        return readConvention(findConvention(id), values, context);
    }
    std::string message(const char* id, const ConventionValues& values) const {
        try {
            read(id, values);
        } catch (const Error& error) {
            return error.what();
        }
        return "accepted";
    }

    LoadedModel dipole = load("dipole", skin1);
    ConventionContext context;
};

void expectSame(const Medium& a, const Medium& b, double tolerance, const std::string& what) {
    for (int c = 0; c < a.channels; ++c) {
        EXPECT_NEAR(b.sigma_a[c] / a.sigma_a[c], 1, tolerance) << what;
        EXPECT_NEAR(b.sigmaSp()[c] / a.sigmaSp()[c], 1, tolerance) << what;
    }
    EXPECT_EQ(a.channels, b.channels) << what;
    EXPECT_DOUBLE_EQ(a.eta, b.eta) << what;
}

// Every mapping is a bijection on what its fit reaches. Bisections end within a bit of s, and sigma_a is s^2; the
// model's own inversion bisects totals that agree to 1e-12.
TEST_F(Conventions, GiveTheReducedMediumBack) {
    Medium thick = marble;
    thick.g = {0.7, 0.7, 0.7};
    thick.sigma_s = 1 / 0.3 * marble.sigma_s;
    for (const double unit_mm : {1.0, 25.4})
        for (const BurleyWidth width :
             {BurleyWidth::searchlight, BurleyWidth::diffuse, BurleyWidth::diffuse_mean_free_path}) {
            context.unit_mm = unit_mm;
            context.width = width;
            for (const Convention& convention : conventions())
                for (const Medium* medium : {&skin1, static_cast<const Medium*>(&thick)}) {
                    const WrittenConvention written = writeConvention(convention, *medium, context);
                    // Albedos of marble are beyond the fit of Chiang: said below.
                    if (convention.id == "chiang" && medium == &thick) continue;
                    expectSame(*medium, readConvention(convention, written.values, context), 1e-9, convention.id);
                    EXPECT_LT(readBackError(convention, *medium, written, context), 1e-9) << convention.id;
                }
        }
}

TEST_F(Conventions, ValuesComeBackThroughAnother) {
    const ConventionValues cycles{{"base_color", {0.8, 0.5, 0.3}},
                                  {"subsurface_radius", {1, 0.2, 0.1}},
                                  {"subsurface_scale", {0.05}},
                                  {"subsurface_anisotropy", {0.4}},
                                  {"ior", {1.4}}};
    context.unit_mm = 1000;
    for (const char* other : {"openpbr", "standard_surface", "pbrt", "albedo", "physical"}) {
        const ConventionValues back = write("cycles", read(other, write(other, read("cycles", cycles)).values)).values;
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(back.at("base_color")[c], cycles.at("base_color")[c], 1e-9) << other;
            EXPECT_NEAR(back.at("subsurface_radius")[c] * back.at("subsurface_scale")[0] /
                            (0.05 * cycles.at("subsurface_radius")[c]),
                        1, 1e-9)
                << other;
        }
        EXPECT_NEAR(back.at("subsurface_anisotropy")[0], 0.4, 1e-12) << other;
    }
}

// Tables that their makers print.
TEST_F(Conventions, RenderManHasItsOwnTable) {
    // rmanwiki.pixar.com: albedo and diffuse mean free path of Jensen's materials, to the digits printed.
    const struct {
        Medium medium;
        Rgb color, radius;
    } rows[] = {{skin1, {0.436, 0.227, 0.131}, {3.67, 1.37, 0.68}},
                {marble, {0.830, 0.791, 0.753}, {8.51, 5.57, 3.95}}};
    for (const auto& row : rows) {
        const ConventionValues values = write("renderman", row.medium).values;
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(values.at("color")[static_cast<std::size_t>(c)], row.color[c], 6e-4);
            EXPECT_NEAR(values.at("radius")[static_cast<std::size_t>(c)], row.radius[c], 6e-3);
        }
    }
}

TEST_F(Conventions, OpenPbrPrintsItsInverseWithSixDigits) {
    for (const double C : {0.01, 0.2, 0.5, 0.8, 0.99}) {
        const double s = 4.09712 + 4.20863 * C - std::sqrt(9.59217 + 41.6808 * C + 17.7126 * C * C);
        EXPECT_NEAR(vanDeHulstInverse(C), s, 2e-5);
    }
}

// Unreal's SubsurfaceProfile.cpp states the range of its conversion: a mean free path is 1.44 diffuse ones at albedo 0
// and 43.50 at albedo 1.
TEST_F(Conventions, UnrealsRatioOfPathsIsItsOwn) {
    const auto ratio = [](double A) {
        return burleyScale(BurleyWidth::diffuse_mean_free_path, A) / (0.6 * burleyScale(BurleyWidth::searchlight, A));
    };
    EXPECT_NEAR(ratio(0), 1.44, 0.005);
    EXPECT_NEAR(ratio(1), 43.50, 0.02);
}

// The accuracy that the conventions state, against the exact half-space without a boundary under diffuse light.
TEST_F(Conventions, FitsAreAsAccurateAsStated) {
    const CsvTable exact = table("transport/halfspace_isotropic_matched.csv");
    double van_de_hulst = 0, wrenninge = 0, chiang = 0;
    for (std::size_t row = 0; row < exact.rows.size(); ++row) {
        const double alpha = exact.number(row, *exact.find("albedo")), R = exact.number(row, *exact.find("R_lambert"));
        van_de_hulst = std::max(van_de_hulst, std::abs(albedoOfSimilarity(vanDeHulstInverse(R), 0) - alpha));
        wrenninge = std::max(wrenninge, std::abs(wrenningeAlbedo(R, 0) - alpha));
        chiang = std::max(chiang, std::abs(chiangAlbedo(R) - alpha));
    }
    EXPECT_NEAR(van_de_hulst, 0.0051, 5e-5);
    EXPECT_NEAR(wrenninge, 0.0037, 5e-5);
    EXPECT_NEAR(chiang, 0.0069, 5e-5);
}

TEST_F(Conventions, SurfaceAlbedoIsThatOfNormalizedDiffusion) {
    const LoadedModel model = load("normalized_diffusion", skin1);
    const Rgb total = model.evaluator->diffuseReflectance(skin1.alphaPrime());
    const ConventionValues values = write("burley", skin1).values;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(values.at("A")[static_cast<std::size_t>(c)], total[c], 1e-14);
    // And the width: the ratio of the profile at two radii does not know A.
    const double d = values.at("d")[0];
    const auto shape = [d](double r) { return (std::exp(-r / d) + std::exp(-r / (3 * d))) / r; };
    EXPECT_NEAR(model.Rd(0.5) / model.Rd(3), shape(0.5) / shape(3), 1e-11 * shape(0.5) / shape(3));
}

TEST_F(Conventions, SayWhatCannotBeReached) {
    // The fit of Chiang, Kutz and Burley ends at 1 - exp(-6.80023) = 0.998885.
    const WrittenConvention written = write("chiang", marble);
    EXPECT_TRUE(std::isnan(written.values.at("A")[0]));
    EXPECT_THAT(written.notes.front(),
                testing::StartsWith("R: no A gives the albedo 0.999042: the fit ends at 0.998886"));
    EXPECT_FALSE(std::isnan(written.values.at("A")[2]));
    EXPECT_TRUE(std::isnan(readBackError(findConvention("chiang"), marble, written, context)));

    const Medium clear = grey(1e-7, 1, 0, 1);
    const WrittenConvention legacy = write("cycles_legacy", clear);
    EXPECT_TRUE(std::isnan(legacy.values.at("base_color")[0]));
    EXPECT_EQ(legacy.notes.front(), "no base_color gives this albedo: the fit reaches 0.999999");
    EXPECT_NEAR(write("cycles", clear).values.at("base_color")[0], 1, 1e-3);
}

TEST_F(Conventions, WithoutAbsorptionDiffusePathsAreInfinite) {
    const Medium white = grey(0, 1, 0, 1.3);
    EXPECT_NEAR(write("openpbr", white).values.at("subsurface_color")[0], 1, 1e-15);
    EXPECT_TRUE(std::isnan(write("burley", white).values.at("d")[0]));
    EXPECT_TRUE(std::isnan(write("reflectance", white).values.at("ld")[0]));
    context.width = BurleyWidth::diffuse;
    EXPECT_NEAR(write("burley", white).values.at("d")[0], 1 / 1.04, 1e-12);  // Eq. 6 at A = 1
}

TEST_F(Conventions, AnotherGPerChannelBecomesTheReducedMedium) {
    Medium medium = skin1;
    medium.g = {0.1, 0.5, 0.9};
    const WrittenConvention written = write("openpbr", medium);
    EXPECT_EQ(written.values.at("subsurface_scatter_anisotropy")[0], 0);
    EXPECT_THAT(written.notes.front(), testing::StartsWith("g differs between channels"));
    expectSame(medium, read("openpbr", written.values), 1e-12, "openpbr");
    EXPECT_EQ(write("physical", medium).values.at("g"), (std::vector<double>{0.1, 0.5, 0.9}));
}

TEST_F(Conventions, AChannelWithoutScatteringIsNotApplicable) {
    Medium medium = skin1;
    medium.sigma_s.b = 0;
    for (const Convention& convention : conventions()) {
        const WrittenConvention written = writeConvention(convention, medium, context);
        for (const auto& [name, numbers] : written.values)
            for (std::size_t c = 0; c + 1 < numbers.size(); ++c)
                EXPECT_TRUE(std::isfinite(numbers[c])) << convention.id << " " << name;
    }
}

TEST_F(Conventions, OneNumberEachIsOneChannel) {
    EXPECT_EQ(
        read("openpbr", {{"subsurface_color", {0.5}}, {"subsurface_radius", {1}}, {"subsurface_radius_scale", {1}}})
            .channels,
        1);
}

TEST_F(Conventions, RefuseWithWhatIsValid) {
    EXPECT_EQ(message("cycles", {{"base_color", {0.5}}}),
              "cycles needs subsurface_radius (4 pi mean free paths 1/sigma_t, over subsurface_scale)");
    EXPECT_THAT(message("cycles", {{"albedo", {0.5}}}), testing::StartsWith("unknown value of cycles 'albedo'"));
    EXPECT_THAT(message("cycles", {{"base_color", {1.5}}, {"subsurface_radius", {1}}}),
                testing::StartsWith("'1.5' is no value for base_color (expected"));
    EXPECT_THAT(message("burley", {{"A", {1}}, {"d", {1}}}), testing::StartsWith("no medium has these values"));
    EXPECT_THAT(message("reflectance", {{"Rdr", {1}}, {"ld", {1}}}),
                testing::StartsWith("Rdr 1 cannot be reached by dipole at eta 1.3 (it goes from "));
    try {
        findConvention("cycle");
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "unknown convention 'cycle' (did you mean: cycles, cycles_legacy, cycles_skin)");
    }
}

TEST_F(Conventions, ExplainThemselves) {
    for (const Convention& convention : conventions()) {
        EXPECT_FALSE(convention.title.empty() || convention.source.empty() || convention.relation.empty());
        for (const ConventionKey& key : convention.keys) EXPECT_FALSE(key.meaning.empty()) << key.param.name;
        // What is written is what is read.
        const WrittenConvention written = writeConvention(convention, skin1, context);
        EXPECT_EQ(written.values.size(), convention.keys.size()) << convention.id;
    }
}

}  // namespace
}  // namespace searchlight
