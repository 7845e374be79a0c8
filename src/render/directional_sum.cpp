#include "render/directional_sum.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "model/plane.h"
#include "render/exitance/radial_kernel.h"

namespace searchlight {

namespace {

constexpr std::size_t points_per_leaf = 8;
// Fewer receivers in a group have shorter lists, and making a list is cheap beside evaluating it.
constexpr std::size_t receivers_per_group = 8;
// A node is evaluated four times: so few points are no more work, and exact.
constexpr std::size_t few_points = 4;
// Queries in a batch: 512 stay in the second-level cache; a lone evaluator has threads of its own for many.
constexpr std::size_t small_batch = 512, large_batch = 65'536;

}  // namespace

// One evaluator and what it is about to evaluate.
class DirectionalSum::Worker {
public:
    Worker(const DirectionalSum& sum, Evaluator& evaluator, std::size_t batch)
        : sum_(sum), evaluator_(evaluator), batch_(batch) {
        queries_.reserve(batch);
        terms_.reserve(batch);
        values_.resize(batch);
    }

    void run(const Part& part, double opening, std::span<Rgb> exitance) {
        const std::vector<int> list = sum_.listOf(part.group, opening);
        for (std::size_t place = part.first; place < part.last; ++place) {
            Rgb& target = exitance[place - part.first];
            for (const Beam& beam : sum_.beams_)
                for (const int entry : list)
                    if (entry < 0)
                        addLeaf(beam, static_cast<std::size_t>(~entry), place, target);
                    else
                        addNode(beam.nodes[static_cast<std::size_t>(entry)], place, target);
        }
    }

    /// Evaluates what is left. Returns the number of evaluations.
    std::uint64_t finish() {
        flush();
        return evaluations_;
    }

private:
    struct Term {
        Rgb flux;
        Rgb* target;
    };

    void addNode(const ModelNode& node, std::size_t place, Rgb& target) {
        if (node.flux == Rgbf{}) return;
        const Rgb flux = 0.25 * toDouble(node.flux);
        const Vec3 xi = toDouble(node.position), ni = toDouble(node.normal), wi = toDouble(node.wi);
        for (std::size_t k = 0; k < 4; ++k) {
            const double sign = k % 2 == 0 ? 1 : -1;
            const auto moved = [&](Vec3 mean, const std::array<Vec3f, 2>& offsets) {
                return mean + sign * toDouble(offsets[k / 2]);
            };
            add(moved(xi, node.offsets), normalize(moved(wi, node.wi_offsets)),
                normalize(moved(ni, node.normal_offsets)), flux, place, target);
        }
    }

    void addLeaf(const Beam& beam, std::size_t leaf, std::size_t place, Rgb& target) {
        const int depth = sum_.tree_.depth;
        for (std::size_t i = sum_.tree_.first(depth, leaf); i < sum_.tree_.first(depth, leaf + 1); ++i) {
            const ModelPoint& point = beam.points[i];
            if (point.flux == Rgb{}) continue;
            add(pointOfEntry(point.position, point.normal, sum_.least_mm_[i], sum_.xo_[place]), point.wi, point.normal,
                point.flux, place, target);
        }
    }

    void add(Vec3 xi, Vec3 wi, Vec3 ni, Rgb flux, std::size_t place, Rgb& target) {
        queries_.push_back({xi, wi, ni, sum_.xo_[place], sum_.wo_[place], sum_.no_[place]});
        terms_.push_back({flux, &target});
        if (queries_.size() == batch_) flush();
    }

    void flush() {
        const std::span<Rgb> values(values_.data(), queries_.size());
        evaluator_.evaluate(queries_, values);
        for (std::size_t i = 0; i < values.size(); ++i)
            *terms_[i].target = *terms_[i].target + terms_[i].flux * values[i];
        evaluations_ += values.size();
        queries_.clear();
        terms_.clear();
    }

    const DirectionalSum& sum_;
    Evaluator& evaluator_;
    std::size_t batch_;
    std::vector<Query> queries_;
    std::vector<Term> terms_;
    std::vector<Rgb> values_;
    std::uint64_t evaluations_ = 0;
};

void DirectionalSum::setPoints(const PointCloud& points) {
    assert(!points.positions.empty() && points.areas.size() == points.positions.size() &&
           points.normals.size() == points.positions.size());
    points_ = points;
    area_mm2_ = std::accumulate(points.areas.begin(), points.areas.end(), 0.0);
    tree_ = buildHeapTree(points_.positions, points_per_leaf, threads_);
    folded_.assign(tree_.nodes(), 0);
    least_mm_.clear();
    for (const std::uint32_t i : tree_.order) least_mm_.push_back(leastDistance(points_.areas[i]));
    beams_.clear();
}

void DirectionalSum::setModel(const Model& model, const Medium& medium, const ParamValues& parameters,
                              Evaluator& given) {
    own_.clear();
    evaluators_.clear();
    const int count = threads_ > 0 ? threads_ : hardwareThreads();
    if (hasNativeEvaluator(model))
        for (int i = 0; i < count; ++i) {
            own_.push_back(makeNativeEvaluator(model));
            own_.back()->set(medium, parameters);
            evaluators_.push_back(own_.back().get());
        }
    else
        evaluators_.push_back(&given);
    for (int c = 0; c < Rgb::channels; ++c) scatters_[static_cast<std::size_t>(c)] = medium.scatters(c);
    // Its shape decides which nodes are opened, so it need not be exact.
    constexpr double shape_error = 0.01;
    const Tabulation mean = tabulate(given, model, medium, shape_error);
    const double cell_area = area_mm2_ / static_cast<double>(points_.positions.size());
    table_ = makeRadialTableGl(RadialKernel(mean.profile, cell_area), area_mm2_);
}

void DirectionalSum::setLight(const Irradiance& irradiance, bool reads_wi) {
    beams_.clear();
    folded_.assign(tree_.nodes(), 0);
    if (!reads_wi) return addBeam(modelPoints(points_, points_.normals, irradiance.transmitted));
    for (const searchlight::Beam& beam : irradiance.beams) addBeam(modelPoints(points_, beam.wi, beam.flux));
}

void DirectionalSum::addBeam(std::vector<ModelPoint> points) {
    Beam& beam = beams_.emplace_back();
    beam.nodes = modelNodes(tree_, points, threads_);
    for (std::size_t i = 0; i < beam.nodes.size(); ++i)
        if (isFolded(beam.nodes[i])) folded_[i] = 1;
    for (const std::uint32_t i : tree_.order) beam.points.push_back(points[i]);
}

void DirectionalSum::setReceivers(const VisibleSurface& visible) {
    receiver_tree_ = buildHeapTree(visible.positions, receivers_per_group, threads_);
    xo_.clear();
    no_.clear();
    wo_.clear();
    for (const std::uint32_t i : receiver_tree_.order) {
        xo_.push_back(toDouble(visible.positions[i]));
        no_.push_back(toDouble(visible.normals[i]));
        wo_.push_back(normalize(visible.eye - xo_.back()));
    }
}

std::vector<int> DirectionalSum::listOf(std::size_t group, double opening) const {
    const auto& [x, y, z, radius] = receiver_tree_.spheres[groups() + group];
    const float scale = static_cast<float>(std::cbrt(opening)), offset = static_cast<float>(table_.offset);
    const unsigned leaves = 1u << tree_.depth;
    std::vector<int> list;
    unsigned node = 1;
    do {
        const auto& [sx, sy, sz, size] = tree_.spheres[node];
        // To the nearest receiver that there may be.
        const float distance = std::max(0.0f, std::hypot(x - sx, y - sy, z - sz) - radius);
        bool open = folded_[node] != 0 ||
                    !(size < std::min(scale * table_.reach(distance * distance + offset), 0.7f * distance));
        if (node >= leaves) {
            const std::size_t leaf = node - leaves;
            open = open || tree_.first(tree_.depth, leaf + 1) - tree_.first(tree_.depth, leaf) <= few_points;
        } else if (open) {
            node *= 2;
            continue;
        }
        list.push_back(open ? ~static_cast<int>(node - leaves) : static_cast<int>(node));
        node = (node + 1) >> std::countr_zero(node + 1);
    } while (node != 1);
    return list;
}

DirectionalSum::Result DirectionalSum::sum(std::span<const Part> parts, double opening) {
    std::vector<std::size_t> begins{0};
    for (const Part& part : parts) begins.push_back(begins.back() + part.last - part.first);
    Result result{std::vector<Rgb>(begins.back()), 0};
    std::atomic<std::size_t> next = 0;
    std::atomic<std::uint64_t> evaluations = 0;
    parallelFor(std::min(parts.size(), evaluators_.size()), threads_, [&](std::size_t w) {
        Worker worker(*this, *evaluators_[w], evaluators_.size() > 1 || threads_ == 1 ? small_batch : large_batch);
        for (std::size_t i = next++; i < parts.size(); i = next++)
            worker.run(parts[i], opening, std::span(result.exitance).subspan(begins[i], begins[i + 1] - begins[i]));
        evaluations += worker.finish();
    });
    for (Rgb& value : result.exitance)
        for (int c = 0; c < Rgb::channels; ++c)
            if (!scatters_[static_cast<std::size_t>(c)]) value[c] = 0;
    result.evaluations = evaluations;
    return result;
}

}  // namespace searchlight
