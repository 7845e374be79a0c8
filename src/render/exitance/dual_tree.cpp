// A dual tree [GrayMoore2000] with Taylor expansions of second order in the sum of both sides' steps. A pair of nodes
// whose radii add up to no more than the table allows at their distance is done by one expansion for all receivers
// below; otherwise the larger of the two is opened. Receivers in a leaf take what is left from moments, and the rest
// point by point.
#include "render/exitance/dual_tree.h"

#include <algorithm>
#include <cassert>

#include "base/error.h"
#include "base/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/exitance/dual_tree.cpp"
#include <hwy/foreach_target.h>

#include "render/exitance/kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

// A receiver node, what its ancestors know of its light, and the source nodes that are still open.
struct Task {
    std::int32_t node;
    Expansion expansion;
    std::vector<std::int32_t> open;
};

// A list that whole vectors are stored into.
class OpenList {
public:
    OpenList() : nodes_(4096) {}
    std::size_t size() const { return size_; }
    void resize(std::size_t size) { size_ = size; }
    const std::int32_t* data() const { return nodes_.data(); }

    void reserve(std::size_t more) {
        if (size_ + more + 16 > nodes_.size()) nodes_.resize(2 * (size_ + more + 16));
    }

    void append(const std::int32_t* from, std::size_t count) {
        reserve(count);
        std::copy_n(from, count, nodes_.data() + size_);
        size_ += count;
    }

    // Requires reserve(vector).
    HWY_INLINE void appendSet(IntV v, hn::Mask<Int> mask) {
        storeSet(v, mask, Int(), nodes_.data() + size_);
        size_ += hn::CountTrue(Int(), mask);
    }

    std::int32_t pop() { return nodes_[--size_]; }

private:
    std::vector<std::int32_t> nodes_;
    std::size_t size_ = 0;
};

class Traversal {
public:
    Traversal(const DualTreeProblem& problem, DualTreeResult& result)
        : problem_(problem), result_(result), table_(problem.table, problem.opening.distances) {}

    void run(const Task& task) {
        open_.append(task.open.data(), task.open.size());
        descend(task.node, task.expansion, 0);
        open_.resize(0);
    }

    // One step of descend(), with the children as tasks.
    void divide(const Task& task, std::vector<Task>& children) {
        open_.append(task.open.data(), task.open.size());
        Expansion expansion = task.expansion;
        const std::size_t begin = open_.size();
        separate(target(task.node), expansion, 0, begin);
        const std::vector<std::int32_t> open(open_.data() + begin, open_.data() + open_.size());
        forEachChild(task.node, expansion, [&](std::int32_t child, const Expansion& about_child) {
            children.push_back({child, about_child, open});
        });
        open_.resize(0);
    }

    bool divides(std::int32_t node) const { return target(node).child >= 0 && visit(node) == Visit::descend; }

    std::uint64_t interactions = 0, expansions = 0;

private:
    const ReceiverNode& target(std::int32_t node) const {
        return problem_.receivers.nodes[static_cast<std::size_t>(node)];
    }

    Visit visit(std::int32_t node) const {
        return problem_.visits.empty() ? Visit::descend : problem_.visits[static_cast<std::size_t>(node)];
    }

    template <class Body>
    void forEachChild(std::int32_t node, const Expansion& expansion, const Body& body) const {
        const ReceiverNode& parent = target(node);
        for (std::int32_t child = parent.child; child < parent.child + 2; ++child) {
            if (visit(child) == Visit::skip) continue;
            const ReceiverNode& to = target(child);
            body(child, shifted(expansion, to.centre.x - parent.centre.x, to.centre.y - parent.centre.y,
                                to.centre.z - parent.centre.z));
        }
    }

    // `expansion` is about the node's centre, the source nodes from `begin` on in open_ are not in it yet.
    void descend(std::int32_t node, const Expansion& inherited, std::size_t begin) {
        const std::size_t end = open_.size();
        Expansion expansion = inherited;
        separate(target(node), expansion, begin, end);
        if (visit(node) == Visit::guess)
            guess(node, expansion, end);
        else if (target(node).child < 0)
            finish(target(node), expansion, end);
        else
            forEachChild(node, expansion,
                         [&](std::int32_t child, const Expansion& about) { descend(child, about, end); });
        open_.resize(end);
    }

    // Tests the source nodes in [begin, end) of open_ and those that come of opening them: what is far enough goes into
    // the expansion, what is left is appended to open_.
    void separate(const ReceiverNode& to, Expansion& expansion, std::size_t begin, std::size_t end) {
        const Float d;
        const Int di;
        const std::size_t lanes = hn::Lanes(d);
        const PointTree::Impl& points = problem_.points;
        const FloatV tx = hn::Set(d, to.centre.x), ty = hn::Set(d, to.centre.y), tz = hn::Set(d, to.centre.z);
        const FloatV b = hn::Set(d, to.radius);
        tested_.resize(0);
        tested_.append(open_.data() + begin, end - begin);
        for (std::size_t i = 0, count; i < tested_.size(); i += count) {
            count = std::min(lanes, tested_.size() - i);
            tested_.reserve(3 * lanes);
            open_.reserve(lanes);
            const auto valid = hn::FirstN(di, count);
            const IntV node = hn::IfThenElseZero(valid, hn::LoadU(di, tested_.data() + i));
            const IntV at = hn::ShiftLeft<2>(node);
            const FloatV dx = hn::Sub(tx, hn::GatherIndex(d, points.spheres.data(), at));
            const FloatV dy = hn::Sub(ty, hn::GatherIndex(d, points.spheres.data() + 1, at));
            const FloatV dz = hn::Sub(tz, hn::GatherIndex(d, points.spheres.data() + 2, at));
            const FloatV a = hn::GatherIndex(d, points.spheres.data() + 3, at);
            const FloatV square = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
            const auto lit = hn::And(valid, hn::RebindMask(di, hn::Ge(a, hn::Zero(d))));
            auto far = hn::FirstN(di, 0);
            if (!problem_.opening.distances.empty()) {
                FloatV w;
                const FloatV allowed = table_.opening(table_.bin(square, w));
                const FloatV crowded = hn::Max(
                    hn::Set(d, 1.0f),
                    hn::Mul(hn::Set(d, problem_.opening.crowding), hn::GatherIndex(d, points.weight.data(), node)));
                far = hn::And(lit, hn::RebindMask(di, hn::Le(hn::Mul(crowded, hn::Add(a, b)), allowed)));
            }
            const auto near = hn::AndNot(far, lit);
            if (!hn::AllFalse(di, near)) {
                const IntV child = hn::GatherIndex(di, points.child.data(), node);
                const auto opened =
                    hn::And(near, hn::And(hn::RebindMask(di, hn::Gt(a, b)), hn::Gt(child, hn::Set(di, -1))));
                open_.appendSet(node, hn::AndNot(opened, near));
                if (!hn::AllFalse(di, opened)) {
                    tested_.appendSet(child, opened);
                    tested_.appendSet(hn::Add(child, hn::Set(di, 1)), opened);
                }
            }
            if (hn::AllFalse(di, far)) continue;
            const auto far_float = hn::RebindMask(d, far);
            storeSet(node, far, di, accepted_.node + accepted_.count);
            storeSet(dx, far_float, d, accepted_.x + accepted_.count);
            storeSet(dy, far_float, d, accepted_.y + accepted_.count);
            storeSet(dz, far_float, d, accepted_.z + accepted_.count);
            accepted_.count += hn::CountTrue(di, far);
            if (accepted_.count + lanes > Accepted::capacity) flush(expansion);
        }
        flush(expansion);
    }

    void flush(Expansion& expansion) {
        expansions += accepted_.count;
        momentsToExpansion(problem_.points.moments.data(), static_cast<std::int32_t>(problem_.points.child.size()),
                           table_, accepted_, expansion);
    }

    // All that is left for the receivers of a leaf, a vector of them at a time.
    void finish(const ReceiverNode& leaf, const Expansion& expansion, std::size_t begin) {
        const Float d;
        const std::size_t lanes = hn::Lanes(d);
        const ReceiverTree::Impl& receivers = problem_.receivers;
        const std::size_t end = open_.size();
        for (std::size_t first = leaf.first; first < leaf.first + leaf.count; first += lanes) {
            const std::size_t count = std::min<std::size_t>(lanes, leaf.first + leaf.count - first);
            Receivers group{hn::LoadU(d, &receivers.x[first]),
                            hn::LoadU(d, &receivers.y[first]),
                            hn::LoadU(d, &receivers.z[first]),
                            {hn::Zero(d), hn::Zero(d), hn::Zero(d)}};
            group.addExpansion(expansion, leaf);
            tested_.resize(0);
            tested_.append(open_.data() + begin, end - begin);
            while (tested_.size() > 0) takeFrom(tested_.pop(), group, count);
            // Whole vectors would reach into the next leaf, which may be another thread's.
            HWY_ALIGN float sums[16];
            for (std::size_t c = 0; c < 3; ++c) {
                hn::Store(group.sum[c], d, sums);
                std::copy_n(sums, count, &result_.exitance[c][first]);
            }
        }
    }

    // Moments must suit the nearest of the receivers.
    HWY_INLINE void takeFrom(std::int32_t node, Receivers& group, std::size_t count) {
        const Float d;
        const PointTree::Impl& points = problem_.points;
        const auto source = static_cast<std::size_t>(node);
        const float* sphere = &points.spheres[4 * source];
        if (sphere[3] < 0) return;
        if (!problem_.opening.distances.empty()) {
            const float crowded = std::max(1.0f, problem_.opening.crowding * points.weight[source]);
            FloatV dx, dy, dz, w;
            const FloatV allowed = table_.opening(table_.bin(group.squareTo(sphere, dx, dy, dz), w));
            const auto near = hn::And(hn::FirstN(d, count), hn::Gt(hn::Set(d, crowded * sphere[3]), allowed));
            if (hn::AllFalse(d, near)) {
                group.addMoments(&points.moments[kStride * source], sphere, table_);
                expansions += count;
                return;
            }
        }
        if (points.child[source] < 0) {
            group.addPoints(points, points.first[source], points.count[source], table_);
            interactions += count * points.count[source];
            return;
        }
        tested_.append(&points.child[source], 1);
        const std::int32_t second = points.child[source] + 1;
        tested_.append(&second, 1);
    }

    // Value at the node's centre, with the open nodes as points.
    void guess(std::int32_t node, const Expansion& expansion, std::size_t begin) {
        const ReceiverNode& to = target(node);
        std::array<float, 3>& sum = result_.guesses[static_cast<std::size_t>(node)];
        for (std::size_t c = 0; c < 3; ++c) sum[c] = expansion.term[c][0];
        for (std::size_t i = begin; i < open_.size(); ++i) {
            const auto source = static_cast<std::size_t>(open_.data()[i]);
            const float* sphere = &problem_.points.spheres[4 * source];
            const float dx = to.centre.x - sphere[0], dy = to.centre.y - sphere[1], dz = to.centre.z - sphere[2];
            const auto& entry =
                problem_.table.entries[problem_.table.bin(dx * dx + dy * dy + dz * dz + problem_.table.offset)];
            for (std::size_t c = 0; c < 3; ++c)
                sum[c] += entry.value[RadialEntry::stride * c] * problem_.points.moments[kStride * source + kTerms * c];
        }
    }

    const DualTreeProblem& problem_;
    DualTreeResult& result_;
    TableLanes table_;
    OpenList open_, tested_;
    Accepted accepted_;
};

void traverseTree(const DualTreeProblem& problem, int threads, DualTreeResult& result) {
    // The same tasks whatever the number of threads.
    constexpr std::size_t enough = 128;
    std::vector<Task> tasks{{0, Expansion{}, {0}}};
    std::vector<Task> next;
    Traversal top(problem, result);
    for (bool divided = true; divided && tasks.size() < enough;) {
        divided = false;
        next.clear();
        for (Task& task : tasks) {
            if (top.divides(task.node)) {
                top.divide(task, next);
                divided = true;
            } else {
                next.push_back(std::move(task));
            }
        }
        std::swap(tasks, next);
    }
    result.expansions += top.expansions;
    std::vector<std::array<std::uint64_t, 2>> counts(tasks.size());
    parallelFor(tasks.size(), threads, [&](std::size_t i) {
        if (problem.observer && problem.observer->cancelled()) throw interruptedError();
        Traversal traversal(problem, result);
        traversal.run(tasks[i]);
        counts[i] = {traversal.interactions, traversal.expansions};
    });
    for (const auto& [interactions, expansions] : counts) {
        result.interactions += interactions;
        result.expansions += expansions;
    }
}

const char* dualTreeTargetName() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(traverseTree);
HWY_EXPORT(dualTreeTargetName);

void traverse(const DualTreeProblem& problem, int threads, DualTreeResult& result) {
    result.interactions = result.expansions = 0;
    for (auto& channel : result.exitance) channel.resize(problem.receivers.order.size());
    result.guesses.clear();
    if (problem.receivers.nodes.empty()) return;
    if (std::find(problem.visits.begin(), problem.visits.end(), Visit::guess) != problem.visits.end())
        result.guesses.resize(problem.receivers.nodes.size());
    HWY_DYNAMIC_DISPATCH(traverseTree)(problem, threads, result);
}

const char* dualTreeInstructionSet() { return HWY_DYNAMIC_DISPATCH(dualTreeTargetName)(); }

}  // namespace searchlight
#endif
