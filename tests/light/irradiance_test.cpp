#include "light/irradiance.h"

#include "base/error.h"
#include "light/places.h"
#include "light/transmitted_cosine.h"

namespace searchlight {
namespace {

using test::brightPixel;
using test::crossed_of_uniform_sky;
using test::litBy;
using test::PictureFile;
using test::Place;

constexpr double pi = std::numbers::pi;

double flux(const Place& place, const std::vector<Rgbf>& transmitted) {
    double sum = 0;
    for (std::size_t i = 0; i < transmitted.size(); ++i) sum += place.cloud.areas[i] * transmitted[i].g;
    return sum;
}

// A square of side 2 facing +y at the origin, cut into triangles, and beside it whatever `more` adds.
Object floor(const std::vector<Vec3f>& more = {}) {
    Object object;
    object.mesh.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
    object.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (std::uint32_t i = 0; i + 4 <= more.size(); i += 4) {
        object.mesh.positions.insert(object.mesh.positions.end(), more.begin() + i, more.begin() + i + 4);
        object.mesh.triangles.insert(object.mesh.triangles.end(), {{4 + i, 5 + i, 6 + i}, {4 + i, 6 + i, 7 + i}});
    }
    object.longest_mm = 2;
    object.half_extent = {1, 1, 1};
    return object;
}

struct FloorPoints {
    explicit FloorPoints(int side = 20) {
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i)
                positions.push_back({-1 + 2 * (static_cast<float>(i) + 0.5f) / static_cast<float>(side), 0,
                                     -1 + 2 * (static_cast<float>(j) + 0.5f) / static_cast<float>(side)});
        normals.assign(positions.size(), {0, 1, 0});
    }
    SurfacePoints points() const { return {positions, normals}; }

    std::vector<Vec3f> positions, normals;
};

TEST(Irradiance, DirectionalOnASphereIsTheClosedForm) {
    Place place(test::sphere(), 20000);
    const Irradiance lit = place.irradiance(litBy({DirectionalLight{{1, 2, -1}, {2, 3, 4}}}));
    // The integral of T12 cos over the lit half of a sphere of 5 mm, as over a hemisphere of directions, times 25 mm^2.
    // 0.3 %: the triangles' area is below the sphere's by 0.1 %, and 20,000 points integrate the kink at the edge.
    EXPECT_NEAR(flux(place, lit.transmitted) / (3 * 25 * crossed_of_uniform_sky), 1, 0.003);
    EXPECT_TRUE(lit.beams.empty());
}

TEST(Irradiance, WithGeometricNormalsLightsTheProjectedAreaOfTheTriangles) {
    Place place(test::sphere(-3), 20000);
    const Vec3 wi = normalize({1, 2, -1});
    double projected = 0;
    const Mesh& mesh = place.object.mesh;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 p = toDouble(mesh.positions[a]);
        projected +=
            std::max(0.0, 0.5 * dot(wi, cross(toDouble(mesh.positions[b]) - p, toDouble(mesh.positions[c]) - p)));
    }
    IrradianceOptions options;
    options.eta = 1;
    options.normals = LitNormals::geometric;
    const Irradiance lit = place.irradiance(litBy({DirectionalLight{wi}}), options);
    // 0.5 %: how evenly 20,000 points fall on some hundred triangles.
    EXPECT_NEAR(flux(place, lit.transmitted) / projected, 1, 0.005);
}

TEST(Irradiance, OfACoarseSphereEndsWhereTheCosineDoes) {
    // Triangles of 20 degrees: without a lift whole ones near the edge of the light would be dark.
    Place place(test::sphere(-3), 5000);
    const Vec3 wi = normalize({1, 2, -1});
    const TransmittedCosine transmitted_cosine(1.3);
    const Irradiance lit = place.irradiance(litBy({DirectionalLight{wi}}));
    int dark = 0, facing = 0;
    for (std::size_t i = 0; i < place.cloud.positions.size(); ++i) {
        const auto cosine = static_cast<float>(dot(wi, toDouble(place.cloud.normals[i])));
        if (cosine <= 0.02) continue;
        ++facing;
        dark += lit.transmitted[i].r == 0;
    }
    EXPECT_LT(dark, facing / 200);
}

TEST(Irradiance, HasNeitherAcneNorLeaks) {
    // A torus-like knot casts shadows on itself; a point is lit if and only if the way from it, well off the surface,
    // is free: rays from 1e-3 of the size above it decide, where they agree with rays from twice that.
    Mesh mesh = builtInObject("torus_knot");
    Place place(test::placed(std::move(mesh)), 5000);
    const Vec3 wi = normalize({0.3, 1, 0.5});
    const Irradiance lit = place.irradiance(litBy({DirectionalLight{wi}}));
    int acne = 0, leaks = 0, judged = 0;
    for (std::size_t i = 0; i < place.cloud.positions.size(); ++i) {
        const Vec3 p = toDouble(place.cloud.positions[i]), n = toDouble(place.cloud.normals[i]);
        if (dot(n, wi) < 0.1) continue;
        const auto blocked = [&](double height) {
            return place.rays.occluded({toFloat(p + (height * place.object.longest_mm) * n), toFloat(wi)});
        };
        if (blocked(1e-3) != blocked(2e-3)) continue;
        ++judged;
        const bool is_lit = lit.transmitted[i].r > 0;
        acne += !is_lit && !blocked(1e-3);
        leaks += is_lit && blocked(1e-3);
    }
    EXPECT_GT(judged, 1500);
    EXPECT_LE(acne, judged / 500);
    EXPECT_LE(leaks, judged / 500);
}

TEST(Irradiance, ARoofShadowsItsHalf) {
    // The roof is over x > 0, well within and beyond the floor elsewhere.
    const Object object = floor({{0, 1, 2}, {3, 1, 2}, {3, 1, -2}, {0, 1, -2}});
    const RayScene rays(object.mesh);
    const FloorPoints cloud;
    Observer observer;
    const Irradiance lit =
        computeIrradiance(cloud.points(), litBy({DirectionalLight{{0, 1, 0}, {1, 1, 1}}}), object, &rays, {}, observer);
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
        EXPECT_NEAR(lit.transmitted[i].r, cloud.positions[i].x > 0 ? 0 : transmittedCosine(1, 1.3), 1e-5);
}

TEST(Irradiance, ADiscCastsAPenumbraOfTheRightWidth) {
    const Object object = floor({{0, 1, 20}, {30, 1, 20}, {30, 1, -20}, {0, 1, -20}});
    const RayScene rays(object.mesh);
    const FloorPoints cloud(40);
    Observer observer;
    // A disc of 30 degrees, seen past an edge 1 above the floor, which hides what leans to +x by more than x.
    const double radius = 15 * pi / 180;
    const Irradiance lit = computeIrradiance(cloud.points(), litBy({DirectionalLight{{0, 1, 0}, {1, 1, 1}, 30}}),
                                             object, &rays, {.eta = 1}, observer);
    for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
        const double x = cloud.positions[i].x;
        if (x < -1.02 * std::tan(radius)) {
            EXPECT_NEAR(lit.transmitted[i].r, 1, 0.002) << x;  // 64 samples of a cosine near 1
        } else if (x > 1.02 * std::tan(radius)) {
            EXPECT_EQ(lit.transmitted[i].r, 0) << x;
        } else {
            // The cosine-weighted part of a disc that a great circle at atan(x) leaves: a straight cut of the disc's
            // projection, sin(radius) wide, is an ellipse's half there; a disc cut at s is within 1 % of it here.
            const double s = std::sin(std::atan(-x)) / std::sin(radius);
            const double seen = 0.5 + (std::asin(s) + s * std::sqrt(1 - s * s)) / pi;
            EXPECT_NEAR(lit.transmitted[i].r, seen, 0.05) << x;  // 64 stratified samples: three of them
        }
    }
}

TEST(Irradiance, AWholeSkyAsADiscGivesWhatItSays) {
    // 180 degrees of uniform radiance irradiance/pi: T12 cos over it, times that.
    Place place(test::sphere(-2), 300);
    IrradianceOptions options;
    options.disc_samples = 1024;
    const Irradiance lit = place.irradiance(litBy({DirectionalLight{{0, 1, 0}, {1, 1, 1}, 180}}), options);
    const auto top = std::ranges::max_element(place.cloud.normals, {}, &Vec3f::y) - place.cloud.normals.begin();
    EXPECT_NEAR(lit.transmitted[top].r, crossed_of_uniform_sky / pi, 0.01);  // the point is not quite on top
}

TEST(Irradiance, PointLightFallsWithTheSquareOfDistanceInLongestSides) {
    const Object object = floor();
    const FloorPoints cloud;
    Observer observer;
    const Vec3 place{0.4, 0.75, 0};  // 1.5 mm above the floor, as the longest side has 2 mm
    const Irradiance lit =
        computeIrradiance(cloud.points(), litBy({PointLight{place, {3, 1, 1}}}), object, nullptr, {}, observer);
    for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
        const Vec3 way = 2.0 * place - toDouble(cloud.positions[i]);
        const double distance = length(way);
        const double expected = 3 * 4 / (distance * distance) * transmittedCosine(way.y / distance, 1.3);
        EXPECT_NEAR(lit.transmitted[i].r / expected, 1, 2e-5);  // the table of T12 cos, float
    }
}

TEST(Irradiance, PointLightIsShadowedOnlyByWhatIsBeforeIt) {
    const FloorPoints cloud;
    Observer observer;
    for (const double height : {0.4, 0.6}) {  // in longest sides: below and above a lid 1 mm above the floor
        const Object object = floor({{-3, 1, 3}, {3, 1, 3}, {3, 1, -3}, {-3, 1, -3}});
        const RayScene rays(object.mesh);
        const Irradiance lit = computeIrradiance(cloud.points(), litBy({PointLight{{0, height, 0}, {1, 1, 1}}}), object,
                                                 &rays, {}, observer);
        for (const Rgbf& value : lit.transmitted) EXPECT_EQ(value.r > 0, height < 0.5);
    }
}

TEST(Irradiance, UniformSkyIsTheClosedFormWithAndWithoutOcclusionOnAConvexObject) {
    const PictureFile sky("sky.pfm", Image(64, 32, {1, 1, 1, 1}));
    Place place(test::sphere(-2), 500);
    for (const bool occlusion : {false, true}) {
        const Irradiance lit = place.irradiance(litBy({EnvironmentLight{.path = sky.path(), .occlusion = occlusion}}));
        double mean = 0;
        for (const Rgbf& value : lit.transmitted) {
            // By 4096 directions: independent ones would scatter by 2 %, stratified ones stay within half of that.
            EXPECT_NEAR(value.r / crossed_of_uniform_sky, 1, occlusion ? 0.01 : 1e-5);
            mean += value.r / static_cast<double>(lit.transmitted.size());
        }
        EXPECT_NEAR(mean / crossed_of_uniform_sky, 1, occlusion ? 2e-3 : 1e-5);
    }
}

TEST(Irradiance, OccludedSkyOverAWallIsHalfOfIt) {
    // At the foot of a wall without end, eta 1: half of the sky's hemisphere is hidden, and half of its irradiance.
    const PictureFile sky("sky.pfm", Image(64, 32, {1, 1, 1, 1}));
    const Object object = floor({{1, 0, 900}, {1, 900, 900}, {1, 900, -900}, {1, 0, -900}});
    const RayScene rays(object.mesh);
    const std::vector<Vec3f> positions{{0.9999f, 0, 0.3f}}, normals{{0, 1, 0}};
    Observer observer;
    const Irradiance lit = computeIrradiance(SurfacePoints{positions, normals},
                                             litBy({EnvironmentLight{.path = sky.path(), .occlusion = true}}), object,
                                             &rays, {.eta = 1}, observer);
    EXPECT_NEAR(lit.transmitted[0].r, pi / 2, 0.02 * pi / 2);
}

TEST(Irradiance, OccludedEnvironmentIsUnbiasedOverTheSeeds) {
    // One pixel is sampled by few directions only; the mean over seeds of few samples has to be that of many.
    Image picture(32, 16, {0.2f, 0.2f, 0.2f, 1});
    picture.at(20, 4) = {90, 60, 30, 1};
    const PictureFile sky("sky.pfm", picture);
    Place place(test::placed(builtInObject("torus_knot", -2)), 60);
    const Scene scene = litBy({EnvironmentLight{.path = sky.path(), .occlusion = true}});
    IrradianceOptions options;
    options.light_samples = 1 << 14;
    const double truth = flux(place, place.irradiance(scene, options).transmitted);
    options.light_samples = 8;
    double mean = 0, squares = 0;
    constexpr int seeds = 200;
    for (int seed = 1; seed <= seeds; ++seed) {
        options.seed = static_cast<std::uint64_t>(1000 + seed);
        const double value = flux(place, place.irradiance(scene, options).transmitted);
        mean += value / seeds, squares += value * value / seeds;
    }
    const double error = std::sqrt((squares - mean * mean) / seeds);
    EXPECT_NEAR(mean, truth, 4 * error + 2e-3 * truth);  // 2e-3: what 16,384 samples leave
    EXPECT_LT(error, 0.05 * truth);
}

TEST(Irradiance, ProgressiveStepsAddUpWhateverTheirSizeAndThreads) {
    const PictureFile sky("sky.pfm", brightPixel(32, 16, 20, 4, {90, 60, 30, 1}));
    Place place(test::placed(builtInObject("torus_knot", -2)), 3000);
    const Scene scene = litBy(
        {EnvironmentLight{.path = sky.path(), .occlusion = true}, DirectionalLight{.angle_deg = 5}, PointLight{}});
    const LitPoints points = prepareLitPoints({place.cloud.positions, place.cloud.normals}, place.object, &place.rays,
                                              LitNormals::shading, 0, place.observer);
    IrradianceOptions options;
    options.light_samples = 96;
    options.threads = 1;
    ProgressiveIrradiance steps(points, scene, place.object, &place.rays, options, place.observer);
    EXPECT_FALSE(steps.complete());
    for (const int count : {32, 16, 48}) steps.step(count, place.observer);
    EXPECT_TRUE(steps.complete());
    EXPECT_EQ(steps.samples(), 96);
    options.threads = 0;
    const Irradiance at_once = computeIrradiance(points, scene, place.object, &place.rays, options, place.observer);
    EXPECT_EQ(steps.result().transmitted, at_once.transmitted);
}

TEST(Irradiance, LightsAddUp) {
    const PictureFile sky("sky.pfm", brightPixel(32, 16, 20, 4, {9, 6, 3, 1}));
    Place place(test::sphere(-2), 500);
    const std::vector<Light> lights{DirectionalLight{{1, 1, 0}, {1, 2, 3}}, PointLight{{0, 2, 0}, {5, 4, 3}},
                                    EnvironmentLight{.path = sky.path()}};
    const Irradiance all = place.irradiance(litBy(lights));
    std::vector<Rgb> sums(place.cloud.positions.size());
    for (const Light& light : lights) {
        const Irradiance one = place.irradiance(litBy({light}));
        for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = sums[i] + toDouble(one.transmitted[i]);
    }
    for (std::size_t i = 0; i < sums.size(); ++i) EXPECT_NEAR(all.transmitted[i].b, sums[i].b, 1e-6 * sums[i].b);
    EXPECT_EQ(place.irradiance(litBy({})).transmitted, std::vector<Rgbf>(500));
}

TEST(Irradiance, BeamsAddUpToWhatWasTransmitted) {
    Image picture(32, 16, {0.2f, 0.3f, 0.5f, 1});
    picture.at(20, 4) = {90, 60, 30, 1};
    const PictureFile sky("sky.pfm", picture);
    Place place(test::placed(builtInObject("torus_knot", -2)), 2000);
    IrradianceOptions options;
    options.beams = true;
    options.light_samples = 256;
    const Scene scene = litBy({DirectionalLight{{1, 1, 0}, {1, 2, 3}, 10}, PointLight{{0, 2, 0}, {5, 4, 3}},
                               EnvironmentLight{.path = sky.path()},
                               EnvironmentLight{.path = sky.path(), .rotation_deg = 90, .occlusion = true}});
    const Irradiance lit = place.irradiance(scene, options);
    ASSERT_EQ(lit.beams.size(), 2u + 17 + 17);
    options.beams = false;
    EXPECT_EQ(place.irradiance(scene, options).transmitted, lit.transmitted);
    double rest = 0, all = 0;
    for (std::size_t i = 0; i < lit.transmitted.size(); ++i) {
        Rgb sum;
        for (const Beam& beam : lit.beams) {
            ASSERT_TRUE(beam.wi.size() == 1 || beam.wi.size() == lit.transmitted.size());
            ASSERT_GE(beam.flux[i].r, 0);
            sum = sum + toDouble(beam.flux[i]);
        }
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sum[c], toDouble(lit.transmitted[i])[c], 1e-5 * sum[c] + 1e-9);  // float
        rest += lit.beams[18].flux[i].g + lit.beams[35].flux[i].g;
        all += sum.g;
    }
    // What has no direction of its own is a minor part.
    EXPECT_LT(rest, 0.1 * all);
}

TEST(Irradiance, PassesAFilterUpright) {
    Image picture(2, 2, {0, 0, 0, 1});
    picture.at(0, 0) = {1, 0, 0, 1};  // above left
    const PictureFile glass("glass.pfm", picture);
    Place place(test::sphere(-2), 2000);
    DirectionalLight light{{0, 0, 1}};
    light.filter = glass.path();
    const Irradiance lit = place.irradiance(litBy({light}));
    for (std::size_t i = 0; i < place.cloud.positions.size(); ++i) {
        const Vec3f& p = place.cloud.positions[i];
        EXPECT_EQ(lit.transmitted[i].g, 0);
        if (p.z > 0.5 && p.x < -4.4 && p.y > 1) {
            EXPECT_GT(lit.transmitted[i].r, 0);
        }
        if (p.x > 4.5 || p.y < -4.5) {
            EXPECT_EQ(lit.transmitted[i].r, 0);
        }
    }
}

TEST(Irradiance, StopsWhenToldTo) {
    struct Impatient : Observer {
        bool cancelled() const override { return true; }
    } impatient;
    Place place(test::sphere(-3), 100);
    EXPECT_THROW(computeIrradiance(SurfacePoints{place.cloud.positions, place.cloud.normals}, litBy({PointLight{}}),
                                   place.object, &place.rays, {}, impatient),
                 Error);
}

TEST(Irradiance, NamesAPictureThatIsMissing) {
    Place place(test::sphere(-3), 100);
    for (const Light& light :
         {Light(EnvironmentLight{.path = "no_such_sky.hdr"}), Light(DirectionalLight{.filter = "no_such_sky.hdr"})})
        try {
            place.irradiance(litBy({light}));
            FAIL();
        } catch (const Error& error) {
            EXPECT_EQ(error.kind, ErrorKind::input);
            EXPECT_EQ(error.file, "no_such_sky.hdr");
        }
}

}  // namespace
}  // namespace searchlight
