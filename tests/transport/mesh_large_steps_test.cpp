// Walks with large steps against walks that make each collision.
#include <fmt/format.h>

#include "judge.h"
#include "mesh_shapes.h"
#include "transport/mesh/body_walk.h"

namespace searchlight {
namespace {

void compare(Judge& judge, const std::string& what, Estimate a, Estimate b, double exits = 1e9) {
    judge.compare(what, {a.mean - b.mean, std::hypot(a.standard_error, b.standard_error), 1}, 0, exits);
}

template <class Body>
void compareWalks(Judge& judge, const std::string& what, const Body& body, const Medium& medium,
                  const Illumination& light, std::uint64_t walks, std::uint64_t seed) {
    Observer observer;
    const BodyResult with = walkBody(body, medium, 0, light, {.walks = walks, .seed = seed}, observer);
    const BodyResult without =
        walkBody(body, medium, 0, light, {.walks = walks, .seed = seed + 1, .large_steps = false}, observer);
    // They are there: a step makes several collisions at once.
    EXPECT_LT(static_cast<double>(with.flights) / static_cast<double>(with.collisions),
              0.85 * static_cast<double>(without.flights) / static_cast<double>(without.collisions))
        << what;
    compare(judge, what + ", reflectance", with.reflectance, without.reflectance);
    compare(judge, what + ", absorbed", with.absorbed, without.absorbed);
    compare(judge, what + ", collisions", with.collisions_per_entry, without.collisions_per_entry);
    for (int axis = 0; axis < 3; ++axis)
        compare(judge, fmt::format("{}, mean exit {}", what, axis), with.mean_exit[axis], without.mean_exit[axis]);
    for (std::size_t cell = 0; cell < with.exitance.size(); ++cell) {
        const double exits = std::pow(without.exitance[cell] / without.standard_error[cell], 2);
        compare(judge, fmt::format("{}, cell {}", what, cell), {with.exitance[cell], with.standard_error[cell], 1},
                {without.exitance[cell], without.standard_error[cell], 1}, exits);
    }
}

// Walks from the middle of a ball, where the first step is the largest: means over the walks of where and how they
// leave.
class FromTheMiddle : public WalkSource {
public:
    explicit FromTheMiddle(int walks) : rest_(walks) {}

    bool next(Entry& entry) override {
        entry = {{0, 0, 0}, {0, 0, 1}, 1, 0};
        return rest_-- > 0;
    }
    void leave(std::uint32_t, float, Vec3 direction, const Crossing& crossing, std::vector<CellExit>&) override {
        const double outwards = dot(direction, crossing.normal);
        along += crossing.normal.z, cosine += outwards, square += outwards * outwards, forward += direction.z;
    }

    double along = 0, cosine = 0, square = 0, forward = 0;

private:
    int rest_;
};

TEST(LargeSteps, LeaveABallFromItsMiddleAsWalksDo) {
    constexpr int chunks = 64, walks = 2048;
    constexpr const char* names[]{"left", "along", "cosine", "square of the cosine", "forward", "collisions"};
    Judge judge;
    SplitMix64 seeds(1);
    const Ball ball(1, 0.5);
    // Long steps count by their collisions. In the smaller balls the next flight after a step leaves, so that its
    // direction counts.
    for (const auto& [g, sigma_t] : {std::pair{0.0, 11.5}, {0.0, 4.2}, {0.8, 37.0}, {0.8, 8.5}}) {
        Estimate means[2][6];
        for (const bool steps : {false, true}) {
            double sum[6] = {}, squares[6] = {};
            for (int chunk = 0; chunk < chunks; ++chunk) {
                FromTheMiddle source(walks);
                const BodyMedium medium{sigma_t, 0.004, g, 1, steps ? 1024 : 0};
                const BodyChunk done = walkBodyChunk(ball, medium, source, SplitMix64(seeds.next()));
                const double values[]{done.left,     source.along,   source.cosine,
                                      source.square, source.forward, static_cast<double>(done.collisions)};
                for (int i = 0; i < 6; ++i) sum[i] += values[i] / walks, squares[i] += std::pow(values[i] / walks, 2);
            }
            for (int i = 0; i < 6; ++i) {
                const double mean = sum[i] / chunks;
                means[steps][i] = {mean, std::sqrt((squares[i] / chunks - mean * mean) / (chunks - 1)), chunks};
            }
        }
        for (int i = 0; i < 6; ++i)
            compare(judge, fmt::format("g {}, sigma_t {}, {}", g, sigma_t, names[i]), means[0][i], means[1][i]);
    }
    judge.expectAgreement();
}

// An oblique beam, so that places and directions count, and absorption, so that numbers of collisions do.
TEST(LargeSteps, ChangeNothingInASphere) {
    Judge judge;
    const Ball ball(1, 0.2);
    const PencilLight beam{{0, 1, 0}, {0, 1, 0}, {std::sin(1.0), std::cos(1.0), 0}};
    std::uint64_t seed = 1;
    for (const auto& [g, sigma_s, eta] :
         {std::tuple{0.0, 30.0, 1.4}, {0.0, 12.0, 1.0}, {0.8, 120.0, 1.3}, {-0.5, 25.0, 1.0}})
        compareWalks(judge, fmt::format("g {}, eta {}", g, eta), ball, channelMedium(0.15, sigma_s, g, eta), beam,
                     60'000, seed += 2);
    judge.expectAgreement();
}

TEST(LargeSteps, ChangeNothingInAMesh) {
    Judge judge;
    const MeshBody body(boxMesh({1, 0.6, 0.8}), {.cell_area_mm2 = 0.2, .shortest_mfp = 1 / 25.0});
    const Medium medium = channelMedium(0.1, 25, 0.2, 1.3);
    compareWalks(judge, "uniform light", body, medium, UniformLight{}, 200'000, 1);
    compareWalks(judge, "beam", body, medium, PencilLight{{0.2, 0.6, 0.1}, {0, 1, 0}, {0.6, 0.8, 0}}, 60'000, 3);
    judge.expectAgreement();
}

// Walks of a chunk share ways through balls; what that adds to the scatter is in the stated errors.
TEST(LargeSteps, LeaveTheStatedErrorsRight) {
    Observer observer;
    const Ball ball(1, 0.5);
    const Medium medium = channelMedium(0.5, 40, 0, 1.3);
    constexpr int seeds = 60;
    double sum = 0, squares = 0, stated = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        const BodyResult r = walkBody(ball, medium, 0, PencilLight{{0, 1, 0}, {0, 1, 0}, {0, 1, 0}},
                                      {.walks = 64 * 64 * 4, .seed = static_cast<std::uint64_t>(seed)}, observer);
        sum += r.reflectance.mean;
        squares += r.reflectance.mean * r.reflectance.mean;
        stated += r.reflectance.standard_error * r.reflectance.standard_error / seeds;
    }
    // A variance from 60 seeds is known to 18 %.
    EXPECT_NEAR((squares - sum * sum / seeds) / (seeds - 1) / stated, 1, 0.6);
}

}  // namespace
}  // namespace searchlight
