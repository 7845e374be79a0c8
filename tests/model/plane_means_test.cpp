#include "model/plane_means.h"

#include <cmath>

#include "models.h"

namespace searchlight {
namespace {

// In Hankel space a point source at depth z under an absorbing medium is exp(-z sqrt(s^2 + k^2)), whose second
// derivative at k = 0 gives <r^2> = 2 z / s of each of the dipole's two terms.
TEST(PlaneMoments, OfTheClassicalDipoleMatchTheirClosedForm) {
    for (const double albedo : {0.5, 0.9, 0.999}) {
        LoadedModel dipole = load("dipole", ofAlbedo(albedo, 1));
        const double s = std::sqrt(3 * (1 - albedo)), zr = 1, zv = 1 + 4.0 / 3;
        const double real = std::exp(-s * zr), image = std::exp(-s * zv);
        const PlaneMoments moments = planeMoments(*dipole.evaluator, dipole.model, dipole.medium, 60);
        EXPECT_NEAR(moments.total.r, 0.5 * albedo * (real + image), 1e-6 * moments.total.r);
        EXPECT_NEAR(moments.mean_r2.r, (2 * zr / s * real + 2 * zv / s * image) / (real + image),
                    1e-6 * moments.mean_r2.r);
        EXPECT_EQ(moments.mean_x.r, 0);
    }
}

// A rule of another kind: midpoints in t, r = t / (1 - t), and equally spaced azimuths.
TEST(PlaneMoments, OfTheDirectionalDipoleMatchAnotherQuadrature) {
    const LoadedModel model = load("directional_dipole", ofAlbedo(0.9, 1.3, 0.5), {{"ClampNegative", false}});
    const double angle_deg = 60;
    const PlaneMoments moments = planeMoments(*model.evaluator, model.model, model.medium, angle_deg);
    const Vec3 up{0, 0, 1}, wi = pencilBeam(1.3, angle_deg).wi;
    double total = 0, x = 0, r2 = 0;
    constexpr int radii = 3000, azimuths = 90;
    for (int i = 0; i < radii; ++i) {
        const double t = (i + 0.5) / radii, r = t / (1 - t), jacobian = r / ((1 - t) * (1 - t)) / radii;
        std::vector<Query> queries;
        std::vector<double> cosines;
        for (int k = 0; k < azimuths; ++k) {
            const double phi = 2 * pi * k / azimuths;
            queries.push_back({{}, wi, up, {r * std::cos(phi), r * std::sin(phi), 0}, up, up});
            cosines.push_back(std::cos(phi));
        }
        std::vector<Rgb> Rd(queries.size());
        model.evaluator->evaluate(queries, Rd);
        for (int k = 0; k < azimuths; ++k) {
            const double flux = Rd[static_cast<std::size_t>(k)].r * jacobian * 2 * pi / azimuths;
            total += flux;
            x += flux * r * cosines[static_cast<std::size_t>(k)];
            r2 += flux * r * r;
        }
    }
    // Midpoints of 3000 radii leave 1e-6 where R_d is smooth on the scale of D.
    EXPECT_NEAR(moments.total.r, total, 1e-4 * total);
    EXPECT_NEAR(moments.mean_x.r, x / total, 1e-4 * x / total);
    EXPECT_NEAR(moments.mean_r2.r, r2 / total, 1e-4 * r2 / total);
    EXPECT_GT(moments.mean_x.r, 0.1);  // towards +x
}

TEST(PlaneMoments, WithoutAbsorptionHaveNoSquareRadius) {
    LoadedModel dipole = load("dipole", ofAlbedo(1, 1.3));
    const PlaneMoments moments = planeMoments(*dipole.evaluator, dipole.model, dipole.medium, 0);
    EXPECT_TRUE(std::isnan(moments.mean_r2.r));
    EXPECT_GT(moments.total.r, 0.9);
}

TEST(CellMeans, OfPartsAddUpToTheWhole) {
    // R_d of normalized diffusion goes as 1/r at the corner that the four cells share.
    for (const char* id : {"normalized_diffusion", "directional_dipole"}) {
        LoadedModel model = load(id, ofAlbedo(0.9, 1.3));
        const std::vector<PlaneCell> cells{{-1, 1, -1, 1}, {-1, 0, -1, 0}, {0, 1, -1, 0}, {-1, 0, 0, 1}, {0, 1, 0, 1}};
        const std::vector<Rgb> means = cellMeans(*model.evaluator, model.model, model.medium, 40, cells);
        const double parts = 0.25 * (means[1].r + means[2].r + means[3].r + means[4].r);
        EXPECT_NEAR(means[0].r, parts, 3e-3 * parts) << id;
        // The plane of incidence is a mirror.
        EXPECT_NEAR(means[1].r, means[3].r, 1e-12 * means[3].r) << id;
    }
}

TEST(CellMeans, OfALargeSquareHoldTheTotal) {
    LoadedModel model = load("normalized_diffusion", ofAlbedo(0.8, 1));
    std::vector<PlaneCell> cells;
    for (int i = -20; i < 20; ++i)
        for (int j = -20; j < 20; ++j) cells.push_back({1.0 * i, i + 1.0, 1.0 * j, j + 1.0});
    double sum = 0;
    for (const Rgb& mean : cellMeans(*model.evaluator, model.model, model.medium, 0, cells)) sum += mean.r;
    // What the innermost pieces lose of 1/r, and what three points leave elsewhere.
    EXPECT_NEAR(sum, model.total(), 2e-3 * sum);
}

TEST(SectorRadiance, OfAllDirectionsIsTheExitanceOfTheSector) {
    const PlaneSector sector{0.5, 1.0, 30, 20};
    constexpr int polar = 9, turns = 8;
    for (const double eta : {1.0, 1.3}) {
        LoadedModel model = load("directional_dipole", ofAlbedo(0.9, eta));
        const std::vector<Rgb> radiance = sectorRadiance(*model.evaluator, model.medium, 45, sector, polar, turns);
        double sum = 0;
        for (int i = 0; i < polar; ++i)
            for (int j = 0; j < turns; ++j)
                sum +=
                    radiance[static_cast<std::size_t>(i * turns + j)].r * pi / turns *
                    (std::pow(std::sin(0.5 * pi * (i + 1) / polar), 2) - std::pow(std::sin(0.5 * pi * i / polar), 2));
        // The sector's mean by midpoints.
        std::vector<Vec3> points;
        for (int i = 0; i < 60; ++i)
            for (int k = 0; k < 60; ++k) {
                const double r = std::sqrt(0.25 + 0.75 * (i + 0.5) / 60), phi = (10 + 40 * (k + 0.5) / 60) * pi / 180;
                points.push_back({r * std::cos(phi), r * std::sin(phi), 0});
            }
        double mean = 0;
        for (const Rgb& value : planeRd(*model.evaluator, model.model, model.medium, 45, points))
            mean += value.r / 3600;
        // Three points a side on the sector, and on the last ring, where T21 falls to 0.
        EXPECT_NEAR(sum, mean, 1e-3 * mean) << eta;
    }
}

}  // namespace
}  // namespace searchlight
