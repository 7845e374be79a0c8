// Where walks left the surface: bins, cells and moments, and their statistics over batches.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/estimate.h"

namespace searchlight {

/// Finds the radial bin of a squared radius. Each radius falls into exactly one slot.
class RadialBins {
public:
    /// edges: ascending, first >= 0, at least 2.
    explicit RadialBins(std::span<const double> edges);

    /// 0 below the first edge, i + 1 in bin i (lower edge included, upper excluded), slots() - 1 beyond the last edge.
    std::size_t slot(double r2) const;
    std::size_t slots() const { return next_edge_.size(); }

private:
    std::int64_t cellOf(double r2) const;

    std::vector<double> next_edge_;          ///< per slot: the squared edge that ends it; infinity for the last
    std::vector<std::uint32_t> first_slot_;  ///< per cell of the table: the lowest slot that meets it
    int shift_ = 0;                          ///< a cell is a run of doubles that share their bits above this one
    std::int64_t first_cell_ = 0;
    int steps_ = 0;  ///< the most edges within one cell
};

/// What is counted, in the walk's unit of length. Flux slots: [total, radial slots..., grid cells..., strip cells...].
struct TallyLayout {
    RadialBins bins;
    std::size_t grid = 0;                  ///< cells per side; 0: none
    double grid_extent = 0;                ///< half the side of the square
    std::vector<double> strip_edges = {};  ///< of the cells along x, ascending; empty: no strip
    double strip_half_width = 0;           ///< the strip is |y| < this

    std::size_t slots() const { return stripSlot() + stripCells(); }
    std::size_t gridSlot() const { return 1 + bins.slots(); }
    std::size_t stripSlot() const { return gridSlot() + grid * grid; }
    std::size_t stripCells() const { return strip_edges.empty() ? 0 : strip_edges.size() - 1; }
};

/// The exits of one chunk, split by order of scattering. Sums are double: counts stay exact, moments do not drift.
class ExitTally {
public:
    enum Order { single, multiple, orders };

    struct Sums {
        std::vector<double> flux;  ///< weight per slot of the layout
        double x = 0, r2 = 0;      ///< weight times x, weight times x^2 + y^2
    };

    explicit ExitTally(const TallyLayout& layout);

    /// Exits at (x, y) after so many collisions; the spans have the same length.
    void add(std::span<const float> x, std::span<const float> y, std::span<const std::int32_t> collisions);

    const Sums& sums(Order order) const { return sums_[order]; }
    Sums& sums(Order order) { return sums_[order]; }

    /// All sums as one list, and back.
    std::vector<double> pack() const;
    void unpack(std::span<const double> values);

private:
    const TallyLayout* layout_;
    Sums sums_[orders];
};

/// Sums over independent batches of many numerators over one denominator, without keeping the batches. The estimate is
/// that of estimateFromBatches, for a denominator that need not be a count.
class BatchRatios {
public:
    explicit BatchRatios(std::size_t size) : sum_(size), square_(size), cross_(size) {}

    void add(std::span<const double> numerators, double denominator);

    /// Ratio of the sums and its standard error; infinite with fewer than two batches or nothing in the denominator.
    Estimate estimate(std::size_t index, std::uint64_t count) const;

    /// All sums as one list, and back: the same size as this.
    std::vector<double> pack() const;
    void unpack(std::span<const double> values);
    std::size_t packedSize() const { return 3 * sum_.size() + 3; }

private:
    std::vector<double> sum_, square_, cross_;  ///< of n, n^2, n d
    double denominator_ = 0, denominator_square_ = 0;
    std::uint64_t batches_ = 0;
};

}  // namespace searchlight
