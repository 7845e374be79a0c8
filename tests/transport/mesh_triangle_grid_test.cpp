#include "transport/mesh/triangle_grid.h"

#include <hwy/targets.h>

#include "base/random.h"
#include "instruction_sets.h"
#include "mesh_shapes.h"

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

bool beginsInside(const TriangleGrid& grid, const Ray& flight) {
    const auto within = [&](float at, float low, std::int32_t n) {
        return at > low && at < low + static_cast<float>(n) * grid.cell_mm;
    };
    return within(flight.origin.x, grid.origin.x, grid.nx) && within(flight.origin.y, grid.origin.y, grid.ny) &&
           within(flight.origin.z, grid.origin.z, grid.nz);
}

// Embree and the grid round differently: where only one of them sees a hit, or they see different ones, a flight has to
// begin, end or cross an edge within a rounding.
void expectEmbreesHits(const Mesh& mesh, double cell, double length) {
    const TriangleGrid grid = buildTriangleGrid(mesh, cell);
    const RayScene rays(mesh);
    std::vector<Ray> flights = flightsNear(mesh, length, 40'000);
    for (Ray& f : flights)
        if (!beginsInside(grid, f)) f = {mesh.positions[0], {0, 0, 0}, 0, 1};
    std::vector<RayHit> hits(flights.size()), truth(flights.size());
    std::vector<Vec3> positions(flights.size());
    grid.intersect(flights, hits, positions);
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
        const Vec3 at = toDouble(flights[i].origin) + static_cast<double>(hits[i].t) * toDouble(flights[i].direction);
        EXPECT_LT(searchlight::length(positions[i] - at), 1e-4 * length) << i;
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
    std::vector<Vec3> positions(flights.size());
    grid.intersect(flights, hits, positions);
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
    std::vector<Vec3> positions(2);
    grid.intersect(flights, hits, positions);
    EXPECT_FLOAT_EQ(hits[0].t, 2);
    EXPECT_EQ(hits[0].normal.z, 1);
    EXPECT_TRUE(std::isinf(hits[1].t));
}

// A flight that is known to be clear up to shortly before its hit, and to end shortly after, has that hit.
TEST(TriangleGrid, FindsTheSameHitInThePartOfAFlightAroundIt) {
    const Mesh mesh = sphereMesh(2, 4);
    const TriangleGrid grid = buildTriangleGrid(mesh, 0.15);
    std::vector<Ray> flights = flightsNear(mesh, 1.0, 20'000);
    std::erase_if(flights, [&](const Ray& f) { return !beginsInside(grid, f); });
    std::vector<RayHit> whole(flights.size()), part(flights.size());
    std::vector<Vec3> positions(flights.size());
    grid.intersect(flights, whole, positions);
    int met = 0;
    for (std::size_t i = 0; i < flights.size(); ++i)
        if (std::isfinite(whole[i].t))
            flights[i].t_min = 0.999f * whole[i].t, flights[i].t_max = std::min(1.001f * whole[i].t, 1.0f), ++met;
    grid.intersect(flights, part, positions);
    EXPECT_GT(met, 1'000);
    int other = 0;
    for (std::size_t i = 0; i < flights.size(); ++i)
        other += std::isfinite(whole[i].t) && !(std::abs(part[i].t - whole[i].t) < 1e-4f * whole[i].t);
    EXPECT_LE(other, 2) << "what passes a vertex may meet either side of it";
}

// A walk that has slipped out by rounding may begin its next flight there.
TEST(TriangleGrid, FollowsFlightsThatBeginBeyondIt) {
    const Mesh mesh = boxMesh({3, 1, 0.5});
    const TriangleGrid grid = buildTriangleGrid(mesh, 0.1);
    const RayScene rays(mesh);
    SplitMix64 random(3);
    const auto uniform = [&] { return 2 * random.uniform() - 1; };
    std::vector<Ray> flights;
    while (flights.size() < 20'000) {
        // A cell beyond, and many.
        const double away = flights.size() % 2 == 0 ? 0.5 : 20;
        const Vec3 from{(3 + away) * uniform(), (1 + away) * uniform(), (0.5 + away) * uniform()};
        const Vec3 to = flights.size() % 4 < 2 ? Vec3{3 * uniform(), uniform(), 0.5 * uniform()}
                                               : from + 2 * away * Vec3{uniform(), uniform(), uniform()};
        const Ray flight{toFloat(from), toFloat(to - from), 0, 1};
        if (!beginsInside(grid, flight)) flights.push_back(flight);
    }
    std::vector<RayHit> hits(flights.size()), truth(flights.size());
    std::vector<Vec3> positions(flights.size());
    grid.intersect(flights, hits, positions);
    rays.intersect(flights, truth, false);
    int met = 0, other = 0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        met += std::isfinite(truth[i].t);
        other += std::isfinite(truth[i].t) != std::isfinite(hits[i].t) || std::abs(hits[i].t - truth[i].t) > 1e-4f;
    }
    EXPECT_GT(met, 9'000);
    EXPECT_LE(other, 2) << "what grazes an edge may slip past it";
}

// Flights side by side have the hits that they have one by one; their points lie on the triangles, and below them.
TEST(TriangleGrid, ListsTheHitsOfFlightsSideBySide) {
    const Mesh mesh = sphereMesh(2, 4);
    const TriangleGrid grid = buildTriangleGrid(mesh, 0.15);
    std::vector<Ray> flights = flightsNear(mesh, 1.0, 20'000);
    std::vector<RayHit> truth(flights.size());
    std::vector<Vec3> positions(flights.size());
    grid.intersect(flights, truth, positions);
    constexpr float nudge = 1e-3f;
    std::size_t met = 0;
    for (std::size_t first = 0; first < flights.size(); first += 250) {
        Flights some;
        for (; some.count < 250 && first + some.count < flights.size(); ++some.count) {
            const auto [origin, direction, t_min, t_max] = flights[first + some.count];
            some.x[some.count] = origin.x, some.y[some.count] = origin.y, some.z[some.count] = origin.z;
            some.dx[some.count] = direction.x, some.dy[some.count] = direction.y, some.dz[some.count] = direction.z;
        }
        FlightHits hits;
        grid.intersect(some, nudge, hits);
        std::size_t next = 0;
        for (std::size_t i = 0; i < some.count; ++i) {
            if (std::isinf(truth[first + i].t)) continue;
            ASSERT_LT(next, hits.count);
            const RayHit& hit = truth[first + i];
            ASSERT_EQ(hits.flight[next], static_cast<std::int32_t>(i));
            EXPECT_EQ(hits.triangle[next], static_cast<std::int32_t>(hit.triangle));
            EXPECT_EQ(hits.u[next], hit.u);
            const Vec3 normal = toDouble(Vec3f{hits.nx[next], hits.ny[next], hits.nz[next]});
            const Vec3 at = toDouble(Vec3f{hits.x[next], hits.y[next], hits.z[next]});
            const Vec3 inside = toDouble(Vec3f{hits.inside_x[next], hits.inside_y[next], hits.inside_z[next]});
            EXPECT_LT(length(normal - toDouble(hit.normal)), 3e-7);
            EXPECT_LT(length(at - positions[first + i]), 4e-7);
            EXPECT_LT(length(at - static_cast<double>(nudge) * normal - inside), 4e-7);
            ++next;
        }
        EXPECT_EQ(next, hits.count);
        met += next;
    }
    EXPECT_GT(met, 1'000u);
}

TEST(TriangleGrid, AgreesBitForBitOnTargetsWithFma) {
    if (!hasInstructionSet(HWY_AVX3)) GTEST_SKIP() << "one instruction set with FMA";
    const Mesh mesh = sphereMesh(2, 4);
    const TriangleGrid grid = buildTriangleGrid(mesh, 0.15);
    std::vector<Ray> flights = flightsNear(mesh, 1.0, 20'000);
    std::erase_if(flights, [&](const Ray& f) { return !beginsInside(grid, f); });
    std::vector<RayHit> hits[2]{std::vector<RayHit>(flights.size()), std::vector<RayHit>(flights.size())};
    std::vector<Vec3> positions(flights.size());
    for (const std::int64_t target : {HWY_AVX3, HWY_AVX2}) {
        hwy::SetSupportedTargetsForTest(target);
        grid.intersect(flights, hits[target == HWY_AVX2], positions);
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
