// The reference on a scanned mesh, at the numbers of walks that its faults would need to show.
#include <fmt/format.h>

#include "geometry/object.h"
#include "judge.h"
#include "mesh_shapes.h"

namespace searchlight {
namespace {

Mesh bunny() {
    Scene scene;
    scene.object = dataMesh("bunny_70k_closed.ply");
    scene.scale = 50;
    return placeObject(scene).mesh;
}

BodyResult walk(const MeshBody& body, const Medium& medium, double walks, std::uint64_t seed) {
    Observer observer;
    return walkBody(body, medium, 0, UniformLight{}, {.walks = static_cast<std::uint64_t>(walks), .seed = seed},
                    observer);
}

// Equal exitance on every cell and the mean chord, through ears and folds.
TEST(BodyReferenceSlow, ABunnyIsInEquilibriumInUniformLight) {
    if (!std::filesystem::exists(dataMesh("bunny_70k_closed.ply"))) GTEST_SKIP() << "the mesh is not here";
    const Mesh mesh = bunny();
    Judge judge;
    std::uint64_t seed = 1;
    for (const double eta : {1.0, 1.5}) {
        const Medium medium = channelMedium(0, 2.19, eta == 1 ? 0.7 : 0, eta);
        const MeshBody body(mesh, {.cell_area_mm2 = 20, .shortest_mfp = 1 / 2.19});
        const BodyResult result = walk(body, medium, 1e6, seed++);
        const double t = diffuseTransmittance(eta);
        judge.compare(fmt::format("eta {}, collisions", eta), result.collisions_per_entry,
                      2.19 * eta * eta * 4 * body.volume() / (body.area() * t));
        for (std::size_t cell = 0; cell < result.exitance.size(); ++cell)
            judge.compare(fmt::format("eta {}, cell {}", eta, cell),
                          {result.exitance[cell], result.standard_error[cell], result.candidates}, std::numbers::pi * t,
                          body.cellArea(cell) / body.area() * 1e6);
        EXPECT_EQ(result.lost, 0u);
        EXPECT_LE(result.taken_back, 2u) << "of 1e6; the measured rate is below 1e-7";
    }
    judge.expectAgreement();
}

TEST(BodyReferenceSlow, ABunnyDoesNotDependOnSafeRegions) {
    if (!std::filesystem::exists(dataMesh("bunny_70k_closed.ply"))) GTEST_SKIP() << "the mesh is not here";
    const Mesh mesh = bunny();
    Judge judge;
    const Medium medium = channelMedium(0.0041, 2.62, 0, 1.5);
    const MeshBodyOptions options{.cell_area_mm2 = 20, .shortest_mfp = 1 / 2.62};
    MeshBodyOptions plain_options = options;
    plain_options.regions = false;
    const BodyResult plain = walk(MeshBody(mesh, plain_options), medium, 2e5, 1);
    const BodyResult cleared = walk(MeshBody(mesh, options), medium, 2e5, 2);
    const auto compare = [&](const std::string& what, Estimate a, Estimate b, double exits) {
        judge.compare(what, {a.mean - b.mean, std::hypot(a.standard_error, b.standard_error), 1}, 0, exits);
    };
    compare("reflectance", plain.reflectance, cleared.reflectance, 1e9);
    compare("collisions", plain.collisions_per_entry, cleared.collisions_per_entry, 1e9);
    for (std::size_t cell = 0; cell < plain.exitance.size(); ++cell)
        compare(fmt::format("cell {}", cell), {plain.exitance[cell], plain.standard_error[cell], 1},
                {cleared.exitance[cell], cleared.standard_error[cell], 1},
                std::pow(plain.exitance[cell] / plain.standard_error[cell], 2));
    judge.expectAgreement();
}

}  // namespace
}  // namespace searchlight
