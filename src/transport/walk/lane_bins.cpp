#include "transport/walk/lane_bins.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>

namespace searchlight {

LaneBins laneBins(std::span<const double> edges) {
    LaneBins bins;
    for (const double edge : edges) bins.next_edge.push_back(static_cast<float>(edge * edge));
    bins.next_edge.push_back(std::numeric_limits<float>::infinity());
    const std::size_t first = bins.next_edge[0] > 0 ? 0 : 1;
    const std::span<const float> squares(bins.next_edge.data() + first, edges.size() - first);
    // As in RadialBins: the upper bits of a float are a logarithmic index, refined until no cell holds two edges or the
    // table grows out of the first cache.
    constexpr std::size_t most_cells = 4096;
    const auto cell = [](float r2, int shift) { return std::bit_cast<std::int32_t>(r2) >> shift; };
    std::size_t cells = 0;
    for (int bits = 3; bits <= 14; ++bits) {
        const int shift = 23 - bits;
        const auto needed = static_cast<std::size_t>(cell(squares.back(), shift) - cell(squares.front(), shift)) + 1;
        if (bins.steps == 1 || (bits > 3 && needed > most_cells)) break;
        bins.shift = shift;
        bins.first_cell = cell(squares.front(), shift);
        cells = needed;
        bins.steps = 0;
        for (std::size_t i = 0, run = 0; i < squares.size(); ++i) {
            run = i > 0 && cell(squares[i], shift) == cell(squares[i - 1], shift) ? run + 1 : 1;
            bins.steps = std::max(bins.steps, static_cast<std::int32_t>(run));
        }
    }
    std::int32_t slot = static_cast<std::int32_t>(first);
    const auto last = static_cast<std::int32_t>(edges.size());
    for (std::size_t c = 0; c < cells; ++c) {
        while (slot < last && cell(bins.next_edge[static_cast<std::size_t>(slot)], bins.shift) - bins.first_cell <
                                  static_cast<std::int32_t>(c))
            ++slot;
        bins.first_slot.push_back(slot);
    }
    const double last_edge = edges.back(), count = static_cast<double>(edges.size() - 1);
    bool alike = count < 0x1p20;
    for (std::size_t i = 0; i < edges.size(); ++i)
        alike &= std::abs(edges[i] - last_edge * static_cast<double>(i) / count) <= 1e-7 * edges[i];
    if (alike) bins.per_length = static_cast<float>(count / last_edge);
    return bins;
}

}  // namespace searchlight
