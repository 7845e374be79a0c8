#include "transport/mesh/surface_cells.h"

#include <gmock/gmock.h>

#include <numeric>

#include "base/error.h"
#include "base/random.h"
#include "mesh_shapes.h"
#include "transport/mesh/cell_picture.h"

namespace searchlight {
namespace {

using testing::Each;

double sumOf(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

TEST(SurfaceCells, CoverTheSurfaceWithCellsOfAboutTheAreaWanted) {
    const Mesh sphere = sphereMesh(1, 4);
    double area = 0;
    for (std::size_t t = 0; t < sphere.triangles.size(); ++t) area += triangleArea(sphere, t);
    for (const double wanted : {1e-4, 1e-3, 1e-2, 0.1}) {
        const SurfaceCells cells(sphere, wanted);
        EXPECT_NEAR(sumOf(cells.areas_mm2()), area, 1e-9 * area);
        EXPECT_LE(*std::ranges::max_element(cells.areas_mm2()), wanted);
        // Halving clusters leaves at least a quarter on average; so do sides that are cut into whole numbers.
        EXPECT_LT(static_cast<double>(cells.size()), 4 * area / wanted);
    }
    EXPECT_EQ(SurfaceCells(sphere, 0).size(), sphere.triangles.size()) << "0: a cell per triangle";
}

// A point of the triangle falls into each of its parts as often as into any other.
TEST(SurfaceCells, CutATriangleIntoEqualParts) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    const SurfaceCells cells(mesh, 0.5 / 24);
    ASSERT_EQ(cells.size(), 25u);
    EXPECT_THAT(cells.areas_mm2(), Each(testing::DoubleNear(0.02, 1e-12)));
    SplitMix64 random(1);
    std::vector<double> counts(25, 0.0);
    constexpr int points = 100'000;
    for (int i = 0; i < points; ++i) {
        const double root = std::sqrt(random.uniform());
        ++counts[cells.at(0, static_cast<float>(1 - root), static_cast<float>(root * random.uniform()))];
    }
    double chi2 = 0;
    for (const double count : counts) chi2 += std::pow(count - points / 25.0, 2) / (points / 25.0);
    EXPECT_LT(chi2, 63) << "24 degrees of freedom: exceeded once in 4e4";
    for (const auto& [u, v] : {std::pair{0.f, 0.f}, {1.f, 0.f}, {0.f, 1.f}, {0.5f, 0.5f}, {1.f, 1e-7f}})
        EXPECT_LT(cells.at(0, u, v), 25u) << "corners and edges belong to a cell";
}

TEST(SurfaceCells, SampleEachCellWithinItself) {
    const Mesh sphere = sphereMesh(1, 3);
    for (const double wanted : {2e-3, 0.1}) {
        const SurfaceCells cells(sphere, wanted);
        const CellPoints points = cells.sample(sphere, 4, 7);
        std::vector<int> counts(cells.size(), 0);
        for (std::size_t i = 0; i < points.cells.size(); ++i) ++counts[points.cells[i]];
        for (const int count : counts) EXPECT_NEAR(count, 4, 1);
        // A value that is 1 in each cell's own points and 0 elsewhere averages to 1 there.
        std::vector<Rgbf> values(points.cells.size());
        for (std::size_t i = 0; i < values.size(); ++i) values[i].g = static_cast<float>(points.cells[i]);
        const std::vector<Rgb> means = averageOverCells(points, values, cells.size());
        for (std::size_t cell = 0; cell < cells.size(); ++cell)
            EXPECT_DOUBLE_EQ(means[cell].g, static_cast<double>(cell));
    }
}

TEST(SurfaceCells, RefuseMoreThanAPictureCanNumber) {
    EXPECT_THROW(SurfaceCells(boxMesh({1000, 1000, 1000}), 1e-3), Error);
    EXPECT_THROW(makeSphereCells(1000, 1e-3), Error);
}

TEST(SphereCells, HaveEqualAreas) {
    const SphereCells cells = makeSphereCells(2, 4 * std::numbers::pi * 4 / 50);
    EXPECT_EQ(cells.size(), 50u);
    SplitMix64 random(1);
    std::vector<double> counts(cells.size(), 0.0);
    constexpr int points = 100'000;
    for (int i = 0; i < points; ++i) {
        const double z = 2 * random.uniform() - 1, ring = std::sqrt(1 - z * z), turn = 6.283185307 * random.uniform();
        ++counts[cells.at({ring * std::cos(turn), z, ring * std::sin(turn)})];
    }
    double chi2 = 0;
    for (const double count : counts) chi2 += std::pow(count - points / 50.0, 2) / (points / 50.0);
    EXPECT_LT(chi2, 100) << "49 degrees of freedom: exceeded once in 4e4";
}

TEST(CellPicture, AddsCellsByTheirCoverage) {
    const CellView view{2, 1, {{0, 0, 0.5f, 0.2f}, {0, 1, 0.25f, 0.4f}, {1, 1, 1.0f, 0.1f}}};
    const std::vector<double> values{3, 8};
    const CellValues red{values};
    const Image radiance = pictureOfRadiance(view, red), exitance = pictureOfExitance(view, red);
    EXPECT_EQ(radiance.pixels[0], (Rgba{0.5f * 0.2f * 3 + 0.25f * 0.4f * 8, 0, 0, 0.75f}));
    EXPECT_EQ(exitance.pixels[0], (Rgba{3.5f, 0, 0, 0.75f}));
    EXPECT_EQ(exitance.pixels[1], (Rgba{8, 0, 0, 1}));
    EXPECT_NEAR(pictureOfError(view, red).pixels[0].r, std::hypot(0.3, 0.8), 1e-6) << "of independent cells";
    EXPECT_EQ(pictureOfCells(view).pixels[1].r, 2);
}

// The factor makes radiance times cosine integrate to the exitance: that is what normalises it.
TEST(CellPicture, RadianceIntegratesToExitance) {
    for (const double eta : {0.8, 1.0, 1.3, 1.5}) {
        double sum = 0;
        constexpr int points = 10'000;
        for (int i = 0; i < points; ++i) {
            const double mu = (i + 0.5) / points;
            sum += 2 * std::numbers::pi * exitFactor(eta, mu) * mu / points;
        }
        EXPECT_NEAR(sum, 1, 1e-5) << eta << ": midpoint rule, and a moment good to 1e-6";
    }
}

}  // namespace
}  // namespace searchlight
