#include "transport/walk/tally.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "transport/walk/long_walk.h"

namespace searchlight {

namespace {

constexpr int kMantissaBits = 52;
constexpr std::size_t kMostCells = 1 << 16;

}  // namespace

RadialBins::RadialBins(std::span<const double> edges) {
    assert(edges.size() >= 2 && edges.front() >= 0);
    for (const double edge : edges) next_edge_.push_back(edge * edge);
    next_edge_.push_back(std::numeric_limits<double>::infinity());

    // The bits of a positive double grow with its value, so their upper part is a table index that is logarithmic in
    // scale: refine it until no cell holds more than one edge, or the table leaves the cache.
    const std::size_t first = next_edge_[0] > 0 ? 0 : 1;
    const std::span<const double> squares(next_edge_.data() + first, edges.size() - first);
    std::size_t cells = 0;
    for (int bits = 4; bits <= 14; ++bits) {
        const int shift = kMantissaBits - bits;
        const auto cell = [&](double r2) { return std::bit_cast<std::int64_t>(r2) >> shift; };
        const auto needed = static_cast<std::size_t>(cell(squares.back()) - cell(squares.front())) + 1;
        if (steps_ == 1 || (bits > 4 && needed > kMostCells)) break;
        shift_ = shift;
        first_cell_ = cell(squares.front());
        cells = needed;
        steps_ = 0;
        for (std::size_t i = 0, run = 0; i < squares.size(); ++i) {
            run = i > 0 && cell(squares[i]) == cell(squares[i - 1]) ? run + 1 : 1;
            steps_ = std::max(steps_, static_cast<int>(run));
        }
    }
    first_slot_.resize(cells);
    for (std::size_t c = 0, slot = first; c < cells; ++c) {
        while (slot < slots() - 1 && cellOf(next_edge_[slot]) < static_cast<std::int64_t>(c)) ++slot;
        first_slot_[c] = static_cast<std::uint32_t>(slot);
    }
}

std::int64_t RadialBins::cellOf(double r2) const { return (std::bit_cast<std::int64_t>(r2) >> shift_) - first_cell_; }

std::size_t RadialBins::slot(double r2) const {
    const std::int64_t last = static_cast<std::int64_t>(first_slot_.size()) - 1;
    std::size_t slot = first_slot_[static_cast<std::size_t>(std::clamp<std::int64_t>(cellOf(r2), 0, last))];
    for (int i = 0; i < steps_; ++i) slot += r2 >= next_edge_[slot];
    return slot;
}

ExitTally::ExitTally(const TallyLayout& layout) : layout_(&layout) {
    for (Sums& sums : sums_) sums.flux.assign(layout.slots(), 0.0);
}

void ExitTally::add(std::span<const float> xs, std::span<const float> ys, std::span<const std::int32_t> collisions) {
    const std::size_t grid = layout_->grid;
    const double cells_per_length = grid > 0 ? static_cast<double>(grid) / (2 * layout_->grid_extent) : 0;
    for (std::size_t i = 0; i < xs.size(); ++i) {
        const double x = xs[i], y = ys[i];
        const double r2 = x * x + y * y;
        const double weight = collisions[i] <= kLongWalk ? 1.0 : longWalkWeight(collisions[i]);
        Sums& sums = sums_[collisions[i] == 1 ? single : multiple];
        sums.flux[0] += weight;
        sums.x += weight * x;
        sums.r2 += weight * r2;
        sums.flux[1 + layout_->bins.slot(r2)] += weight;
        if (grid > 0) {
            const double column = std::floor((x + layout_->grid_extent) * cells_per_length);
            const double row = std::floor((y + layout_->grid_extent) * cells_per_length);
            const double side = static_cast<double>(grid);
            if (column >= 0 && column < side && row >= 0 && row < side)
                sums.flux[layout_->gridSlot() + static_cast<std::size_t>(row * side + column)] += weight;
        }
        if (std::abs(y) < layout_->strip_half_width) {
            const std::vector<double>& edges = layout_->strip_edges;
            const auto above = std::upper_bound(edges.begin(), edges.end(), x);
            if (above != edges.begin() && above != edges.end())
                sums.flux[layout_->stripSlot() + static_cast<std::size_t>(above - edges.begin()) - 1] += weight;
        }
    }
}

std::vector<double> ExitTally::pack() const {
    std::vector<double> values;
    for (const Sums& sums : sums_) {
        values.insert(values.end(), sums.flux.begin(), sums.flux.end());
        values.push_back(sums.x);
        values.push_back(sums.r2);
    }
    return values;
}

void ExitTally::unpack(std::span<const double> values) {
    assert(values.size() == orders * (layout_->slots() + 2));
    const double* next = values.data();
    for (Sums& sums : sums_) {
        for (double& flux : sums.flux) flux = *next++;
        sums.x = *next++;
        sums.r2 = *next++;
    }
}

void BatchRatios::add(std::span<const double> numerators, double denominator) {
    assert(numerators.size() == sum_.size());
    for (std::size_t i = 0; i < numerators.size(); ++i) {
        sum_[i] += numerators[i];
        square_[i] += numerators[i] * numerators[i];
        cross_[i] += numerators[i] * denominator;
    }
    denominator_ += denominator;
    denominator_square_ += denominator * denominator;
    ++batches_;
}

Estimate BatchRatios::estimate(std::size_t i, std::uint64_t count) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (denominator_ == 0) return {0, infinity, count};
    const double ratio = sum_[i] / denominator_;
    if (batches_ < 2) return {ratio, infinity, count};
    // Sum of (n - ratio d)^2 over the batches, [Cochran1977] section 2.11.
    const double residuals = square_[i] - 2 * ratio * cross_[i] + ratio * ratio * denominator_square_;
    const double batches = static_cast<double>(batches_);
    return {ratio, std::sqrt(std::max(0.0, residuals) * batches / (batches - 1)) / denominator_, count};
}

std::vector<double> BatchRatios::pack() const {
    std::vector<double> values{static_cast<double>(batches_), denominator_, denominator_square_};
    for (const std::vector<double>* list : {&sum_, &square_, &cross_})
        values.insert(values.end(), list->begin(), list->end());
    return values;
}

void BatchRatios::unpack(std::span<const double> values) {
    assert(values.size() == packedSize());
    batches_ = static_cast<std::uint64_t>(values[0]);
    denominator_ = values[1];
    denominator_square_ = values[2];
    const double* next = values.data() + 3;
    for (std::vector<double>* list : {&sum_, &square_, &cross_})
        for (double& value : *list) value = *next++;
}

}  // namespace searchlight
