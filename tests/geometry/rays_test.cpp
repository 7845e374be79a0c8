#include "geometry/rays.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "base/error.h"
#include "base/random.h"

namespace searchlight {
namespace {

// An octahedron whose triangles are cut in four `levels` times, its vertices on the unit sphere.
Mesh sphere(int levels) {
    Mesh mesh;
    mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [entry, isNew] =
                middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.positions.size()));
            if (isNew)
                mesh.positions.push_back(toFloat(normalize(toDouble(mesh.positions[a]) + toDouble(mesh.positions[b]))));
            return entry->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& [a, b, c] : mesh.triangles) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(finer);
    }
    return mesh;
}

Vec3 randomDirection(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(0, 1);
    const double z = 2 * uniform(random) - 1;
    const double phi = 2 * std::numbers::pi * uniform(random);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

// Rays from around the sphere towards points near it: about half of them hit.
std::vector<Ray> raysAround(std::size_t count) {
    std::mt19937 random(7);
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        const Vec3 from = 3.0 * randomDirection(random);
        const Vec3 to = 1.5 * randomDirection(random);
        ray = {toFloat(from), toFloat(normalize(to - from))};
    }
    return rays;
}

TEST(Rays, HitASphereWhereTheClosedFormSays) {
    const Mesh mesh = sphere(6);
    const RayScene scene(mesh);
    // How far the flat triangles lie below the sphere.
    double sag = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 p = toDouble(mesh.positions[a]);
        const Vec3 normal = normalize(cross(toDouble(mesh.positions[b]) - p, toDouble(mesh.positions[c]) - p));
        sag = std::max(sag, 1 - dot(normal, p));
    }
    ASSERT_LT(sag, 3e-4);
    int hits = 0;
    for (const Ray& ray : raysAround(5000)) {
        const Vec3 o = toDouble(ray.origin), d = toDouble(ray.direction);
        const double b = dot(o, d), closest2 = dot(o, o) - b * b;
        const std::optional<RayHit> hit = scene.intersect(ray);
        if (closest2 > 1) {
            EXPECT_FALSE(hit);
            continue;
        }
        const double half_chord = std::sqrt(1 - closest2);
        if (half_chord < 0.2) continue;  // grazing: flat triangles differ from the sphere in kind
        ASSERT_TRUE(hit);
        ++hits;
        EXPECT_NEAR(hit->t, -b - half_chord, sag / half_chord * 1.1 + 1e-6);
        const Vec3 at = o + static_cast<double>(hit->t) * d;
        EXPECT_GT(dot(toDouble(hit->normal), at), 0.999);
        EXPECT_NEAR(length(toDouble(hit->normal)), 1, 1e-6);  // rounding to float
    }
    EXPECT_GT(hits, 1000);
}

TEST(Rays, BarycentricCoordinatesGiveTheHitPoint) {
    const Mesh mesh = sphere(3);
    const RayScene scene(mesh);
    for (const Ray& ray : raysAround(500)) {
        const std::optional<RayHit> hit = scene.intersect(ray);
        if (!hit) continue;
        const auto& [a, b, c] = mesh.triangles[hit->triangle];
        const Vec3 by_triangle = (1.0 - hit->u - hit->v) * toDouble(mesh.positions[a]) +
                                 static_cast<double>(hit->u) * toDouble(mesh.positions[b]) +
                                 static_cast<double>(hit->v) * toDouble(mesh.positions[c]);
        const Vec3 by_ray = toDouble(ray.origin) + static_cast<double>(hit->t) * toDouble(ray.direction);
        // 2e-5: float u and v near grazing; lengths are of order 1.
        EXPECT_NEAR(length(by_triangle - by_ray), 0, 2e-5);
    }
}

// Rays from random places inside towards the points at `t` on all edges of the mesh.
std::vector<Ray> raysThroughEdges(const Mesh& mesh, double t) {
    std::mt19937 random(3);
    std::vector<Ray> rays;
    for (const auto& triangle : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const Vec3 a = toDouble(mesh.positions[triangle[k]]);
            const Vec3 b = toDouble(mesh.positions[triangle[(k + 1) % 3]]);
            const Vec3 inside = 0.5 * randomDirection(random);
            rays.push_back({toFloat(inside), toFloat((1 - t) * a + t * b - inside)});
        }
    return rays;
}

std::size_t leaks(const RayScene& scene, const std::vector<Ray>& rays, bool coherent) {
    std::vector<std::uint8_t> hit(rays.size());
    scene.occluded(rays, hit, coherent);
    return static_cast<std::size_t>(std::ranges::count(hit, 0));
}

TEST(Rays, ThroughEdgesNeverLeakOutOfAClosedMesh) {
    const Mesh mesh = sphere(5);
    const RayScene scene(mesh);
    for (const double t : {0.5, 0.25, 0.99}) {
        const std::vector<Ray> rays = raysThroughEdges(mesh, t);
        for (const bool coherent : {false, true})
            EXPECT_EQ(leaks(scene, rays, coherent), 0u) << "of " << rays.size() << " at " << t;
        for (std::size_t i = 0; i < rays.size(); i += 7) EXPECT_TRUE(scene.occluded(rays[i]));
    }
}

TEST(Rays, AimedAtVerticesLeakAsRarelyAsTheHeaderSays) {
    const Mesh mesh = sphere(5);
    const RayScene scene(mesh);
    std::vector<Ray> rays = raysThroughEdges(mesh, 0);
    EXPECT_LT(leaks(scene, rays, false), rays.size() / 200);
    // 1e-5 beside the vertex, a hundred ulps, nothing is left of it.
    std::mt19937 random(5);
    for (Ray& ray : rays) ray.direction = toFloat(toDouble(ray.direction) + 1e-5 * randomDirection(random));
    EXPECT_EQ(leaks(scene, rays, false), 0u);
}

TEST(Rays, CountOnlyHitsBetweenTheirLimits) {
    Mesh mesh;
    mesh.positions = {{-1, -1, 2}, {1, -1, 2}, {0, 1, 2}};
    mesh.triangles = {{0, 1, 2}};
    const RayScene scene(mesh);
    const auto hit = [&](float t_min, float t_max) {
        const Ray ray{{0, 0, 0}, {0, 0, 0.5f}, t_min, t_max};
        EXPECT_EQ(scene.intersect(ray).has_value(), scene.occluded(ray));
        return scene.occluded(ray);
    };
    EXPECT_TRUE(hit(0, std::numeric_limits<float>::infinity()));
    EXPECT_TRUE(hit(3.99f, 4.01f));  // in multiples of the direction, which is half a unit long
    EXPECT_FALSE(hit(0, 3.99f));
    EXPECT_FALSE(hit(4.01f, 9));
}

TEST(Rays, HitBothSidesAndTheNormalStaysOutward) {
    Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    const RayScene scene(mesh);
    for (const float side : {1.0f, -1.0f}) {
        const std::optional<RayHit> hit = scene.intersect({{0, 0, side}, {0, 0, -side}});
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->normal, (Vec3f{0, 0, 1}));
    }
}

TEST(Rays, ManyAtOnceAreTheSameAsOneByOne) {
    const RayScene scene(sphere(4));
    const std::vector<Ray> rays = raysAround(1003);  // no multiple of a packet
    std::vector<RayHit> hits(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    for (const bool coherent : {false, true}) {
        scene.intersect(rays, hits, coherent);
        scene.occluded(rays, occluded, coherent);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const std::optional<RayHit> one = scene.intersect(rays[i]);
            ASSERT_EQ(std::isfinite(hits[i].t), one.has_value());
            ASSERT_EQ(occluded[i] != 0, one.has_value());
            if (one) {
                EXPECT_NEAR(hits[i].t, one->t, 1e-5);  // packets round in another order
            }
        }
    }
}

TEST(Rays, SideBySideListTheHitsOfOneByOne) {
    const Mesh mesh = sphere(4);
    const RayScene scene(mesh);
    SplitMix64 random(8);
    constexpr std::size_t count = 1003;  // fills no packet
    std::vector<float> columns[7];
    for (auto& column : columns) column.resize(count + 15);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < 6; ++k) columns[k][i] = static_cast<float>(2 * random.uniform() - 1);
        columns[6][i] = static_cast<float>(0.2 * random.uniform());
        rays.push_back({{columns[0][i], columns[1][i], columns[2][i]},
                        {columns[3][i], columns[4][i], columns[5][i]},
                        columns[6][i],
                        0.7f});
    }
    std::vector<ListedHit> hits(count);
    const auto of = [&](std::size_t k) { return columns[k].data(); };
    const std::size_t found = scene.intersect({of(0), of(1), of(2), of(3), of(4), of(5), of(6), count, 0.7f}, hits);
    std::size_t next = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto hit = scene.intersect(rays[i]);
        if (!hit) continue;
        ASSERT_LT(next, found);
        EXPECT_EQ(hits[next].ray, i);
        EXPECT_EQ(hits[next].hit.triangle, hit->triangle);
        EXPECT_NEAR(hits[next].hit.t, hit->t, 1e-5);
        EXPECT_EQ(hits[next].hit.normal, hit->normal);
        ++next;
    }
    EXPECT_EQ(next, found);
    EXPECT_GT(found, 100u);
}

TEST(Rays, FromOffsetOriginsMissTheirOwnTriangleAtAnyScaleAndPlace) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (const double scale : {1e-5, 1.0, 1e5})
        for (const double away : {0.0, 20.0}) {
            Mesh mesh = sphere(4);
            for (Vec3f& p : mesh.positions) p = toFloat(scale * (toDouble(p) + Vec3{away, 0, 0}));
            const RayScene scene(mesh);
            int leaks_out = 0, blocked = 0;
            for (std::size_t i = 0; i < 4000; ++i) {
                const auto& [a, b, c] = mesh.triangles[i % mesh.triangles.size()];
                const double u = uniform(random), v = uniform(random) * (1 - u);
                const Vec3 pa = toDouble(mesh.positions[a]), pb = toDouble(mesh.positions[b]),
                           pc = toDouble(mesh.positions[c]);
                const Vec3f at = toFloat((1 - u - v) * pa + u * pb + v * pc);
                const Vec3 normal = normalize(cross(pb - pa, pc - pa));
                Vec3 direction = randomDirection(random);
                if (dot(direction, normal) < 0) direction = -1.0 * direction;
                // A convex body: outwards nothing is in the way, inwards everything is.
                blocked += scene.occluded({scene.offsetOrigin(at, toFloat(normal)), toFloat(direction)});
                leaks_out +=
                    !scene.occluded({scene.offsetOrigin(at, toFloat(-1.0 * normal)), toFloat(-1.0 * direction)});
            }
            EXPECT_EQ(blocked, 0) << scale << " at " << away;
            // A grazing ray into a corner between facets starts outside: 13 degrees of facets, 2^-16 of the extent.
            EXPECT_LE(leaks_out, away == 0 ? 1 : 8) << scale << " at " << away;
        }
}

TEST(Rays, AnEmptyMeshIsAnInputError) {
    try {
        RayScene scene(Mesh{});
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::input);
        EXPECT_STREQ(error.what(), "a mesh without triangles: rays have nothing to hit");
    }
}

}  // namespace
}  // namespace searchlight
