#include "transport/exact/ordinates.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/error.h"
#include "exact.h"
#include "transport/exact/exact_half_space.h"
#include "transport/exact/ordinate_half_space.h"
#include "transport/half_space/single_scattering.h"

namespace searchlight {
namespace {

constexpr OrdinateCount few{4, 8, 4, 8, 16};  // at k = 0 nothing varies with the azimuth

// Total per unit incident flux: single scattering from its own quadrature, the rest at k = 0.
double totalOf(const OrdinateMedium& medium) {
    const double specular = std::pow((medium.eta - 1) / (medium.eta + 1), 2), edge = 1;
    const SingleScattering single =
        singleScattering({.absorbed = 1 - medium.albedo, .g = medium.g, .eta = medium.eta}, {&edge, 1});
    return (1 - specular) * (single.total + ordinateTransform(medium, few, 0).real());
}

// Indices 1 to 1.6, albedos 0.1 to 0.9999; eight cosines leave 1e-6.
TEST(Ordinates, TotalsMatchAddingDoubling) {
    const CsvTable exact = table("halfspace_refractive_isotropic.csv");
    for (std::size_t row = 0; row < exact.rows.size(); row += 7) {
        const double n = exact.number(row, column(exact, "n")), albedo = exact.number(row, column(exact, "albedo"));
        EXPECT_NEAR(totalOf({albedo, 0, n}), exact.number(row, column(exact, "R_diffuse")), 2e-6)
            << "n " << n << ", albedo " << albedo;
    }
}

// Giovanelli 1955: .2600 with the specular .04, four digits; adding-doubling has 0.25991857.
TEST(Ordinates, TotalMatchesGiovanelli) { EXPECT_NEAR(0.04 + totalOf({0.9, 0, 1.5}), 0.25991857, 1e-6); }

// What is left out of ten directions is made up for exactly: the second order is that of any number of directions.
TEST(Ordinates, SecondOrderConverges) {
    for (const double g : {0.0, 0.5}) {
        const OrdinateMedium medium{0.9, g, 1.3};
        for (const std::complex<double> rate : {std::complex(0.2, -0.1), std::complex(3.0, -3.0)}) {
            const std::complex<double> value =
                secondOrderTransform(medium, {.second_panel = 8, .second_azimuths = 28}, rate);
            const std::complex<double> finer =
                secondOrderTransform(medium, {.second_panel = 11, .second_azimuths = 40}, rate);
            EXPECT_LT(std::abs(value - finer), 2e-4 * std::abs(finer)) << "g " << g << ", rate " << rate;
        }
    }
}

// Isotropic scattering decays as the root of its characteristic equation, 1 = (a / 2 nu0) ln((1 + nu0) / (1 - nu0)).
TEST(Ordinates, DiffusionRateIsTheRootOfTheCharacteristicEquation) {
    for (const double albedo : {0.3, 0.9, 0.999}) {
        const double rate = diffusionRate({albedo, 0, 1});
        EXPECT_NEAR(0.5 * albedo / rate * std::log((1 + rate) / (1 - rate)), 1, 1e-9) << albedo;
    }
    EXPECT_EQ(diffusionRate({1, 0, 1}), 0);
}

TEST(OrdinateHalfSpace, SaysWhatItDoesNotTake) {
    using testing::HasSubstr;
    EXPECT_EQ(whyNotOrdinates({.sigma_a = 0.1, .sigma_s = 1, .g = 0.5, .eta = 1.5}), "");
    EXPECT_THAT(whyNotOrdinates({.sigma_a = 0.1, .sigma_s = 1, .g = 0.9}), HasSubstr("|g| 0.9 is above 0.5"));
    EXPECT_THAT(whyNotOrdinates({.sigma_a = 0.1, .sigma_s = 1, .eta = 3}), HasSubstr("eta 3"));
    EXPECT_THAT(whyNotOrdinates({.sigma_a = 0, .sigma_s = 1, .eta = 1.3}), HasSubstr("the albedo 1 is above"));
    EXPECT_THAT(whyNotOrdinates({.sigma_a = 0.1, .sigma_s = 1, .eta = 1.3, .angle_deg = 30}), HasSubstr("oblique"));
    Observer observer;
    EXPECT_THROW(solveOrdinates({.sigma_a = 0.1, .sigma_s = 1, .g = 0.9}, 1, observer), Error);
    try {
        solveAnyHalfSpace({.sigma_a = 0.1, .sigma_s = 1, .eta = 1.3}, {0, 0.001, 1}, 1, observer);
        FAIL();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("the exact profile is asked for at 0.001 mm"));
    }
}

}  // namespace
}  // namespace searchlight
