// Points by the cell that they lie in: neighbours within a fixed distance, many at a time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace searchlight {

/// Sparse: blocks of 4 x 4 x 4 cells exist where there are points. Immutable; queries may run on many threads.
class PointGrid {
public:
    struct Entry {
        Vec3f position;
        std::uint32_t index = 0;  ///< into the positions given
    };

    /// Requires cell > 0 and finite positions.
    PointGrid(std::span<const Vec3f> positions, float cell);

    /// All points; those of a cell stand together, in ascending order of their index.
    std::span<const Entry> entries() const { return entries_; }

    std::size_t blocks() const { return blocks_.size(); }
    struct Cell {
        std::int32_t x = 0, y = 0, z = 0;
        std::span<const Entry> entries;
    };
    /// The occupied cells of a block.
    void cellsOf(std::size_t block, std::vector<Cell>& cells) const;

    /// Appends the points of all cells that the box from `low` to `high` touches.
    void gather(Vec3f low, Vec3f high, std::vector<Entry>& found) const;
    /// Appends the points of the 27 cells around and with a cell: all within one cell size of any place in it.
    void gatherAround(const Cell& cell, std::vector<Entry>& found) const;

private:
    struct Block {
        std::int32_t x = 0, y = 0, z = 0;
        std::uint32_t starts[65] = {};
    };
    std::int32_t coordinate(float x, float low) const;
    const Block* find(std::int32_t x, std::int32_t y, std::int32_t z) const;
    std::uint32_t findOrAdd(std::int32_t x, std::int32_t y, std::int32_t z);
    std::span<const Entry> cellAt(const Block& block, int cell) const {
        return {entries_.data() + block.starts[cell], block.starts[cell + 1] - block.starts[cell]};
    }
    void gatherCells(const std::int32_t (&first)[3], const std::int32_t (&last)[3], std::vector<Entry>& found) const;

    Vec3f low_;
    double per_cell_ = 1;
    std::vector<Block> blocks_;
    std::vector<std::uint32_t> table_;  // of block numbers plus one, by hash
    std::vector<Entry> entries_;
};

}  // namespace searchlight
