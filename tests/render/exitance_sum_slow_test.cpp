// The promise of the error, over shapes, materials, lights and sizes.
#include <gtest/gtest.h>

#include <filesystem>

#include "geometry/object.h"
#include "geometry/surface_points.h"
#include "render/exitance_scene.h"

namespace searchlight {
namespace {

constexpr std::size_t point_count = 60'000;

// What a camera far away on the z axis sees of a mesh, tile by tile: the nearest of the surface points that fall into a
// pixel, moved to the pixel's centre. Enough like a picture, silhouettes included.
std::vector<Vec3f> pixelsOf(const PointCloud& cloud, double longest_mm) {
    constexpr int side = 256;
    std::vector<Vec3f> nearest(side * side, Vec3f{0, 0, -1e30f});
    const double pixel = 1.02 * longest_mm / side;
    for (const Vec3f& p : cloud.positions) {
        const auto x = static_cast<int>(std::floor(static_cast<double>(p.x) / pixel + side / 2));
        const auto y = static_cast<int>(std::floor(static_cast<double>(p.y) / pixel + side / 2));
        if (x < 0 || x >= side || y < 0 || y >= side) continue;
        Vec3f& here = nearest[static_cast<std::size_t>(y * side + x)];
        if (p.z > here.z)
            here = {static_cast<float>((x + 0.5 - side / 2) * pixel), static_cast<float>((y + 0.5 - side / 2) * pixel),
                    p.z};
    }
    std::vector<Vec3f> receivers;
    for (int tile = 0; tile < side * side / 64; ++tile)
        for (int i = 0; i < 64; ++i) {
            const int x = 8 * (tile % (side / 8)) + i % 8, y = 8 * (tile / (side / 8)) + i / 8;
            const Vec3f& p = nearest[static_cast<std::size_t>(y * side + x)];
            if (p.z > -1e29f) receivers.push_back(p);
        }
    return receivers;
}

std::vector<Rgbf> lightOn(const PointCloud& cloud, const std::string& name, double longest_mm) {
    std::vector<Rgbf> transmitted;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
        const Vec3 n = toDouble(cloud.normals[i]);
        const Vec3 p = (1 / longest_mm) * toDouble(cloud.positions[i]);
        if (name == "lamp") {
            transmitted.push_back(lambert(n));
        } else if (name == "black shadow") {
            const bool lit = p.x + 0.3 * p.y > 0.05 && n.z > -0.5;
            transmitted.push_back(lit ? Rgbf{1, 0.9f, 0.8f} : Rgbf{});
        } else {
            const int cell = static_cast<int>(std::floor(20 * p.x) + std::floor(20 * p.y) + std::floor(20 * p.z));
            transmitted.push_back(cell % 2 == 0 ? Rgbf{1, 0.1f, 0} : Rgbf{0, 0.3f, 1});
        }
    }
    return transmitted;
}

class ExitanceSumOn : public testing::TestWithParam<std::string> {};

TEST_P(ExitanceSumOn, KeepsTheErrorForAnyMaterialLightAndSize) {
    Scene scene;
    scene.object = GetParam();
    if (GetParam().find('.') != std::string::npos) {
        scene.object = SEARCHLIGHT_SOURCE_DIR "/../shared/data/meshes/" + GetParam();
        if (!std::filesystem::exists(scene.object)) GTEST_SKIP() << "no mesh at " << scene.object;
    }
    int number = 0;
    SumCalibration kept;  // from whatever came before
    SumMemory memory;
    for (const double longest : {5.0, 20.0, 80.0}) {
        scene.scale = longest;
        const Object object = placeObject(scene);
        Observer observer;
        const PointCloud cloud = samplePoints(object.mesh, {.count = point_count}, observer);
        const std::vector<Vec3f> receivers = pixelsOf(cloud, longest);
        const std::size_t stride = receivers.size() / 500;
        const std::vector<Vec3f> compared = everyNth<Vec3f>(receivers, stride);
        PointTree tree(cloud);
        for (const char* material : {"skin1", "marble", "ketchup", "whole_milk"}) {
            const Profile profile = dipoleProfile(material);
            const RadialTable table(profile, tree.meanArea());
            const std::string light = std::vector<std::string>{"lamp", "black shadow", "checker"}[number++ % 3];
            const std::vector<Rgbf> transmitted = lightOn(cloud, light, longest);
            tree.setTransmitted(transmitted);
            const std::vector<Rgb> truth = sumExitanceDirectly(cloud, transmitted, profile, compared);
            for (const double error : {0.001, 0.005, 0.01, 0.05}) {
                SCOPED_TRACE(testing::Message() << material << ", " << light << ", " << longest << " mm, " << error);
                for (SumCalibration* calibration : {static_cast<SumCalibration*>(nullptr), &kept}) {
                    SumStatistics statistics;
                    const SumOptions options{.error = error, .calibration = calibration, .memory = &memory};
                    const std::vector<Rgbf> sum = sumExitance(tree, table, receivers, options, &statistics);
                    const SumError found = errorOf(everyNth<Rgbf>(sum, stride), truth);
                    EXPECT_LE(statistics.error_bound, error);
                    // 500 receivers know their error to some 5 %, where few beside a shadow's edge have most of it, too
                    // (80 were up to 25 % off); the table's own is 1e-4.
                    EXPECT_LE(found.rmse, 1.1 * error + 1e-4);
                    EXPECT_LE(found.largest, statistics.largest_error_bound + 1e-3);
                }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, ExitanceSumOn,
                         testing::Values("sphere", "torus_knot", "bunny_7k_closed.obj", "max_planck_11k.obj",
                                         "spot_6k_uv.obj", "goathead_6k.obj"),
                         [](const testing::TestParamInfo<std::string>& shape) {
                             return shape.param.substr(0, shape.param.find('.'));
                         });

}  // namespace
}  // namespace searchlight
