#include "model/inversion.h"

#include "base/error.h"
#include "models.h"

namespace searchlight {
namespace {

InversionTarget target(Rgb Rdr, Rgb ld_mm, double eta, double g = 0) { return {Rdr, ld_mm, eta, g, 3}; }

/// What the model itself says of a medium, inverted.
Inversion roundTrip(const std::string& id, const Medium& medium, bool grosjean) {
    const LoadedModel loaded = load(id, medium);
    const Rgb Rdr = totalRd(*loaded.evaluator, loaded.model, medium);
    Rgb ld;
    for (int c = 0; c < 3; ++c) {
        const double tp = medium.sigmaTp()[c], a = medium.sigma_a[c];
        ld[c] =
            1 / std::sqrt(3 * a * tp * (grosjean ? tp / (a + tp) : 1));  // D = (sigma_a + sigma_t') / (3 sigma_t'^2)
    }
    return invert(*loaded.evaluator, loaded.model, {}, target(Rdr, ld, medium.eta, medium.g.r));
}

const Medium skin1{{0.032, 0.17, 0.48}, {0.74, 0.88, 1.01}, {}, 1.3, 3};

class RoundTrip : public testing::TestWithParam<std::string> {};

TEST_P(RoundTrip, GivesTheMediumBack) {
    Medium medium = skin1;
    medium.g = {0.3, 0.3, 0.3};
    const bool grosjean = loadModel(GetParam()).file.grosjean;
    const Inversion found = roundTrip(GetParam(), medium, grosjean);
    for (int c = 0; c < 3; ++c) {
        EXPECT_TRUE(found.reached[static_cast<std::size_t>(c)]);
        // Totals agree with closed forms to 1e-9, and R varies about as much as alpha'.
        EXPECT_NEAR(found.medium.sigma_a[c] / medium.sigma_a[c], 1, 1e-7);
        EXPECT_NEAR(found.medium.sigma_s[c] / medium.sigma_s[c], 1, 1e-7);
    }
    EXPECT_EQ(found.mean_free_path, grosjean ? "grosjean" : "classical");
    EXPECT_EQ(found.from_profile, GetParam() == "directional_dipole");
}

INSTANTIATE_TEST_SUITE_P(Models, RoundTrip,
                         testing::Values("dipole", "better_dipole", "normalized_diffusion", "directional_dipole",
                                         "quantized_diffusion"));

// [Jensen2001] prints Rd and [JensenBuhler2002] ld of skin1; two or three digits.
TEST(Inversion, FindsSkin1FromItsPublishedReflectance) {
    const LoadedModel loaded = load("dipole", skin1);
    const Inversion found =
        invert(*loaded.evaluator, loaded.model, {}, target({0.44, 0.22, 0.13}, {3.673, 1.367, 0.683}, 1.3));
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(found.medium.sigma_a[c] / skin1.sigma_a[c], 1, 0.04);
        EXPECT_NEAR(found.medium.sigmaSp()[c] / skin1.sigmaSp()[c], 1, 0.04);
        EXPECT_NEAR(found.achieved[c], Rgb(0.44, 0.22, 0.13)[c], 1e-12);
    }
}

TEST(Inversion, SaysWhenTheModelCannotReachTheTarget) {
    const LoadedModel loaded = load("directional_dipole", skin1);
    const Inversion found = invert(*loaded.evaluator, loaded.model, {}, target({0.5, 0.5, 1e-4}, {1, 1, 1}, 1.3));
    EXPECT_EQ(found.reached, (std::vector<bool>{true, true, false}));
    EXPECT_GT(found.reachable_min.b, 1e-4);
    EXPECT_NEAR(found.achieved.b, found.reachable_min.b, 1e-12);
}

TEST(Inversion, OfAFixedProfileReachesNothingElse) {
    const LoadedModel loaded = load("gaussians", skin1);
    const Inversion found = invert(*loaded.evaluator, loaded.model, {}, target({0.5, 0.5, 0.5}, {1, 1, 1}, 1.3));
    EXPECT_EQ(found.reached, (std::vector<bool>{false, false, false}));
    EXPECT_NEAR(found.reachable_min.r, 1, 1e-9);
    EXPECT_NEAR(found.reachable_max.r, 1, 1e-9);
}

TEST(Inversion, ReachesAlbedosNearOne) {
    const LoadedModel loaded = load("dipole", skin1);
    const Inversion found = invert(*loaded.evaluator, loaded.model, {}, target({0.999, 0.9999, 1}, {1, 1, 1}, 1.3));
    EXPECT_EQ(found.reached, (std::vector<bool>{true, true, false}));
    // alpha' = 1 - 2e-9 is held to 1e-16, and the slope is 1 / sqrt(1 - alpha').
    EXPECT_NEAR(found.achieved.g, 0.9999, 1e-10);
}

TEST(Inversion, ParametersOfTheModelMatter) {
    const LoadedModel loaded = load("dipole", skin1);
    const InversionTarget half = target({0.5, 0.5, 0.5}, {1, 1, 1}, 1.3);
    const Inversion published = invert(*loaded.evaluator, loaded.model, {}, half);
    const Inversion exact =
        invert(*loaded.evaluator, loaded.model, {{"Fresnel", ParamValue(std::string("exact"))}}, half);
    EXPECT_NE(published.alpha_prime.r, exact.alpha_prime.r);
    EXPECT_NEAR(published.alpha_prime.r, exact.alpha_prime.r, 1e-3);
}

// exp(-r/mm) / (2 pi r mm), times what a slab of 1 mm turns back: a model with a length of its own.
class SlabEvaluator final : public Evaluator {
public:
    void set(const Medium& medium, const ParamValues&) override { medium_ = medium; }
    void evaluate(std::span<const Query> queries, std::span<Rgb> values) override {
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const double r = length(queries[i].xo - queries[i].xi);
            for (int c = 0; c < 3; ++c)
                values[i][c] =
                    medium_.alphaPrime()[c] * -std::expm1(-medium_.sigmaTp()[c]) * std::exp(-r) / (2 * pi * r);
        }
    }
    Rgb diffuseReflectance(Rgb) override { return {}; }
    std::string backend() const override { return "test"; }

private:
    Medium medium_;
};

TEST(Inversion, OfAModelWithALengthOfItsOwnIsDoneAtTheMediumItself) {
    Model slab;
    slab.id = "slab";
    slab.file.radial = slab.file.no_wi = slab.file.no_wo = true;
    SlabEvaluator evaluator;
    const Rgb total = skin1.alphaPrime() * Rgb{-std::expm1(-skin1.sigmaTp().r), -std::expm1(-skin1.sigmaTp().g),
                                               -std::expm1(-skin1.sigmaTp().b)};
    Rgb ld;
    for (int c = 0; c < 3; ++c) ld[c] = 1 / std::sqrt(3 * skin1.sigma_a[c] * skin1.sigmaTp()[c]);
    const Inversion found = invert(evaluator, slab, {}, target(total, ld, 1.3));
    for (int c = 0; c < 3; ++c) {
        EXPECT_TRUE(found.from_profile && found.reached[static_cast<std::size_t>(c)]);
        EXPECT_NEAR(found.achieved[c], total[c], 1e-9);
        EXPECT_NEAR(found.medium.sigma_a[c] / skin1.sigma_a[c], 1, 1e-6);
        EXPECT_NEAR(found.medium.sigma_s[c] / skin1.sigma_s[c], 1, 1e-6);
    }
}

TEST(Inversion, RefusesImpossibleTargets) {
    const LoadedModel loaded = load("dipole", skin1);
    const auto refuses = [&](Rgb Rdr, Rgb ld) {
        EXPECT_THROW(invert(*loaded.evaluator, loaded.model, {}, target(Rdr, ld, 1.3)), Error);
    };
    refuses({1.1, 0.5, 0.5}, {1, 1, 1});
    refuses({0, 0.5, 0.5}, {1, 1, 1});
    refuses({NAN, 0.5, 0.5}, {1, 1, 1});
    refuses({0.5, 0.5, 0.5}, {0, 1, 1});
    refuses({0.5, 0.5, 0.5}, {INFINITY, 1, 1});
}

}  // namespace
}  // namespace searchlight
