#include "transport/mesh/reference_body.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <atomic>

#include "base/error.h"
#include "exact.h"
#include "geometry/object.h"
#include "judge.h"
#include "light/light_sampler.h"
#include "mesh_shapes.h"
#include "transport/mesh/body_walk.h"

namespace searchlight {
namespace {

template <class Body>
BodyResult walkUniform(const Body& body, const Medium& medium, double walks, std::uint64_t seed = 1, int threads = 0) {
    Observer observer;
    return walkBody(body, medium, 0, UniformLight{},
                    {.walks = static_cast<std::uint64_t>(walks), .seed = seed, .threads = threads}, observer);
}

// In uniform radiance L a body that does not absorb is in equilibrium, whatever its shape, phase function and index:
// radiance eta^2 L inside, so sigma_t 4 pi eta^2 L V collisions, and exitance pi L T on every part of the surface. For
// eta 1 this is the mean chord: walks are 4 V / S long, scattering or not.
template <class Body>
void compareEquilibrium(Judge& judge, const std::string& what, const Body& body, const Medium& medium,
                        std::uint64_t seed) {
    constexpr double pi = std::numbers::pi;
    const BodyResult result = walkUniform(body, medium, 5e4, seed);
    const double t = diffuseTransmittance(medium.eta), inside = medium.eta * medium.eta;
    judge.compare(what + ", collisions", result.collisions_per_entry,
                  medium.sigmaT().r * inside * 4 * body.volume() / (body.area() * t));
    if (medium.eta == 1) {
        EXPECT_NEAR(result.entered.mean / (pi * body.area()), 1, 1e-12) << what;
    } else {
        judge.compare(what + ", entered", result.entered, pi * t * body.area());
    }
    EXPECT_EQ(result.lost, 0u) << what;
    EXPECT_EQ(result.left.mean, result.entered.mean) << what << ": all that entered leaves";
    for (std::size_t cell = 0; cell < result.exitance.size(); ++cell)
        if (body.cellArea(cell) > 0)
            judge.compare(fmt::format("{}, cell {}", what, cell),
                          {result.exitance[cell], result.standard_error[cell], result.candidates}, pi * t,
                          body.cellArea(cell) / body.area() * 5e4);
}

TEST(BodyReference, IsInEquilibriumInUniformLight) {
    Judge judge;
    std::uint64_t seed = 1;
    for (const double eta : {1.0, 1.3, 1.5})
        for (const double g : {0.0, 0.8}) {
            const Medium medium = channelMedium(0, 2, g, eta);
            const std::string what = fmt::format("eta {}, g {}", eta, g);
            compareEquilibrium(judge, "ball, " + what, Ball(1.5, 1), medium, seed++);
            compareEquilibrium(judge, "box, " + what,
                               MeshBody(boxMesh({1, 2, 0.5}), {.cell_area_mm2 = 0.5, .shortest_mfp = 0.5}), medium,
                               seed++);
            compareEquilibrium(judge, "mesh, " + what,
                               MeshBody(sphereMesh(1.5, 3), {.cell_area_mm2 = 1, .shortest_mfp = 0.5}), medium, seed++);
        }
    judge.expectAgreement();
}

// A beam on the middle of a face of a box so large that its walks never see another: the half-space, in mean free
// paths.
PencilLight beamOnTop(double half, double angle_deg) {
    const double angle = angle_deg * (std::numbers::pi / 180);
    return {{0, half, 0}, {0, 1, 0}, {-std::sin(angle), std::cos(angle), 0}};
}

BodyResult walkBeam(const MeshBody& body, const Medium& medium, double half, double angle_deg, double walks,
                    std::uint64_t seed) {
    Observer observer;
    return walkBody(body, medium, 0, beamOnTop(half, angle_deg),
                    {.walks = static_cast<std::uint64_t>(walks), .seed = seed}, observer);
}

// At albedo 0.9 one walk in 1e7 strays 30 mean free paths.
TEST(BodyReference, IsAHalfSpaceUnderTheFaceOfALargeBox) {
    const MeshBody body(boxMesh({30, 30, 30}), {.cell_area_mm2 = 100, .shortest_mfp = 1});
    Judge judge;
    std::uint64_t seed = 1;
    const CsvTable matched = table("halfspace_isotropic_matched.csv");
    for (std::size_t row = 0; row < matched.rows.size(); ++row) {
        const double albedo = matched.number(row, column(matched, "albedo"));
        if (albedo > 0.91) continue;
        for (const double cosine : {1.0, 0.7, 0.3}) {
            const double angle = std::acos(cosine) * (180 / std::numbers::pi);
            const BodyResult result = walkBeam(body, channelMedium(1 - albedo, albedo), 30, angle, 5e4, seed++);
            judge.compare(fmt::format("albedo {}, cosine {}", albedo, cosine), result.reflectance,
                          matched.number(row, column(matched, fmt::format("R_mu0={:g}", cosine))));
        }
    }
    const CsvTable refractive = table("halfspace_refractive_isotropic.csv");
    for (std::size_t row = 0; row < refractive.rows.size(); ++row) {
        const double n = refractive.number(row, column(refractive, "n"));
        const double albedo = refractive.number(row, column(refractive, "albedo"));
        if (albedo > 0.91) continue;
        const BodyResult result = walkBeam(body, channelMedium(1 - albedo, albedo, 0, n), 30, 0, 5e4, seed++);
        judge.compare(fmt::format("n {}, albedo {}", n, albedo), result.reflectance,
                      refractive.number(row, column(refractive, "R_diffuse")));
    }
    judge.expectAgreement();
}

// Light that enters by refraction leaves, on average, further along: the mean shift is 0.60 mean free paths at 60
// degrees, eta 1.3, albedo 0.99. The half-space walk, which shares no surface code, says the same. Diffusion takes
// e^-10 of it to the next face.
TEST(BodyReference, ShiftsAnObliqueBeamAsTheHalfSpaceDoes) {
    const MeshBody body(boxMesh({60, 60, 60}), {.cell_area_mm2 = 400, .shortest_mfp = 1});
    const BodyResult result = walkBeam(body, channelMedium(0.01, 0.99, 0, 1.3), 60, 60, 1e5, 1);
    HalfSpaceProblem problem = ofAlbedo(0.99, 1.3);
    problem.angle_deg = 60;
    const HalfSpaceResult plane = walk(problem, 1e6, 2);
    const Estimate& shift = result.mean_exit[0];
    const double error = std::hypot(shift.standard_error, plane.all.mean_x_mm.standard_error);
    EXPECT_NEAR(shift.mean, plane.all.mean_x_mm.mean, 4 * error);
    EXPECT_NEAR(shift.mean, 0.60, 4 * shift.standard_error + 0.005);
    EXPECT_NEAR(result.mean_exit[2].mean, 0, 4 * result.mean_exit[2].standard_error) << "nothing leans aside";
    EXPECT_NEAR(result.reflectance.mean, plane.all.total.mean,
                4 * std::hypot(result.reflectance.standard_error, plane.all.total.standard_error));
}

// Each cell of an absorbing body of odd shape, walked with and without safe regions.
TEST(BodyReference, DoesNotDependOnSafeRegions) {
    const Mesh mesh = sphereMesh(1, 2);
    Judge judge;
    std::uint64_t seed = 1;
    Observer observer;
    for (const double sigma_t : {0.5, 4.0, 20.0}) {
        const Medium medium = channelMedium(0.05 * sigma_t, 0.95 * sigma_t, 0.3, 1.4);
        BodyResult results[2];
        for (const bool regions : {false, true}) {
            const MeshBody body(mesh, {.cell_area_mm2 = 0.3, .shortest_mfp = 1 / sigma_t, .regions = regions});
            const Vec3 normal = unitNormal(mesh, 5), middle = toDouble(mesh.positions[mesh.triangles[5][0]]) +
                                                              0.3 * (toDouble(mesh.positions[mesh.triangles[5][1]]) -
                                                                     toDouble(mesh.positions[mesh.triangles[5][0]])) +
                                                              0.3 * (toDouble(mesh.positions[mesh.triangles[5][2]]) -
                                                                     toDouble(mesh.positions[mesh.triangles[5][0]]));
            results[regions] = walkBody(body, medium, 0, PencilLight{middle, normal, normal},
                                        {.walks = 50'000, .seed = seed++}, observer);
        }
        const auto& [plain, cleared] = results;
        if (sigma_t > 10) {
            EXPECT_LT(cleared.rays, plain.rays / 2);
        }
        const auto compare = [&](const char* what, const Estimate& a, const Estimate& b, double exits) {
            judge.compare(fmt::format("sigma_t {}, {}", sigma_t, what),
                          {a.mean - b.mean, std::hypot(a.standard_error, b.standard_error), 1}, 0, exits);
        };
        compare("reflectance", plain.reflectance, cleared.reflectance, 1e9);
        compare("collisions", plain.collisions_per_entry, cleared.collisions_per_entry, 1e9);
        for (std::size_t cell = 0; cell < plain.exitance.size(); ++cell) {
            const double exits = std::pow(plain.exitance[cell] / plain.standard_error[cell], 2);
            compare("cell", {plain.exitance[cell], plain.standard_error[cell], 1},
                    {cleared.exitance[cell], cleared.standard_error[cell], 1}, exits);
        }
    }
    judge.expectAgreement();
}

// 8192 flat triangles lie within 4e-4 of the sphere's radius, and so do volume, area and what they reflect.
TEST(BodyReference, ASphereOfTrianglesIsASphere) {
    Judge judge;
    const MeshBody mesh(sphereMesh(3, 5), {.cell_area_mm2 = 10, .shortest_mfp = 0.5});
    const Ball ball(3, 10);
    std::uint64_t seed = 1;
    for (const double eta : {1.0, 1.4}) {
        const Medium medium = channelMedium(0.1, 1.9, 0.5, eta);
        const BodyResult a = walkUniform(mesh, medium, 1e5, seed++), b = walkUniform(ball, medium, 1e5, seed++);
        const auto compare = [&](const char* what, const Estimate& x, const Estimate& y) {
            judge.compare(
                fmt::format("eta {}, {}", eta, what),
                {x.mean - y.mean, std::hypot(std::hypot(x.standard_error, y.standard_error), 4e-4 * y.mean), 1}, 0);
        };
        compare("reflectance", a.reflectance, b.reflectance);
        compare("absorbed", a.absorbed, b.absorbed);
        compare("collisions", a.collisions_per_entry, b.collisions_per_entry);
    }
    judge.expectAgreement();
}

// Of 9800 mean free paths single precision knows 6e-4. A collision is often nearer to the surface than that, and one
// that is rounded to its far side must be found to have crossed it.
TEST(BodyReference, LosesNoWalkOfALargeBody) {
    const MeshBody mesh(sphereMesh(1, 3), {.cell_area_mm2 = 0.1, .shortest_mfp = 1 / 4900.0});
    const Medium medium = channelMedium(490, 4410, 0, 1.3);
    const BodyResult a = walkUniform(mesh, medium, 1e6, 1), b = walkUniform(Ball(1, 0.1), medium, 1e6, 2);
    EXPECT_EQ(a.lost, 0u);
    EXPECT_LE(a.taken_back, 10u) << "a tenth of the limit";
    EXPECT_NEAR(a.left.mean + a.absorbed.mean * a.incident.mean, a.entered.mean, 1e-9 * a.entered.mean)
        << "what enters leaves or is absorbed";
    EXPECT_NEAR(a.reflectance.mean, b.reflectance.mean,
                4 * std::hypot(a.reflectance.standard_error, b.reflectance.standard_error));
}

// A sphere intercepts its disc; half of it is lit, and what is mirrored, absorbed and left is all there is.
TEST(BodyReference, AccountsForDirectionalLight) {
    Scene scene;
    scene.object = "sphere";
    scene.scale = 4;
    scene.lights = {DirectionalLight{.direction = {1, 2, 3}, .irradiance = {2, 1, 0.5}}};
    const LightSampler lights(scene, placeObject(scene));
    const Ball ball(2, 1);
    Observer observer;
    for (int c = 0; c < 3; ++c) {
        const double irradiance = scene.lights.empty() ? 0 : std::get<DirectionalLight>(scene.lights[0]).irradiance[c];
        const BodyResult r =
            walkBody(ball, makeMedium({0.1, 0.2, 0.3}, {2, 2, 2}, {0}, 1.3), c, &lights, {.walks = 100'000}, observer);
        EXPECT_NEAR(r.incident.mean, irradiance * std::numbers::pi * 4, 4 * r.incident.standard_error);
        EXPECT_LT(r.incident.standard_error, 0.01 * r.incident.mean);
        EXPECT_NEAR(static_cast<double>(r.arrivals), 1e5, 3000) << "the walks asked for, but for roulette";
        EXPECT_NEAR((r.left.mean / r.incident.mean + r.absorbed.mean) * r.incident.mean, r.entered.mean,
                    1e-9 * r.entered.mean);
        EXPECT_LT(r.largest_weight, 1.01);
    }
}

TEST(BodyReference, DoesNotDependOnThreads) {
    const MeshBody body(sphereMesh(1, 3), {.cell_area_mm2 = 0.1, .shortest_mfp = 0.3});
    const Medium medium = channelMedium(0.1, 3, 0.2, 1.3);
    const BodyResult one = walkUniform(body, medium, 1e5, 4, 1), two = walkUniform(body, medium, 1e5, 4, 2);
    EXPECT_EQ(one.exitance, two.exitance);
    EXPECT_EQ(one.standard_error, two.standard_error);
    EXPECT_EQ(one.collisions, two.collisions);
    EXPECT_EQ(one.reflectance.mean, two.reflectance.mean);
    EXPECT_NE(one.exitance, walkUniform(body, medium, 1e5, 5).exitance) << "another seed";
}

class CancelsAfter : public Observer {
public:
    explicit CancelsAfter(std::uint64_t walks) : walks_(walks) {}
    void progress(std::string_view, std::uint64_t done, std::uint64_t, std::string_view) override {
        if (done >= walks_) stop_ = true;
    }
    bool cancelled() const override { return stop_; }

private:
    std::uint64_t walks_;
    std::atomic<bool> stop_ = false;
};

TEST(BodyReference, GoesOnWhereItWasStopped) {
    const Ball ball(1, 0.2);
    const Medium medium = channelMedium(0.2, 3, 0.3, 1.3);
    BodyOptions options{.walks = 100'000, .seed = 7, .threads = 2};
    Observer observer;
    const BodyResult whole = walkBody(ball, medium, 0, UniformLight{}, options, observer);
    WalkState state;
    options.control.state = &state;
    CancelsAfter early(30'000);
    const BodyResult part = walkBody(ball, medium, 0, UniformLight{}, options, early);
    EXPECT_TRUE(part.interrupted);
    EXPECT_GT(part.candidates, 0u);
    EXPECT_LT(part.candidates, whole.candidates);
    const BodyResult rest = walkBody(ball, medium, 0, UniformLight{}, options, observer);
    EXPECT_FALSE(rest.interrupted);
    EXPECT_EQ(rest.exitance, whole.exitance);
    EXPECT_EQ(rest.standard_error, whole.standard_error);
    EXPECT_EQ(rest.collisions, whole.collisions);
    EXPECT_EQ(rest.reflectance.standard_error, whole.reflectance.standard_error);
    EXPECT_EQ(rest.arrivals, whole.arrivals);
}

TEST(BodyReference, StopsWhenTheReflectanceIsKnown) {
    BodyOptions options{.walks = 10'000'000};
    options.control.until_error = 0.01;
    Observer observer;
    const BodyResult r = walkBody(Ball(1, 0.2), channelMedium(0.2, 3, 0, 1.3), 0, UniformLight{}, options, observer);
    EXPECT_LE(r.reflectance.standard_error, 0.01 * r.reflectance.mean);
    EXPECT_LT(r.arrivals, 9'000'000u);
}

// What processes send each other.
TEST(BodyChunk, IsPackedWhole) {
    BodyChunk chunk;
    chunk.entry = {1.5, 1.25, 3, 2};
    chunk.candidates = 4, chunk.collisions = 5, chunk.flights = 6, chunk.rays = 7, chunk.taken_back = 8, chunk.lost = 9;
    chunk.left = 0.5, chunk.absorbed = 0.75, chunk.exits = {-1, 2, 3};
    chunk.cells = {{7, 0.5f}, {100'000, 1.25f}};
    BodyChunk other;
    other.cells = {{1, 1.0f}};
    other.unpack(chunk.pack());
    EXPECT_EQ(other.pack(), chunk.pack());
    EXPECT_EQ(other.cells[1].cell, 100'000u);
    EXPECT_EQ(other.lost, 9u);
    EXPECT_EQ(other.exits.z, 3);
}

// The error that a cell states is that of its mean over seeds.
TEST(BodyReference, StatesItsErrors) {
    const Ball ball(1, 0.2);
    const Medium medium = channelMedium(0.2, 3, 0, 1.3);
    constexpr int seeds = 60;
    std::vector<double> sum(ball.cellCount(), 0.0), squares(sum), stated(sum);
    for (int seed = 1; seed <= seeds; ++seed) {
        const BodyResult r = walkUniform(ball, medium, 4000, static_cast<std::uint64_t>(seed));
        for (std::size_t i = 0; i < sum.size(); ++i) {
            sum[i] += r.exitance[i];
            squares[i] += r.exitance[i] * r.exitance[i];
            stated[i] += r.standard_error[i] * r.standard_error[i] / seeds;
        }
    }
    double ratio = 0;
    for (std::size_t i = 0; i < sum.size(); ++i)
        ratio += (squares[i] - sum[i] * sum[i] / seeds) / (seeds - 1) / stated[i] / static_cast<double>(sum.size());
    // 60 seeds x 72 cells: the mean of the ratios is known to 2 %. Stratified starts make it a little less than 1.
    EXPECT_NEAR(ratio, 0.97, 0.1);
}

void expectRefused(const Mesh& mesh, const std::string& message) {
    try {
        checkClosed(mesh);
        ADD_FAILURE() << "not refused: " << message;
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::input);
        EXPECT_THAT(error.what(), testing::HasSubstr(message));
    }
}

TEST(MeshBody, RefusesWhatEnclosesNothing) {
    Mesh open = boxMesh({1, 1, 1});
    open.triangles.pop_back();
    expectRefused(
        open,
        "the mesh encloses no volume: 3 open edges; the first from (1, 1, -1) to (1, -1, 1), of triangle 10 (a "
        "reference needs a closed mesh in which each edge joins two triangles)");
    Mesh turned = boxMesh({1, 1, 1});
    std::swap(turned.triangles[4][0], turned.triangles[4][1]);
    expectRefused(turned, "3 edges between triangles of opposite orientation; the first from");
    Mesh crowded = boxMesh({1, 1, 1});
    crowded.triangles.push_back({0, 1, 7});
    expectRefused(crowded, "edges of more than two triangles");
    Mesh inside_out = boxMesh({1, 1, 1});
    for (auto& triangle : inside_out.triangles) std::swap(triangle[0], triangle[1]);
    expectRefused(inside_out, "the mesh is inside out: it encloses -8 mm^3");
    expectRefused({}, "a mesh without triangles encloses nothing");
    EXPECT_NO_THROW(checkClosed(boxMesh({1, 1, 1})));
}

TEST(MeshBody, RefusesMoreMeanFreePathsThanFloatResolves) {
    EXPECT_THROW(MeshBody(boxMesh({1, 1, 1}), {.shortest_mfp = 1e-4}), Error);
    EXPECT_THROW(MeshBody(boxMesh({1, 1, 1}), {.shortest_mfp = 0}), Error);
}

// Two boxes that overlap: refused as soon as that shows, not after all walks.
TEST(BodyReference, RefusesAMeshThatCrossesItselfEarly) {
    class Latest : public Observer {
    public:
        void progress(std::string_view, std::uint64_t done, std::uint64_t total, std::string_view) override {
            part = std::max(part.load(), static_cast<double>(done) / static_cast<double>(total));
        }
        std::atomic<double> part = 0;
    };
    Mesh mesh = boxMesh({1, 1, 1});
    const Mesh other = boxMesh({1, 1, 1});
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3f& p : other.positions) mesh.positions.push_back({p.x + 0.9f, p.y + 0.8f, p.z + 0.7f});
    for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
    const MeshBody body(mesh, {.cell_area_mm2 = 1, .shortest_mfp = 0.3});
    Latest observer;
    EXPECT_THROW(walkBody(body, channelMedium(0.1, 3), 0, UniformLight{}, {.walks = 100'000'000}, observer), Error);
    EXPECT_LT(observer.part, 0.1);
}

TEST(BodyReference, RefusesWhatCannotBeWalked) {
    Observer observer;
    const Ball ball(1, 1);
    EXPECT_THROW(walkBody(ball, channelMedium(1, 0), 0, UniformLight{}, {}, observer), Error) << "no scattering";
    EXPECT_THROW(walkBody(ball, channelMedium(0, 1), 0, UniformLight{}, {.walks = 0}, observer), Error);
    Scene scene;
    scene.lights = {DirectionalLight{.direction = {1, 1, 1}, .irradiance = {1, 0, 1}}};
    const LightSampler lights(scene, placeObject(scene));
    EXPECT_THROW(walkBody(ball, channelMedium(0, 1), 1, &lights, {}, observer), Error) << "no light in this channel";
    EXPECT_THROW(Ball(0, 1), Error);
    EXPECT_THROW(walkBody(Ball(5001, 1e6), channelMedium(0, 1), 0, UniformLight{}, {}, observer), Error) << "float";
}

}  // namespace
}  // namespace searchlight
