// The sum over 200,000 points for some 310,000 receivers, on one core: the dual tree against an octree with the
// criterion of [JensenBuhler2002] and against the sum point by point. CPU time; the machine's other work shows in all
// of them alike, so take ratios.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "model/evaluator.h"
#include "model/plane.h"
#include "render/exitance/dual_tree.h"
#include "scene/materials.h"

namespace searchlight {
namespace {

Vec3 dented(Vec3 unit, double radius) {
    return radius * (1 + 0.2 * std::sin(5 * unit.x + 1) * std::sin(4 * unit.y) * std::sin(6 * unit.z + 2)) * unit;
}

// A dented sphere under a lamp, and the pixels of a square picture of it in tiles of 8 x 8.
struct Subject {
    PointCloud cloud;
    std::vector<Rgbf> transmitted;
    std::vector<Vec3f> receivers;
    Profile profile;

    Subject(const std::string& material, double radius, std::size_t points, int side) {
        const Model model = loadModel("dipole");
        const auto evaluator = makeNativeEvaluator(model);
        const Medium medium = findMaterial(material).medium;
        evaluator->set(medium, {});
        profile = tabulate(*evaluator, model, medium).profile;
        const Vec3 lamp = normalize(Vec3{1, 1, 1});
        for (std::size_t i = 0; i < points; ++i) {
            const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(points);
            const double ring = std::sqrt(1 - z * z), turn = 2.399963229728653 * static_cast<double>(i);
            const Vec3 unit{ring * std::cos(turn), ring * std::sin(turn), z};
            cloud.positions.push_back(toFloat(dented(unit, radius)));
            cloud.areas.push_back(
                static_cast<float>(4 * std::numbers::pi * radius * radius / static_cast<double>(points)));
            const auto cosine = static_cast<float>(std::max(0.0, dot(unit, lamp)));
            transmitted.push_back({cosine, cosine, cosine});
        }
        for (int tile = 0; tile < side * side / 64; ++tile)
            for (int i = 0; i < 64; ++i) {
                const double x = 8 * (tile % (side / 8)) + i % 8, y = 8 * (tile / (side / 8)) + i / 8;
                const double u = (x + 0.5) / side * 2.04 - 1.02, v = 1.02 - (y + 0.5) / side * 2.04;
                if (u * u + v * v < 1)
                    receivers.push_back(toFloat(dented({u, v, std::sqrt(1 - u * u - v * v)}, radius)));
            }
    }
};

void report(benchmark::State& state, std::size_t receivers) {
    state.counters["per_receiver"] = benchmark::Counter(
        static_cast<double>(receivers), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// A sum with the trees and the calibration as they are when nothing has changed.
void dualTree(benchmark::State& state, const std::string& material, double radius, double error,
              std::size_t points = 200'000, int side = 640) {
    const Subject subject(material, radius, points, side);
    PointTree tree(subject.cloud, 1);
    tree.setTransmitted(subject.transmitted, 1);
    const RadialTable table(subject.profile, tree.meanArea());
    const ReceiverTree receivers(subject.receivers, 1);
    SumCalibration calibration;
    SumStatistics statistics;
    const SumOptions options{.error = error, .threads = 1, .calibration = &calibration};
    sumExitance(tree, table, receivers, options);
    for (auto _ : state) benchmark::DoNotOptimize(sumExitance(tree, table, receivers, options, &statistics));
    report(state, receivers.size());
    state.counters["bound_%"] = 100 * statistics.error_bound;
    state.counters["point_pairs"] =
        static_cast<double>(statistics.interactions) / static_cast<double>(receivers.size());
}

// All of a frame but the picture: 1280 x 720, about 470,000 pixels covered.
enum class Frame {
    still,   // nothing changed
    judged,  // the sum has to be judged, as after a change
    moved    // with new receivers as well
};

void frame(benchmark::State& state, const std::string& material, Frame kind, int threads) {
    const Subject subject(material, 10, 200'000, 784);
    PointTree tree(subject.cloud);
    tree.setTransmitted(subject.transmitted);
    const RadialTable table(subject.profile, tree.meanArea());
    const ReceiverTree receivers(subject.receivers);
    SumCalibration calibration;
    SumMemory memory;
    const SumOptions options{.error = 0.005, .threads = threads, .calibration = &calibration, .memory = &memory};
    std::vector<Rgbf> exitance;
    sumExitance(tree, table, receivers, options, exitance);
    for (auto _ : state) {
        if (kind != Frame::still) calibration.key = 0;
        if (kind == Frame::moved)
            sumExitance(tree, table, ReceiverTree(subject.receivers, threads), options, exitance);
        else
            sumExitance(tree, table, receivers, options, exitance);
        benchmark::DoNotOptimize(exitance.data());
    }
    report(state, subject.receivers.size());
}

void build(benchmark::State& state, const std::string& part) {
    const Subject subject("skin1", 10, 200'000, 640);
    PointTree tree(subject.cloud, 1);
    for (auto _ : state) {
        if (part == "points") benchmark::DoNotOptimize(PointTree(subject.cloud, 1));
        if (part == "light") tree.setTransmitted(subject.transmitted, 1);
        if (part == "table") benchmark::DoNotOptimize(RadialTable(subject.profile, tree.meanArea()));
        if (part == "receivers") benchmark::DoNotOptimize(ReceiverTree(subject.receivers, 1));
    }
}

// Point by point with the same SIMD kernels.
void direct(benchmark::State& state) {
    const Subject subject("skin1", 10, 200'000, 640);
    PointTree tree(subject.cloud, 1);
    tree.setTransmitted(subject.transmitted, 1);
    const RadialTable table(subject.profile, tree.meanArea());
    const std::span<const Vec3f> some(&subject.receivers[subject.receivers.size() / 2], 256);
    const ReceiverTree receivers(some, 1);
    DualTreeResult result;
    for (auto _ : state) traverse({tree.impl(), table.impl(), receivers.impl(), Opening{}, {}}, 1, result);
    report(state, some.size());
}

// The octree of the literature: a node is opened while its area, seen from the nearest point of its box, is above a
// solid angle; otherwise its flux stands at its flux-weighted centre.
class Octree {
public:
    Octree(const PointTree::Impl& points, const RadialTable::Impl& table) : points_(points), table_(table) {
        std::vector<std::uint32_t> all(points.x.size());
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
        const float half = 1.01f * points.whole[3];
        grow({points.whole[0] - half, points.whole[1] - half, points.whole[2] - half}, 2 * half, std::move(all));
    }

    std::array<float, 3> sum(Vec3f xo, float solid_angle) const {
        std::array<float, 3> total{};
        add(0, xo, solid_angle, total);
        return total;
    }

private:
    struct Node {
        float low[3], high[3], centre[3], area = 0, flux[3] = {};
        std::vector<std::uint32_t> children, points;
    };

    std::uint32_t grow(Vec3f corner, float side, std::vector<std::uint32_t> list) {
        const auto at = static_cast<std::uint32_t>(nodes_.size());
        Node node;
        for (int a = 0; a < 3; ++a) node.low[a] = 1e30f, node.high[a] = -1e30f, node.centre[a] = 0;
        float weight = 0;
        for (const std::uint32_t i : list) {
            const float p[] = {points_.x[i], points_.y[i], points_.z[i]};
            const float w = points_.flux[0][i] + points_.flux[1][i] + points_.flux[2][i] + 1e-9f;
            weight += w;
            node.area += points_.area[i];
            for (int a = 0; a < 3; ++a) {
                node.low[a] = std::min(node.low[a], p[a]);
                node.high[a] = std::max(node.high[a], p[a]);
                node.centre[a] += w * p[a];
                node.flux[a] += points_.flux[static_cast<std::size_t>(a)][i];
            }
        }
        for (float& c : node.centre) c /= weight;
        const bool leaf = list.size() <= 8;
        if (leaf) node.points = list;
        nodes_.push_back(std::move(node));
        if (leaf) return at;
        std::array<std::vector<std::uint32_t>, 8> parts;
        const float half = 0.5f * side;
        for (const std::uint32_t i : list)
            parts[(points_.x[i] > corner.x + half ? 1u : 0u) + (points_.y[i] > corner.y + half ? 2u : 0u) +
                  (points_.z[i] > corner.z + half ? 4u : 0u)]
                .push_back(i);
        for (std::size_t k = 0; k < 8; ++k)
            if (!parts[k].empty()) {
                const auto child =
                    grow({corner.x + (k & 1 ? half : 0), corner.y + (k & 2 ? half : 0), corner.z + (k & 4 ? half : 0)},
                         half, std::move(parts[k]));
                nodes_[at].children.push_back(child);
            }
        return at;
    }

    void addPoint(const float* at, const float* flux, Vec3f xo, std::array<float, 3>& total) const {
        const float dx = xo.x - at[0], dy = xo.y - at[1], dz = xo.z - at[2];
        const auto& entry = table_.entries[table_.bin(dx * dx + dy * dy + dz * dz + table_.offset)].value;
        for (std::size_t c = 0; c < 3; ++c) total[c] += flux[c] * entry[RadialEntry::stride * c];
    }

    void add(std::uint32_t at, Vec3f xo, float solid_angle, std::array<float, 3>& total) const {
        const Node& node = nodes_[at];
        const float p[] = {xo.x, xo.y, xo.z};
        float square = 0;
        for (int a = 0; a < 3; ++a) {
            const float off = std::max({node.low[a] - p[a], 0.0f, p[a] - node.high[a]});
            square += off * off;
        }
        if (node.area < solid_angle * square) {
            addPoint(node.centre, node.flux, xo, total);
            return;
        }
        for (const std::uint32_t child : node.children) add(child, xo, solid_angle, total);
        for (const std::uint32_t i : node.points) {
            const float position[] = {points_.x[i], points_.y[i], points_.z[i]};
            const float flux[] = {points_.flux[0][i], points_.flux[1][i], points_.flux[2][i]};
            addPoint(position, flux, xo, total);
        }
    }

    const PointTree::Impl& points_;
    const RadialTable::Impl& table_;
    std::vector<Node> nodes_;
};

void octree(benchmark::State& state, const std::string& material, float solid_angle) {
    const Subject subject(material, 10, 200'000, 640);
    PointTree tree(subject.cloud, 1);
    tree.setTransmitted(subject.transmitted, 1);
    const RadialTable table(subject.profile, tree.meanArea());
    const Octree octree(tree.impl(), table.impl());
    // Whole runs of neighbours, as in a picture, from all over it.
    std::vector<Vec3f> some;
    for (std::size_t i = 0; i < subject.receivers.size(); i += 64 * 97)
        for (std::size_t k = i; k < std::min(i + 64, subject.receivers.size()); ++k)
            some.push_back(subject.receivers[k]);
    const std::vector<Rgbf> truth = sumExitance(tree, table, some, {.error = 2e-4, .threads = 1});
    double error = 0, norm = 0;
    for (std::size_t i = 0; i < some.size(); ++i) {
        const double off = static_cast<double>(octree.sum(some[i], solid_angle)[0]) * tree.impl().unit.r -
                           static_cast<double>(truth[i].r);
        error += off * off;
        norm += static_cast<double>(truth[i].r) * static_cast<double>(truth[i].r);
    }
    for (auto _ : state)
        for (const Vec3f xo : some) benchmark::DoNotOptimize(octree.sum(xo, solid_angle));
    report(state, some.size());
    state.counters["red_error_%"] = 100 * std::sqrt(error / norm);
}

template <class... Arguments>
void row(const std::string& name, Arguments... arguments) {
    benchmark::RegisterBenchmark(name.c_str(), arguments...)->Unit(benchmark::kMillisecond);
}

void registerAll() {
    for (const char* material : {"skin1", "marble"})
        for (const double radius : {2.5, 10.0, 40.0})
            for (const double error : {0.01, 0.004, 0.001})
                row(fmt::format("dual_tree/{}/{}mm/{}%", material, radius, 100 * error),
                    [=](benchmark::State& state) { dualTree(state, material, radius, error); });
    for (const std::size_t points : {std::size_t{10'000}, std::size_t{100'000}, std::size_t{1'000'000}})
        row(fmt::format("points/{}", points),
            [=](benchmark::State& state) { dualTree(state, "skin1", 10, 0.004, points); });
    for (const int side : {160, 320, 1280})
        row(fmt::format("receivers/{}", side * side * 3 / 4),
            [=](benchmark::State& state) { dualTree(state, "skin1", 10, 0.004, 200'000, side); });
    for (const char* material : {"skin1", "marble"})
        for (const auto& [kind, name] :
             {std::pair{Frame::still, "still"}, {Frame::judged, "judged"}, {Frame::moved, "moved"}})
            benchmark::RegisterBenchmark(fmt::format("frame_1280x720/{}/{}", material, name).c_str(),
                                         [=, kind = kind](benchmark::State& state) { frame(state, material, kind, 2); })
                ->Unit(benchmark::kMillisecond)
                ->MeasureProcessCPUTime()
                ->UseRealTime();
    for (const char* part : {"points", "light", "table", "receivers"})
        row(fmt::format("build/{}", part), [=](benchmark::State& state) { build(state, part); });
    row("direct", direct);
    for (const char* material : {"skin1", "marble"})
        for (const float solid_angle : {0.12f, 0.05f})
            row(fmt::format("octree/{}/{}sr", material, solid_angle),
                [=](benchmark::State& state) { octree(state, material, solid_angle); });
}

}  // namespace
}  // namespace searchlight

int main(int argc, char** argv) {
    searchlight::registerAll();
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
