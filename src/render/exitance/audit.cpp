#include "render/exitance/audit.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace searchlight {

namespace {

// Twice as many as a pilot has: they are summed once, and what is known better has to be shown to less of a margin.
constexpr std::size_t audited_leaves = 128;
// But openings are kept that a sample happened to find good, again and again. Of 540 sums 8 were wrong by more than
// the bound, and 51 by more than the bound less this factor; a pilot for each gave 11 (docs/hierarchical.md).
constexpr double favoured = 1.09;

// The leaves that are visited and all nodes above them.
bool markAncestors(const std::vector<ReceiverNode>& nodes, std::size_t at, std::vector<Visit>& visits) {
    if (const std::int32_t child = nodes[at].child; child >= 0) {
        const bool first = markAncestors(nodes, static_cast<std::size_t>(child), visits);
        const bool second = markAncestors(nodes, static_cast<std::size_t>(child) + 1, visits);
        if (first || second) visits[at] = Visit::descend;
    }
    return visits[at] != Visit::skip;
}

}  // namespace

const Opening& OpeningCache::of(const PilotInput& input, Rgb opening) {
    for (const Entry& entry : entries_)
        if (entry.table == input.table.fingerprint && entry.area == input.points.total_area &&
            entry.parameter == opening)
            return entry.opening;
    Entry& entry = entries_[next_++ % entries_.size()];
    entry = {input.table.fingerprint, input.points.total_area, opening, openingFor(input, opening)};
    return entry.opening;
}

// As the pilot's: half of the probability goes evenly over the receivers, half to where the exitance is. But here every
// leaf's is known.
void Audit::drawLeaves(const PilotInput& input, const DualTreeResult& sums) {
    const std::vector<ReceiverNode>& nodes = input.receivers.nodes;
    leaves_.clear();
    for (std::uint32_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].child < 0) leaves_.push_back(i);
    const std::size_t n = leaves_.size();
    std::vector<Rgb> squares(n);
    constexpr std::size_t grain = 512;
    const std::size_t tasks = (n + grain - 1) / grain;
    std::vector<Rgb> totals(tasks), peaks(tasks);
    parallelFor(tasks, input.threads, [&](std::size_t task) {
        for (std::size_t k = task * grain; k < std::min(n, (task + 1) * grain); ++k) {
            const ReceiverNode& leaf = nodes[leaves_[k]];
            for (int c = 0; c < Rgb::channels; ++c) {
                const float* const value = &sums.exitance[static_cast<std::size_t>(c)][leaf.first];
                float square = 0, largest = 0;
                for (std::uint32_t i = 0; i < leaf.count; ++i) {
                    square += value[i] * value[i];
                    largest = std::max(largest, std::abs(value[i]));
                }
                squares[k][c] = static_cast<double>(square);
                peaks[task][c] = std::max(peaks[task][c], static_cast<double>(largest));
            }
            totals[task] = totals[task] + squares[k];
        }
    });
    Rgb total;
    peak_ = {};
    for (std::size_t task = 0; task < tasks; ++task) {
        total = total + totals[task];
        for (int c = 0; c < Rgb::channels; ++c) peak_[c] = std::max(peak_[c], peaks[task][c]);
    }
    shares_.resize(n);
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) {
        double share = 3.0 * nodes[leaves_[k]].count / static_cast<double>(input.receivers.order.size());
        for (int c = 0; c < Rgb::channels; ++c)
            if (total[c] > 0) share += squares[k][c] / total[c];
        shares_[k] = share;
        sum += share;
    }
    sample_.clear();
    visits_.assign(nodes.size(), Visit::skip);
    double passed = 0;
    std::size_t at = 0;
    for (std::uint32_t k = 0; k < audited_leaves; ++k) {
        const double wanted = sum * (k + 0x1p-32 * scrambled(k + 1)) / audited_leaves;
        while (at + 1 < n && passed + shares_[at] <= wanted) passed += shares_[at++];
        const ReceiverNode& leaf = nodes[leaves_[at]];
        visits_[leaves_[at]] = Visit::descend;
        sample_.push_back({leaf.first, leaf.count, sum / (shares_[at] * audited_leaves)});
    }
    markAncestors(nodes, 0, visits_);
}

void Audit::draw(const PilotInput& input, const DualTreeResult& sums, Rgb opening, OpeningCache& openings) {
    drawLeaves(input, sums);
    reference_opening_ = (1 / reference_fineness) * opening;
    traverse({input.points, input.table, input.receivers, openings.of(input, reference_opening_), visits_},
             input.threads, reference_);
}

SumCalibration Audit::judged(const PilotInput& input, const DualTreeResult& sums, Rgb opening, Rgb& bounds) const {
    SumCalibration result{.opening = opening};
    for (int c = 0; c < Rgb::channels; ++c) {
        if (!matters(input, c)) continue;
        const auto channel = static_cast<std::size_t>(c);
        bounds[c] = judge(sample_, sums.exitance[channel], reference_.exitance[channel], peak_[c],
                          input.receivers.order.size(), result) *
                    favoured * (1 + reference_opening_[c] / opening[c]);
        result.error_bound = std::max(result.error_bound, bounds[c]);
    }
    return result;
}

}  // namespace searchlight
