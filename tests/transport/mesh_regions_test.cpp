#include "transport/mesh/safe_regions.h"

#include "base/random.h"
#include "mesh_shapes.h"
#include "transport/mesh/distance_bounds.h"

namespace searchlight {
namespace {

Vec3 anyDirection(SplitMix64& random) {
    const double z = 2 * random.uniform() - 1, ring = std::sqrt(1 - z * z),
                 turn = 2 * std::numbers::pi * random.uniform();
    return {ring * std::cos(turn), ring * std::sin(turn), z};
}

Vec3 anyPoint(SplitMix64& random, Vec3 half) {
    return {half.x * (2 * random.uniform() - 1), half.y * (2 * random.uniform() - 1),
            half.z * (2 * random.uniform() - 1)};
}

TEST(SquaredDistance, FindsCornersEdgesAndFace) {
    const Vec3 a{0, 0, 0}, b{2, 0, 0}, c{0, 2, 0};
    EXPECT_DOUBLE_EQ(squaredDistance({-3, -4, 0}, a, b, c), 25);
    EXPECT_DOUBLE_EQ(squaredDistance({5, 0, 4}, a, b, c), 25);
    EXPECT_DOUBLE_EQ(squaredDistance({0, 3, 0}, a, b, c), 1);
    EXPECT_DOUBLE_EQ(squaredDistance({1, -2, 0}, a, b, c), 4);
    EXPECT_DOUBLE_EQ(squaredDistance({-2, 1, 0}, a, b, c), 4);
    EXPECT_DOUBLE_EQ(squaredDistance({2, 2, 0}, a, b, c), 2);
    EXPECT_DOUBLE_EQ(squaredDistance({0.5, 0.5, 3}, a, b, c), 9);
}

// Inside a box the distance to the surface is the least of three numbers.
TEST(DistanceBounds, StayBelowTheDistanceAndNearIt) {
    const Vec3 half{1, 0.7, 0.4};
    for (const double cell : {0.05, 0.11}) {
        const DistanceBounds bounds = buildDistanceBounds(boxMesh(half), cell, 2.5 * cell);
        SplitMix64 random(1);
        for (int i = 0; i < 20'000; ++i) {
            const Vec3 p = anyPoint(random, half);
            const double distance = std::min({half.x - std::abs(p.x), half.y - std::abs(p.y), half.z - std::abs(p.z)});
            const double bound = bounds.at(toFloat(p));
            EXPECT_LE(bound, distance);
            // A diagonal of the point's cell, one of the surface's, and the steps of the values.
            EXPECT_GE(bound, distance - (2 * std::sqrt(3.0) + 0.2) * cell);
        }
        EXPECT_EQ(bounds.at(toFloat(Vec3{1.04, 0, 0})), 0) << "outside";
        EXPECT_EQ(bounds.at(toFloat(Vec3{50, 0, 0})), 0) << "outside of the grid";
    }
}

// What the regions clear, rays confirm; and of flights near the surface that stay inside they clear about as much as
// when this was written.
void expectSafe(const Mesh& mesh, double cell, double mfp, double least_cleared) {
    const SafeRegions regions = buildSafeRegions(mesh, cell, mfp);
    const RayScene rays(mesh);
    SplitMix64 random(3);
    int inside = 0, cleared = 0;
    for (int i = 0; i < 100'000; ++i) {
        // Below a point of the surface, up to two mean free paths.
        const std::size_t t = random.next() % mesh.triangles.size();
        const auto& [a, b, c] = mesh.triangles[t];
        const Vec3 p = toDouble(mesh.positions[a]);
        const double root = std::sqrt(random.uniform()), along = root * random.uniform();
        const Vec3 from = p + (1 - root) * (toDouble(mesh.positions[b]) - p) +
                          along * (toDouble(mesh.positions[c]) - p) -
                          (2 * mfp * random.uniform() + 1e-4 * mfp) * unitNormal(mesh, t);
        const Vec3 direction = anyDirection(random);
        const auto out = rays.intersect({toFloat(from), toFloat(direction)});
        if (!out || dot(toDouble(out->normal), direction) <= 0) continue;  // it began outside
        const double length = -mfp * std::log(random.uniform());
        const bool stays = length < static_cast<double>(out->t);
        const bool safe = regions.safe(toFloat(from), toFloat(from + length * direction));
        inside += stays;
        cleared += stays && safe;
        EXPECT_FALSE(safe && !stays) << "flight " << i << " crosses after " << out->t << " of " << length;
    }
    EXPECT_GT(cleared, least_cleared * inside);
}

TEST(SafeRegions, ClearNoFlightThatCrosses) {
    expectSafe(boxMesh({3, 2, 1}), 0.1, 0.2, 0.65);
    expectSafe(sphereMesh(2, 4), 0.1, 0.2, 0.6);
    expectSafe(sphereMesh(2, 2), 0.05, 0.05, 0.45);
    // Long flights and wide cells clear little, and nothing that crosses.
    expectSafe(sphereMesh(2, 3), 0.3, 1.0, 0.05);
}

TEST(SafeRegions, AreNoneWhereNothingIsKnown) {
    const SafeRegions regions = unknownRegion({-1, -1, -1}, {1, 1, 1});
    EXPECT_FALSE(regions.safe({0, 0, 0}, {1e-3f, 0, 0}));
    EXPECT_FALSE(regions.safe({5, 0, 0}, {5, 1e-3f, 0}));
}

}  // namespace
}  // namespace searchlight
