// Sums that follow each other while something moves.
#include <atomic>
#include <cmath>

#include "base/error.h"
#include "exitance_scene.h"

namespace searchlight {
namespace {

constexpr std::size_t point_count = 20'000;
constexpr int side = 160;

// What a camera sees that was turned by that angle about y.
std::vector<Vec3f> seenFrom(double angle, double radius_mm) {
    std::vector<Vec3f> receivers;
    for (const Vec3f& pixel : pixelsOfDentedSphere(side, radius_mm)) {
        const Vec3 unit = normalize(toDouble(pixel));
        receivers.push_back(toFloat(dented({std::cos(angle) * unit.x + std::sin(angle) * unit.z, unit.y,
                                            std::cos(angle) * unit.z - std::sin(angle) * unit.x},
                                           radius_mm)));
    }
    return receivers;
}

struct Moving {
    LitCloud points = dentedSphere(point_count, 10, lambert);
    PointTree tree{points.cloud};
    Profile profile = dipoleProfile("skin1");
    RadialTable table{profile, tree.meanArea()};
    std::vector<Vec3f> receivers = seenFrom(0, 10);
    ReceiverTree receiver_tree{receivers};
    SumCalibration calibration;
    SumMemory memory;
    SumStatistics statistics;

    Moving() { tree.setTransmitted(points.transmitted); }

    void light(const LightAt& light) {
        points.transmitted = dentedSphere(point_count, 10, light).transmitted;
        tree.setTransmitted(points.transmitted);
    }
    void material(std::string_view name) {
        profile = dipoleProfile(name);
        table = RadialTable(profile, tree.meanArea());
    }
    void turn(double angle) {
        receivers = seenFrom(angle, 10);
        receiver_tree = ReceiverTree(receivers);
    }
    std::vector<Rgbf> sum(double error, Observer* observer = nullptr) {
        return sumExitance(tree, table, receiver_tree,
                           {.error = error, .calibration = &calibration, .memory = &memory, .observer = observer},
                           &statistics);
    }
    // Against a sum as exact as it can be asked for, which is itself compared with the direct one elsewhere.
    double rmse(const std::vector<Rgbf>& sum) const {
        std::vector<Rgb> truth;
        for (const Rgbf& value : sumExitance(tree, table, receiver_tree, {.error = 1e-4}))
            truth.push_back(toDouble(value));
        return errorOf(sum, truth).rmse;
    }
};

TEST(ExitanceSequence, KeepsTheErrorWhateverChanges) {
    Moving scene;
    const auto expectKept = [&](double error, const char* what) {
        const std::vector<Rgbf> sum = scene.sum(error);
        EXPECT_LE(scene.statistics.error_bound, error) << what;
        EXPECT_LE(scene.rmse(sum), error) << what;
    };
    expectKept(0.004, "first");
    for (const double angle : {0.02, 0.04, 1.5, 3.1}) {
        scene.turn(angle);
        expectKept(0.004, "camera");
    }
    scene.light(halfDark);
    expectKept(0.004, "black shadow");
    scene.light(checker);
    expectKept(0.004, "checker");
    // Seen from where hardly any light gets.
    scene.light([](Vec3 unit) { return unit.z > 0.95 ? Rgbf{1, 1, 1} : Rgbf{}; });
    expectKept(0.004, "the far side");
    scene.material("marble");
    expectKept(0.004, "marble");
    scene.material("ketchup");
    expectKept(0.004, "ketchup");
    expectKept(0.0005, "eight times as exact");
    expectKept(0.05, "hundred times as coarse");
    scene.light([](Vec3 unit) { return unit.x > 0.999 ? Rgbf{0, 1, 0} : Rgbf{}; });
    scene.turn(0);
    expectKept(0.004, "a few points");
    scene.light([](Vec3) { return Rgbf{}; });
    for (const Rgbf& value : scene.sum(0.004)) ASSERT_EQ(value, Rgbf{});
    scene.light(lambert);
    scene.material("skin1");
    expectKept(0.004, "as at first");
}

TEST(ExitanceSequence, ASmallChangeTakesOneSum) {
    Moving scene;
    scene.sum(0.004);
    int taken = 0;
    for (int frame = 1; frame <= 20; ++frame) {
        scene.turn(0.02 * frame);
        scene.sum(0.004);
        EXPECT_TRUE(scene.statistics.calibrated);
        taken += scene.statistics.taken;
    }
    // Samples differ: a few of the twenty may be judged above the limit.
    EXPECT_LE(taken, 24);
    // The opening follows the error in both directions, so what is promised is not far below what was asked.
    EXPECT_GT(scene.statistics.error_bound, 0.5 * 0.004);
}

TEST(ExitanceSequence, DoesNotDependOnThreads) {
    Moving one, two;
    std::vector<Rgbf> sums[2];
    for (const double angle : {0.0, 0.1, 2.0}) {
        one.turn(angle);
        two.turn(angle);
        sums[0] = sumExitance(one.tree, one.table, one.receiver_tree,
                              {.threads = 1, .calibration = &one.calibration, .memory = &one.memory});
        sums[1] = sumExitance(two.tree, two.table, two.receiver_tree,
                              {.threads = 2, .calibration = &two.calibration, .memory = &two.memory});
        EXPECT_EQ(sums[0], sums[1]);
    }
}

TEST(ExitanceSequence, StopsWithinASumAndForgetsNothing) {
    struct Impatient : Observer {
        bool cancelled() const override { return ++asked > 10; }
        mutable std::atomic<int> asked = 0;
    };
    Moving scene, other;
    const std::vector<Rgbf> first = scene.sum(0.004);
    EXPECT_EQ(other.sum(0.004), first);
    const SumCalibration before = scene.calibration;
    scene.turn(0.5);
    Impatient observer;
    EXPECT_THROW(scene.sum(0.004, &observer), Error);
    EXPECT_LT(observer.asked, 40);
    EXPECT_EQ(scene.calibration.key, before.key);
    EXPECT_EQ(scene.calibration.opening, before.opening);
    other.turn(0.5);
    EXPECT_EQ(scene.sum(0.004), other.sum(0.004));
    scene.turn(0);
    other.turn(0);
    EXPECT_EQ(scene.sum(0.004), other.sum(0.004));
}

}  // namespace
}  // namespace searchlight
