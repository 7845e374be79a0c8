// Models against values that others computed, and against exact results of transport theory.
#include "base/text.h"
#include "models.h"

namespace searchlight {
namespace {

class PublishedValues : public testing::TestWithParam<const char*> {};

TEST_P(PublishedValues, AgreeWithProfileAndTotal) {
    const CsvTable values = table("dipole_values.csv");
    const std::size_t column = values.find(GetParam()).value();
    for (std::size_t row = 0; row < values.rows.size(); ++row) {
        const LoadedModel loaded =
            load(GetParam(), grey(values.number(row, 1), values.number(row, 2), 0, values.number(row, 3)));
        const double expected = values.number(row, column);
        // The table has 7 digits, totals 6.
        if (values.rows[row][4].text == "total")
            EXPECT_NEAR(loaded.total(), expected, 0.6e-6);
        else
            EXPECT_NEAR(loaded.Rd(values.number(row, 4)), expected, 1e-6 * expected);
    }
}

INSTANTIATE_TEST_SUITE_P(Models, PublishedValues, testing::Values("dipole", "better_dipole"));

struct MatchedTotal {
    double albedo, dipole, better_dipole;
};

// Five digits, at matched indices.
TEST(Dipoles, TotalsAtMatchedIndicesArePublished) {
    for (const auto& [albedo, dipole, better_dipole] : std::vector<MatchedTotal>{
             {0.5, 0.08781, 0.04598}, {0.9, 0.38559, 0.34381}, {0.99, 0.74671, 0.73785}, {0.999, 0.91245, 0.91134}}) {
        EXPECT_NEAR(load("dipole", ofAlbedo(albedo, 1)).total(), dipole, 1e-5);
        EXPECT_NEAR(load("better_dipole", ofAlbedo(albedo, 1)).total(), better_dipole, 1e-5);
    }
}

// The clamped totals per transmitted flux that are known for albedo .999: more light than has entered.
TEST(DirectionalDipole, ViolatesEnergyConservationAsMuchAsKnown) {
    EXPECT_NEAR(load("directional_dipole", ofAlbedo(0.999, 1)).total(), 1.25, 0.005);
    EXPECT_NEAR(load("directional_dipole", ofAlbedo(0.999, 1.3)).total(), 1.10, 0.005);
    EXPECT_NEAR(load("directional_dipole", ofAlbedo(0.999, 1.5)).total(), 1.02, 0.005);
}

// What the file claims for the albedo that it derives from the medium.
TEST(NormalizedDiffusion, AlbedoIsNearTheExactHalfSpace) {
    const CsvTable exact = table("half_space_refractive.csv");
    double worst = 0, worst_matched = 0;
    for (std::size_t row = 0; row < exact.rows.size(); ++row) {
        const double eta = exact.number(row, 0);
        const double expected = exact.number(row, 3) / (1 - exact.number(row, 2));
        const double error =
            std::abs(load("normalized_diffusion", ofAlbedo(exact.number(row, 1), eta)).closedForm() - expected);
        (eta == 1 ? worst_matched : worst) = std::max(eta == 1 ? worst_matched : worst, error);
    }
    EXPECT_LT(worst_matched, 0.00065);
    EXPECT_LT(worst, 0.011);
}

}  // namespace
}  // namespace searchlight
