#include "render/direct.h"

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "io/image_file.h"
#include "model/plane.h"
#include "render/direct/even_points.h"
#include "render/direct/probe_hits.h"
#include "render/direct/walked_single.h"
#include "render/renderer.h"
#include "scene/materials.h"
#include "transport/mesh/first_orders.h"

namespace searchlight {
namespace {

MaterialSource shipped() {
    return [](const Scene& scene) {
        RenderMaterial material{loadModel(scene.model.id), resolveMaterial(scene.material).medium, nullptr};
        material.evaluator = makeNativeEvaluator(material.model);
        material.evaluator->set(material.medium, {});
        return material;
    };
}

// A square of 160 mm, lit from above, and receivers in its middle: further from the edge than light travels.
struct LitPlane {
    Scene scene;
    Object object;
    RenderMaterial material;
    Profile profile;
    std::optional<RayScene> rays;
    VisibleSurface visible;
    RenderInput input;

    explicit LitPlane(const std::string& model = "dipole") {
        scene.model.id = model;
        scene.lights = {DirectionalLight{.direction = {0, 0, 1}}};
        object.mesh.positions = {{-80, -80, 0}, {80, -80, 0}, {80, 80, 0}, {-80, 80, 0}};
        object.mesh.normals.assign(4, {0, 0, 1});
        object.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        object.longest_mm = 160;
        object.half_extent = {80, 80, 0};
        rays.emplace(object.mesh);
        material = shipped()(scene);
        profile = tabulate(*material.evaluator, material.model, material.medium).profile;
        visible.eye = {0, 0, 500};
        for (int i = 0; i < 64; ++i) {
            visible.positions.push_back({0.37f * static_cast<float>(i % 8), 0.53f * static_cast<float>(i / 8), 0});
            visible.normals.push_back({0, 0, 1});
            visible.geometric_normals.push_back({0, 0, 1});
            visible.pixels.push_back(static_cast<std::uint32_t>(i));
            visible.coverage.push_back(1);
        }
        input = {.scene = &scene,
                 .object = &object,
                 .rays = &*rays,
                 .visible = &visible,
                 .model = &material.model,
                 .evaluator = material.evaluator.get(),
                 .medium = &material.medium,
                 .profile = isRadial(material.model) ? &profile : nullptr,
                 .light = {.eta = material.medium.eta, .beams = !material.model.file.no_wi}};
    }

    std::unique_ptr<Technique> run(const std::string& sampling, double spp) {
        std::unique_ptr<Technique> technique = makeDirect(nullptr);
        Observer quiet;
        technique->start(input,
                         {{"spp", spp}, {"sampling", sampling}, {"pass_points", 512.0}, {"single_scattering", "model"}},
                         quiet);
        while (!technique->step(quiet)) {
        }
        return technique;
    }
};

TEST(Direct, LitPlaneLeavesTheTotalOfTheProfile) {
    LitPlane plane;
    const double eta = plane.material.medium.eta;
    const Rgb expected = pencilBeam(eta, 0).transmittance * plane.profile.total();
    for (const char* sampling : {"area", "probes", "both"}) {
        const auto technique = plane.run(sampling, 256);
        for (std::size_t i = 0; i < 64; ++i)
            for (int c = 0; c < Rgb::channels; ++c) {
                const double error = toDouble(technique->standardError()[i])[c];
                // 5.5 standard errors of 32 steps, once in 10^5 numbers; on a plane probes are exact, to the 1e-4 of
                // the table's cubic and of the light.
                EXPECT_NEAR(toDouble(technique->exitance()[i])[c], expected[c], 5.5 * error + 2e-4 * expected[c])
                    << sampling << " " << i << " " << c;
            }
    }
}

TEST(Direct, ProbesAndPointsTogetherAreLessNoisyThanPointsAlone) {
    LitPlane plane;
    const double area = plane.run("area", 64)->report().standard_error;
    const double both = plane.run("both", 64)->report().standard_error;
    EXPECT_LT(both, 0.5 * area);
}

TEST(Direct, StandardErrorFallsWithTheRootOfTheSamples) {
    LitPlane plane;
    const double few = plane.run("area", 32)->report().standard_error;
    const double many = plane.run("area", 512)->report().standard_error;
    // 16 times the samples: a factor of 4, and more as points are stratified. Each is known to 13 %.
    EXPECT_LT(many, 0.35 * few);
}

TEST(Direct, ADirectionalModelOnAPlaneHasItsTotal) {
    LitPlane plane("directional_dipole");
    const double eta = plane.material.medium.eta;
    const Rgb expected = pencilBeam(eta, 0).transmittance *
                         totalRd(*plane.material.evaluator, plane.material.model, plane.material.medium);
    plane.visible.positions.resize(8);
    plane.visible.normals.resize(8);
    plane.visible.geometric_normals.resize(8);
    const auto technique = plane.run("both", 32);
    for (std::size_t i = 0; i < 8; ++i)
        for (int c = 0; c < Rgb::channels; ++c)
            EXPECT_NEAR(toDouble(technique->exitance()[i])[c], expected[c],
                        5.5 * toDouble(technique->standardError()[i])[c] + 1e-3 * expected[c])
                << i << " " << c;
}

// One scene by both techniques, small.
class Beside {
public:
    Beside(const Scene& scene, std::size_t points) : renderer_(shipped()) {
        settings_ = {.width = 24,
                     .height = 16,
                     .points = points,
                     .technique = "brute_force",
                     .edge_samples = 1,
                     .light_samples = 1024};
        renderer_.setScene(scene);
        renderer_.setSettings(settings_);
        truth = renderer_.render(quiet_);
    }

    void run(const std::string& sampling, double spp) {
        settings_.technique = "direct";
        settings_.technique_options = {{"sampling", sampling}, {"spp", spp}, {"pass_points", 2048.0}};
        renderer_.setSettings(settings_);
        direct = renderer_.render(quiet_);
        error = renderer_.standardError();
    }

    Image direct, error, truth;

private:
    Observer quiet_;
    Renderer renderer_;
    RenderSettings settings_;
};

// Root mean square of the difference over its standard error; `floor`: what the other one may err, relative.
double spread(const Beside& images, double floor) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < images.truth.pixels.size(); ++i) {
        const Rgba &a = images.direct.pixels[i], &b = images.truth.pixels[i], &e = images.error.pixels[i];
        if (b.a == 0 || b.g <= 0) continue;
        for (const auto& [x, y, s] :
             {std::array{a.r, b.r, e.r}, std::array{a.g, b.g, e.g}, std::array{a.b, b.b, e.b}}) {
            sum += std::pow((x - y) / std::hypot(s, floor * y), 2);
            ++count;
        }
    }
    return std::sqrt(sum / count);
}

TEST(Direct, AgreesWithTheSumOverPointsOnAKnot) {
    Scene scene;
    scene.object = "torus_knot";
    scene.scale = 20;
    scene.lights = {DirectionalLight{.direction = {1, 1, 1}}, PointLight{.position = {-1, 0.5, 1}}};
    Beside images(scene, 30'000);
    for (const char* sampling : {"area", "probes", "both"}) {
        images.run(sampling, 64);
        // 1 for honest errors. Points are shared by all pixels, so their 32 steps count as few numbers. 1 %: what
        // 30,000 points miss at shadow borders.
        EXPECT_LT(spread(images, 0.01), 1.5) << sampling;
    }
}

TEST(Direct, AgreesForAModelThatReadsDirections) {
    Scene scene;
    scene.object = "torus_knot";
    scene.scale = 20;
    scene.model.id = "directional_dipole";
    scene.lights = {DirectionalLight{.direction = {1, 1, 1}}};
    Beside images(scene, 8'000);
    images.run("both", 16);
    EXPECT_LT(spread(images, 0.03), 1.5);  // 3 %: 8,000 points
}

TEST(Direct, DrawsDirectionsFromSurroundingsThatTheObjectShadows) {
    // A bright window in dark surroundings.
    const std::string path = testing::TempDir() + "direct_window.pfm";
    Image window(32, 16, {0.1f, 0.1f, 0.1f, 1});
    for (int y = 2; y < 6; ++y)
        for (int x = 20; x < 25; ++x) window.at(x, y) = {20, 15, 10, 1};
    writeImage(path, {window});
    Scene scene;
    scene.object = "torus_knot";
    scene.scale = 20;
    scene.lights = {EnvironmentLight{.path = path, .occlusion = true}};
    Beside images(scene, 10'000);
    images.run("both", 32);
    // 2 %: 10,000 points, and 1,024 directions that they share.
    EXPECT_LT(spread(images, 0.02), 1.5);
    double off = 0, sum = 0;
    for (std::size_t i = 0; i < images.truth.pixels.size(); ++i) {
        off += images.direct.pixels[i].g - images.truth.pixels[i].g;
        sum += images.truth.pixels[i].g;
    }
    EXPECT_NEAR(off / sum, 0, 0.02);
}

// Everything around a sphere is equally bright: each place leaves what walks under uniform light leave on the mean.
TEST(WalkedSingle, IsThatOfUniformLightOnASphere) {
    const std::string path = testing::TempDir() + "walked_single.pfm";
    writeImage(path, {Image(8, 4, {1, 1, 1, 1})});
    Scene scene;
    scene.object = "sphere";
    scene.scale = 4;
    scene.lights = {EnvironmentLight{.path = path}};
    const Object object = placeObject(scene);
    const RayScene rays(object.mesh);
    const Medium medium = makeMedium({0.3, 0.1, 0.5}, {0.5, 0.9, 0}, {0.2, 0.5, 0}, 1.3);
    const View view = makeView(framedCamera(scene.camera, object, 24, 24), object, 24, 24);
    Observer quiet;
    const VisibleSurface visible = traceVisible(view, object, rays, {}, quiet);
    RenderInput input;
    input.scene = &scene;
    input.object = &object;
    input.visible = &visible;
    input.view = &view;
    input.medium = &medium;
    const std::uint64_t walks = 40'000;
    std::vector<Rgb> exitance(visible.positions.size());
    WalkedSingle(input).addTo(exitance, walks, 7, quiet);
    Rgb mean;
    for (const Rgb& value : exitance) mean = mean + (1.0 / static_cast<double>(exitance.size())) * value;
    const MeshBody body(object.mesh, {.cell_area_mm2 = 1, .shortest_mfp = 1, .regions = false});
    for (int c = 0; c < 2; ++c) {
        const FirstOrders uniform = walkFirstOrders(body, medium, c, UniformLight{}, {.walks = walks}, quiet);
        double flux = 0;
        for (std::size_t cell = 0; cell < body.cellCount(); ++cell) flux += body.cellArea(cell) * uniform.single[cell];
        // Some 10,000 exits are seen, of weights within a factor of two or three: 1 to 2 % of noise.
        EXPECT_NEAR(mean[c], flux / body.area(), 0.06 * flux / body.area());
    }
    EXPECT_EQ(mean.b, 0);  // does not scatter
}

TEST(Direct, RefusesToAddSingleScatteringToAModelThatHasIt) {
    LitPlane plane("dipole+single");
    Observer quiet;
    try {
        makeDirect(nullptr)->start(
            plane.input, {{"spp", 1.0}, {"sampling", "auto"}, {"pass_points", 0.0}, {"single_scattering", "walked"}},
            quiet);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("--single-scattering model"), std::string::npos);
    }
}

TEST(EvenPoints, AreAsDenseEverywhereAndStratified) {
    const Mesh mesh = builtInObject("sphere", -2);
    const SurfaceWalk walk(mesh);
    const EvenPoints even(mesh, walk);
    double above = 0, squares = 0;
    constexpr int draws = 200;
    constexpr std::size_t count = 256;
    for (int seed = 0; seed < draws; ++seed) {
        double share = 0;
        for (const Vec3f& p : even.draw(count, static_cast<std::uint64_t>(seed)).positions) share += p.y > 0;
        above += share / count;
        squares += std::pow(share / count - 0.5, 2);
    }
    // Independent points would scatter by 0.5 / sqrt(256).
    const double scatter = std::sqrt(squares / draws);
    EXPECT_LT(scatter, 0.5 * 0.5 / std::sqrt(count));
    EXPECT_NEAR(above / draws, 0.5, 5 * scatter / std::sqrt(draws));
}

TEST(Probes, CountTheSurfaceWithinReachOnce) {
    // The weights of all hits add up to the surface within reach: that of a sphere below the chord r is pi r^2.
    std::vector<Rgb> values{{3, 2, 1}, {2, 1.5, 1}, {1, 1, 0.5}};
    const Profile profile({0, 4, 12}, values);
    Medium medium;
    medium.sigma_s = {1, 1, 1};
    Mesh mesh = builtInObject("sphere", 1);
    for (Vec3f& p : mesh.positions) {
        const Vec3 unit = normalize(toDouble(p));
        p = toFloat(10 * unit);
    }
    const RayScene rays(mesh);
    const SurfaceWalk walk(mesh);
    const Probes probes(profile, medium);
    VisibleSurface visible;
    for (int i = 0; i < 50; ++i) {
        const Vec3 unit = normalize(Vec3{std::cos(i), std::sin(2.3 * i), 0.3});
        visible.positions.push_back(toFloat(10 * unit));
        visible.normals.push_back(toFloat(unit));
    }
    Observer quiet;
    const ProbeHits found = findHits(probes, visible, 0, 50, 400, 7, rays, walk, 0, quiet);
    double sum = 0, squares = 0;
    std::vector<double> each(50);
    for (const ProbeHit& hit : found.hits) each[hit.receiver] += hit.weight;
    for (const double area : each) sum += area, squares += area * area;
    const double mean = sum / 50, error = std::sqrt((squares / 50 - mean * mean) / 49);
    EXPECT_NEAR(mean, std::numbers::pi * 144, 4 * error + 0.002 * std::numbers::pi * 144);  // 0.2 %: the triangles
    EXPECT_LT(error, 0.03 * mean);
}

}  // namespace
}  // namespace searchlight
