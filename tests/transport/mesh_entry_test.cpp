#include <bit>
#include <cmath>
#include <numbers>

#include "base/random.h"
#include "instruction_sets.h"
#include "mesh_shapes.h"
#include "transport/mesh/closed_body.h"
#include "transport/mesh/entry.h"
#include "transport/mesh/entry_lanes.h"
#include "transport/walk/fresnel.h"

namespace searchlight {
namespace {

EntryLanes anyArrivals(std::uint64_t seed) {
    SplitMix64 random(seed);
    EntryLanes lanes;
    const auto direction = [&] {
        const double z = 2 * random.uniform() - 1, ring = std::sqrt(1 - z * z),
                     turn = 2 * std::numbers::pi * random.uniform();
        return toFloat(Vec3{ring * std::cos(turn), ring * std::sin(turn), z});
    };
    lanes.count = 61;  // fills no vector
    for (std::size_t i = 0; i < lanes.count; ++i) {
        const Vec3f n = direction(), w = direction();
        lanes.nx[i] = n.x, lanes.ny[i] = n.y, lanes.nz[i] = n.z;
        lanes.wx[i] = w.x, lanes.wy[i] = w.y, lanes.wz[i] = w.z;
        lanes.bits[i] = static_cast<std::int32_t>(random.next());
    }
    return lanes;
}

// Snell's law in the plane of incidence, and nothing enters from below or where Fresnel's reflectance is drawn.
TEST(EntryLanes, RefractAsSnellAndFresnelSay) {
    for (const double eta : {1.0, 1.3, 1.5, 0.8}) {
        int entered = 0;
        for (std::uint64_t seed = 1; seed <= 50; ++seed) {
            EntryLanes lanes = anyArrivals(seed);
            refractInwards(lanes, eta);
            for (std::size_t i = 0; i < lanes.count; ++i) {
                const Vec3 n = toDouble(Vec3f{lanes.nx[i], lanes.ny[i], lanes.nz[i]});
                const Vec3 w = toDouble(Vec3f{lanes.wx[i], lanes.wy[i], lanes.wz[i]});
                const Vec3 in = toDouble(Vec3f{lanes.dx[i], lanes.dy[i], lanes.dz[i]});
                const double c = dot(w, n), sine2 = (1 - c) * (1 + c) / (eta * eta);
                const double drawn = static_cast<double>(static_cast<std::uint32_t>(lanes.bits[i]) >> 8) * 0x1p-24;
                const double mirrored = c <= 0 || sine2 >= 1 ? 1 : fresnelReflectance(1, c, eta, std::sqrt(1 - sine2));
                const bool enters = (lanes.enters >> i & 1) != 0;
                if (std::abs(mirrored - drawn) > 1e-5) {
                    EXPECT_EQ(enters, drawn >= mirrored) << eta << " " << c;
                }
                if (!enters) continue;
                ++entered;
                EXPECT_NEAR(length(in), 1, 1e-6);
                EXPECT_NEAR(dot(in, n), -std::sqrt(1 - sine2), 1e-4);
                EXPECT_LT(length(cross(in, n) + (1 / eta) * cross(w, n)), 1e-5);
            }
        }
        EXPECT_GT(entered, 500);
    }
}

TEST(EntryLanes, AgreeBitForBitOnTargetsWithFma) {
    if (!hasInstructionSet(HWY_AVX3)) GTEST_SKIP() << "one instruction set with FMA";
    EntryLanes on[2];
    for (const std::int64_t target : {HWY_AVX3, HWY_AVX2}) {
        hwy::SetSupportedTargetsForTest(target);
        EntryLanes& lanes = on[target == HWY_AVX2];
        lanes = anyArrivals(3);
        alignas(64) std::int32_t heights[EntryLanes::kMost], turns[EntryLanes::kMost];
        SplitMix64 random(4);
        for (std::size_t i = 0; i < EntryLanes::kMost; ++i)
            heights[i] = static_cast<std::int32_t>(random.next()), turns[i] = static_cast<std::int32_t>(random.next());
        drawDiffuse(lanes, heights, turns);
        refractInwards(lanes, 1.4);
    }
    hwy::SetSupportedTargetsForTest(0);
    EXPECT_EQ(on[0].enters, on[1].enters);
    for (std::size_t i = 0; i < on[0].count; ++i) {
        EXPECT_EQ(on[0].wx[i], on[1].wx[i]);
        EXPECT_EQ(on[0].dx[i], on[1].dx[i]);
        EXPECT_EQ(on[0].dz[i], on[1].dz[i]);
    }
}

// Uniform radiance refracted into a body has cosines that are distributed as 2 c dc, with 1 - F of each crossing.
TEST(EntrySource, LetsUniformRadianceInByItsCosine) {
    const MeshBody body(boxMesh({1, 1, 1}), {.shortest_mfp = 1});
    const Illumination light = UniformLight{};
    const double eta = 1.4;
    constexpr std::uint64_t candidates = 100'000;
    EntrySource<MeshBody> source(body, light, {0, eta, std::numbers::pi * body.area()}, candidates, SplitMix64(1));
    double sum = 0, cosines = 0;
    for (Entry entry; source.next(entry);) {
        const Vec3 p = toDouble(entry.position), d = toDouble(entry.direction);
        // The face that it is just below.
        const double x = std::abs(p.x), y = std::abs(p.y), z = std::abs(p.z);
        const double inwards = x > y && x > z ? -d.x * p.x : y > z ? -d.y * p.y : -d.z * p.z;
        EXPECT_GT(std::max({x, y, z}), 1 - 1e-5);
        EXPECT_GT(inwards, std::sqrt(1 - 1 / (eta * eta)) - 1e-4) << "within the cone of refraction";
        sum += 1, cosines += inwards;
    }
    double entered = 0, moment = 0;
    constexpr int steps = 100'000;
    for (int i = 0; i < steps; ++i) {
        const double square = (i + 0.5) / steps, c = std::sqrt(square), t = std::sqrt(1 - (1 - square) / (eta * eta));
        const double crosses = (1 - fresnelReflectance(1, c, eta, t)) / steps;
        entered += crosses, moment += t * crosses;
    }
    EXPECT_EQ(source.tried(), candidates);
    EXPECT_EQ(source.totals().arrivals, candidates);
    EXPECT_NEAR(sum / candidates, entered, 4 * std::sqrt(entered * (1 - entered) / candidates));
    EXPECT_NEAR(cosines / sum, moment / entered, 4 * 0.09 / std::sqrt(sum)) << "cosines spread by less than 0.09";
}

}  // namespace
}  // namespace searchlight
