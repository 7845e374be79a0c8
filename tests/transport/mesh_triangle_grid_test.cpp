#include "transport/mesh/triangle_grid.h"

#include <hwy/targets.h>

#include "instruction_sets.h"
#include "mesh_shapes.h"
#include "transport/walk/random.h"

namespace searchlight {
namespace {

// Flights between points in and around a mesh, long and short, some along its axes and some through its vertices.
std::vector<Ray> flightsNear(const Mesh& mesh, double length, int count) {
    SplitMix64 random(5);
    std::vector<Ray> flights;
    const auto uniform = [&] { return 2 * random.uniform() - 1; };
    for (int i = 0; i < count; ++i) {
        const Vec3 vertex = toDouble(mesh.positions[random.next() % mesh.positions.size()]);
        const double reach = length * random.uniform();
        Vec3 from = vertex + reach * Vec3{uniform(), uniform(), uniform()};
        Vec3 along = reach * Vec3{uniform(), uniform(), uniform()};
        if (i % 8 == 0) along = {0, along.y, 0};
        if (i % 8 == 1) along = {0, 0, 0};
        if (i % 8 == 2) along = 1.5 * (vertex - from);
        flights.push_back({toFloat(from), toFloat(along), 0, 1});
    }
    return flights;
}

// Embree and the grid round differently: where only one of them sees a hit, or they see different ones, a flight has to
// begin, end or cross an edge within a rounding.
void expectEmbreesHits(const Mesh& mesh, double cell, double length) {
    const TriangleGrid grid = buildTriangleGrid(mesh, cell);
    const RayScene rays(mesh);
    std::vector<Ray> flights = flightsNear(mesh, length, 40'000);
    for (Ray& f : flights)
        if (!grid.holds(f)) f = {mesh.positions[0], {0, 0, 0}, 0, 1};
    std::vector<RayHit> hits(flights.size()), truth(flights.size());
    grid.intersect(flights, hits);
    rays.intersect(flights, truth, false);
    int met = 0, slipped = 0, slipped_truth = 0, elsewhere = 0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        met += std::isfinite(truth[i].t);
        // A flight that slips past a vertex may meet another triangle, or none.
        if (!std::isfinite(hits[i].t) && !std::isfinite(truth[i].t)) continue;
        if (!(std::abs(hits[i].t - truth[i].t) < 2e-4f)) {
            ++(hits[i].t < truth[i].t ? slipped_truth : slipped);
            elsewhere += i % 8 != 2;
            continue;
        }
        if (hits[i].triangle != truth[i].triangle) continue;
        EXPECT_NEAR(hits[i].u, truth[i].u, 2e-3) << i;
        EXPECT_NEAR(hits[i].v, truth[i].v, 2e-3) << i;
        EXPECT_EQ(hits[i].normal.x, truth[i].normal.x) << i;
        EXPECT_EQ(hits[i].normal.z, truth[i].normal.z) << i;
    }
    EXPECT_GT(met, 1'000);
    // 5,000 flights pass a vertex. 1 in 400 of them slips past Embree, and no more past the grid; of the others a few
    // that graze an edge.
    EXPECT_LE(slipped, 40);
    EXPECT_LE(elsewhere, 4);
    EXPECT_LE(slipped_truth, 40);
}

TEST(TriangleGrid, MeetsWhatEmbreeMeets) {
    expectEmbreesHits(sphereMesh(2, 4), 0.1, 0.5);
    expectEmbreesHits(sphereMesh(2, 3), 1.0, 3.0);
    // Cells of the finest grid, and triangles that pass through hundreds of them.
    expectEmbreesHits(boxMesh({3, 2, 1}), 1e-3, 2.0);
}

// From inside no flight to far outside passes between two triangles.
TEST(TriangleGrid, IsWatertightAtEdges) {
    const Mesh mesh = sphereMesh(1, 3);
    const TriangleGrid grid = buildTriangleGrid(mesh, 0.1);
    SplitMix64 random(2);
    std::vector<Ray> flights;
    for (int i = 0; i < 200'000; ++i) {
        const auto& triangle = mesh.triangles[random.next() % mesh.triangles.size()];
        const Vec3 a = toDouble(mesh.positions[triangle[0]]), b = toDouble(mesh.positions[triangle[1]]);
        const double part = 0.05 + 0.9 * random.uniform();
        const Vec3 from{0.3 * random.uniform(), 0.3 * random.uniform(), 0.3 * random.uniform()};
        flights.push_back({toFloat(from), toFloat(1.05 * (a + part * (b - a) - from)), 0, 1});
    }
    std::vector<RayHit> hits(flights.size());
    grid.intersect(flights, hits);
    std::size_t slipped = 0;
    for (const RayHit& hit : hits) slipped += !std::isfinite(hit.t);
    EXPECT_EQ(slipped, 0u);
}

// Within multiples of t_max, and not beyond it.
TEST(TriangleGrid, CountsInTheFlightsOwnLength) {
    const Mesh mesh = boxMesh({1, 1, 1});
    const TriangleGrid grid = buildTriangleGrid(mesh, 0.2);
    const std::vector<Ray> flights{{{0.1f, 0.2f, 0.5f}, {0, 0, 0.25f}, 0, 2.5f},
                                   {{0.1f, 0.2f, 0.5f}, {0, 0, 0.25f}, 0, 1.9f}};
    std::vector<RayHit> hits(2);
    grid.intersect(flights, hits);
    EXPECT_FLOAT_EQ(hits[0].t, 2);
    EXPECT_EQ(hits[0].normal.z, 1);
    EXPECT_TRUE(std::isinf(hits[1].t));
}

TEST(TriangleGrid, AgreesBitForBitOnTargetsWithFma) {
    if (!hasInstructionSet(HWY_AVX3)) GTEST_SKIP() << "one instruction set with FMA";
    const Mesh mesh = sphereMesh(2, 4);
    const TriangleGrid grid = buildTriangleGrid(mesh, 0.15);
    std::vector<Ray> flights = flightsNear(mesh, 1.0, 20'000);
    std::erase_if(flights, [&](const Ray& f) { return !grid.holds(f); });
    std::vector<RayHit> hits[2]{std::vector<RayHit>(flights.size()), std::vector<RayHit>(flights.size())};
    for (const std::int64_t target : {HWY_AVX3, HWY_AVX2}) {
        hwy::SetSupportedTargetsForTest(target);
        grid.intersect(flights, hits[target == HWY_AVX2]);
    }
    hwy::SetSupportedTargetsForTest(0);
    for (std::size_t i = 0; i < flights.size(); ++i) {
        EXPECT_EQ(hits[0][i].t, hits[1][i].t);
        EXPECT_EQ(hits[0][i].triangle, hits[1][i].triangle);
        EXPECT_EQ(hits[0][i].u, hits[1][i].u);
    }
}

}  // namespace
}  // namespace searchlight
