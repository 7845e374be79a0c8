// The table of R_d, and the trees' own promises.
#include <gtest/gtest.h>

#include "render/exitance/point_tree.h"
#include "render/exitance/radial_kernel.h"
#include "render/exitance/radial_table.h"
#include "render/exitance/receiver_tree.h"
#include "render/exitance_scene.h"

namespace searchlight {
namespace {

// Integral of 2 pi r R_d over the plane, by the midpoint rule in ln r.
Rgb integral(const RadialTable& table, double last_mm) {
    Rgb sum;
    constexpr int steps = 40'000;
    const double first = 1e-5, width = std::log(2 * last_mm / first) / steps;
    for (int i = 0; i < steps; ++i) {
        const double r = first * std::exp((i + 0.5) * width);
        sum = sum + 2 * std::numbers::pi * r * r * width * table(r);
    }
    return sum;
}

void expectSameFlux(const Profile& profile, double area) {
    const Rgb found = integral(RadialTable(profile, area), profile.radii().back());
    for (int c = 0; c < Rgb::channels; ++c) EXPECT_NEAR(found[c] / profile.total()[c], 1, 1e-4) << area << " mm^2";
}

TEST(RadialTable, KeepsTheTotalWhateverTheCell) {
    for (const char* material : {"skin1", "marble", "ketchup"})
        for (const double area : {1e-4, 1e-2, 1.0}) expectSameFlux(dipoleProfile(material), area);
}

TEST(RadialTable, KeepsTheTotalOfAProfileThatDivergesOrIsCutOff) {
    std::vector<double> radii;
    std::vector<Rgb> diverging, cut;
    for (double r = 1e-4; r < 3; r *= 1.05) {
        radii.push_back(r);
        const double R = std::exp(-r) / r;
        diverging.push_back({R, R, R});
        cut.push_back({1 / (1 + r), 1, 1 / (0.1 + r * r)});  // ends where it still matters
    }
    for (const double area : {1e-3, 0.1}) {
        expectSameFlux(Profile(radii, diverging), area);
        expectSameFlux(Profile(radii, cut), area);
    }
}

TEST(RadialTable, EndsWithoutARing) {
    std::vector<double> radii;
    std::vector<Rgb> values;
    for (int i = 0; i <= 100; ++i) {
        radii.push_back(0.05 * i);
        values.push_back({1, 1, 1});
    }
    const RadialTable table(Profile(radii, values), 0.001);
    double before = table(4)[0];
    // The step from 1 to 0 at 5 mm has become a slope of 1 mm: no interval of 0.01 mm may fall by more than 5 % of it,
    // and only the bulge that holds the flux may rise.
    for (double r = 4; r < 6; r += 0.01) {
        EXPECT_NEAR(table(r)[0], before, 0.05);
        EXPECT_GE(table(r)[0], -1e-4);  // the fit's ripple at the foot
        before = table(r)[0];
    }
    EXPECT_EQ(table(5.6), (Rgb{}));
}

TEST(RadialTable, IsTheProfileFarFromAPoint) {
    const Profile profile = dipoleProfile("skin1");
    const RadialTable table(profile, 1e-3);
    const RadialKernel kernel(profile, 1e-3);
    for (double r = 0.5; r < 20; r *= 1.1)
        for (int c = 0; c < Rgb::channels; ++c) {
            // The disc adds h^2/8 of the Laplacian, 4e-5/mm^2 of a curvature of some 1/mm^2; the profile itself is
            // good to 1e-4 where 2 pi r^2 R_d matters.
            EXPECT_NEAR(kernel(r)[c] / profile(r)[c], 1, 2e-3) << r;
            if (profile(r)[c] * r * r > 1e-6) {
                EXPECT_NEAR(table(r)[c] / kernel(r)[c], 1, 5e-4) << r;
            }
        }
}

TEST(OpeningDistances, GrowWithTheErrorAndShrinkWithEveryChannel) {
    const Profile profile = dipoleProfile("skin1");
    const RadialTable table(profile, 0.01);
    const auto loose = openingOf(table.impl(), {1, 1, 1}, 1000).distances;
    const auto tight = openingOf(table.impl(), {0.01, 0.01, 0.01}, 1000).distances;
    const auto red = openingOf(table.impl(), {0.01, 0, 0}, 1000).distances;
    for (std::size_t i = 0; i < loose.size(); ++i) {
        EXPECT_GT(tight[i], 0);
        // Beyond the profile's end only the way back to it counts, which is stepped through more coarsely.
        if (table.impl().radii[i] > profile.radii().back()) continue;
        EXPECT_GE(loose[i], 0.98f * tight[i]);  // they are found to 2 %
        EXPECT_GE(red[i], 0.98f * tight[i]);
    }
}

TEST(PointTree, MomentsAreThoseOfItsPoints) {
    const LitCloud points = dentedSphere(5000, 7, checker);
    PointTree tree(points.cloud);
    tree.setTransmitted(points.transmitted);
    const PointTree::Impl& impl = tree.impl();
    const float* centre = impl.spheres.data();
    double flux = 0, x = 0, yz = 0;
    for (std::size_t i = 0; i < points.cloud.positions.size(); ++i) {
        const Vec3 p = toDouble(points.cloud.positions[i]);
        const double f = static_cast<double>(points.transmitted[i].g) * static_cast<double>(points.cloud.areas[i]);
        flux += f;
        x += f * (p.x - static_cast<double>(centre[0]));
        yz += f * (p.y - static_cast<double>(centre[1])) * (p.z - static_cast<double>(centre[2]));
    }
    const float* green = impl.moments.data() + PointTree::Impl::moments_per_channel;
    // Float sums of 5000 terms; the first moments cancel against a radius of 7 mm.
    EXPECT_NEAR(static_cast<double>(green[0]) * impl.unit.g, flux, 1e-5 * flux);
    EXPECT_NEAR(static_cast<double>(green[1]) * impl.unit.g, x, 7e-5 * flux);
    EXPECT_NEAR(static_cast<double>(green[8]) * impl.unit.g, yz, 5e-4 * flux);
    EXPECT_NEAR(tree.meanArea(), 4 * std::numbers::pi * 49 / 5000, 1e-6);
}

TEST(PointTree, SpheresHoldTheirLitPoints) {
    const LitCloud points = dentedSphere(5000, 7, halfDark);
    PointTree tree(points.cloud);
    tree.setTransmitted(points.transmitted);
    const PointTree::Impl& impl = tree.impl();
    for (std::size_t node = 0; node < impl.child.size(); ++node) {
        if (impl.child[node] < 0) {
            EXPECT_LE(impl.count[node], PointTree::Impl::leaf_size);
        }
        for (std::size_t i = impl.first[node]; i < impl.first[node] + impl.count[node]; ++i) {
            if (impl.flux[0][i] == 0) continue;
            const float* sphere = &impl.spheres[4 * node];
            EXPECT_LE(std::hypot(impl.x[i] - sphere[0], impl.y[i] - sphere[1], impl.z[i] - sphere[2]),
                      sphere[3] * 1.00001f + 1e-6f);
        }
    }
}

void expectSound(std::span<const Vec3f> receivers) {
    const ReceiverTree tree(receivers);
    const ReceiverTree::Impl& impl = tree.impl();
    std::vector<int> met(receivers.size());
    const std::function<void(std::size_t, std::vector<std::size_t>)> visit = [&](std::size_t at,
                                                                                 std::vector<std::size_t> path) {
        const ReceiverNode& node = impl.nodes[at];
        path.push_back(at);
        if (node.child >= 0) {
            visit(static_cast<std::size_t>(node.child), path);
            visit(static_cast<std::size_t>(node.child) + 1, path);
            return;
        }
        EXPECT_LE(node.count, ReceiverTree::Impl::leaf_size);
        for (std::size_t i = node.first; i < node.first + node.count; ++i) {
            ++met[impl.order[i]];
            const Vec3 p = toDouble(receivers[impl.order[i]]);
            EXPECT_EQ(toFloat(p), (Vec3f{impl.x[i], impl.y[i], impl.z[i]}));
            for (const std::size_t k : path)
                EXPECT_LE(length(p - toDouble(impl.nodes[k].centre)),
                          static_cast<double>(impl.nodes[k].radius) * 1.00001 + 1e-6);
        }
    };
    visit(0, {});
    EXPECT_EQ(std::count(met.begin(), met.end(), 1), static_cast<std::ptrdiff_t>(receivers.size()));
    EXPECT_EQ(impl.nodes[0].count, receivers.size());
}

TEST(ReceiverTree, HoldsEveryReceiverOnceInsideItsNodes) {
    std::vector<Vec3f> receivers = pixelsOfDentedSphere(96, 5);
    expectSound(receivers);
    std::shuffle(receivers.begin(), receivers.end(), std::mt19937(3));
    expectSound(receivers);
    expectSound(std::vector<Vec3f>(777, Vec3f{1, 2, 3}));
    expectSound(std::vector<Vec3f>(1, Vec3f{1, 2, 3}));
}

TEST(ReceiverTree, CutsTilesApartAtASilhouette) {
    // Two sheets, one 10 mm behind the other, seen in tiles that hold the edge.
    std::vector<Vec3f> receivers;
    for (int tile = 0; tile < 64; ++tile)
        for (int i = 0; i < 64; ++i) {
            const float x = 0.1f * static_cast<float>(8 * (tile % 8) + i % 8);
            const float y = 0.1f * static_cast<float>(8 * (tile / 8) + i / 8);
            receivers.push_back({x, y, x + 0.3f * y > 3.1f ? 10.0f : 0.0f});
        }
    const ReceiverTree tree(receivers);
    for (const ReceiverNode& node : tree.impl().nodes) {
        if (node.child < 0) {
            EXPECT_LT(node.radius, 2);
        }
    }
}

}  // namespace
}  // namespace searchlight
