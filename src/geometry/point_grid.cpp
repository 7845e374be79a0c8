#include "geometry/point_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace searchlight {

namespace {

int cellInBlock(std::int32_t x, std::int32_t y, std::int32_t z) { return (x & 3) | (y & 3) << 2 | (z & 3) << 4; }

std::size_t hashOf(std::int32_t x, std::int32_t y, std::int32_t z) {
    std::uint64_t hash = static_cast<std::uint32_t>(x) * 0x9E3779B97F4A7C15u;
    hash = (hash ^ static_cast<std::uint32_t>(y)) * 0xBF58476D1CE4E5B9u;
    hash ^= hash >> 31;
    hash = (hash ^ static_cast<std::uint32_t>(z)) * 0x94D049BB133111EBu;
    return hash ^ (hash >> 29);
}

}  // namespace

PointGrid::PointGrid(std::span<const Vec3f> positions, float cell) : per_cell_(1.0 / cell) {
    if (positions.empty()) return;
    low_ = positions[0];
    for (const Vec3f p : positions) low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
    table_.resize(1024);
    std::vector<std::uint32_t> block_of(positions.size());
    std::vector<std::uint8_t> cell_of(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const std::int32_t x = coordinate(positions[i].x, low_.x), y = coordinate(positions[i].y, low_.y),
                           z = coordinate(positions[i].z, low_.z);
        block_of[i] = findOrAdd(x >> 2, y >> 2, z >> 2);
        cell_of[i] = static_cast<std::uint8_t>(cellInBlock(x, y, z));
        ++blocks_[block_of[i]].starts[cell_of[i] + 1];
    }
    // starts[c + 1] holds the count of cell c; it becomes where the cell ends, and counts down to where it starts.
    std::uint32_t sum = 0;
    for (Block& block : blocks_)
        for (int c = 0; c < 64; ++c) block.starts[c + 1] = sum += block.starts[c + 1];
    entries_.resize(positions.size());
    for (std::size_t i = positions.size(); i-- > 0;)
        entries_[--blocks_[block_of[i]].starts[cell_of[i] + 1]] = {positions[i], static_cast<std::uint32_t>(i)};
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
        std::uint32_t* starts = blocks_[b].starts;
        std::copy(starts + 1, starts + 65, starts);
        starts[64] = sum;
        if (b > 0) blocks_[b - 1].starts[64] = starts[0];
    }
}

std::int32_t PointGrid::coordinate(float x, float low) const {
    const double at = std::floor((static_cast<double>(x) - low) * per_cell_);
    return static_cast<std::int32_t>(std::clamp(at, -1e9, 1e9));
}

const PointGrid::Block* PointGrid::find(std::int32_t x, std::int32_t y, std::int32_t z) const {
    if (table_.empty()) return nullptr;
    for (std::size_t slot = hashOf(x, y, z) & (table_.size() - 1); table_[slot] != 0;
         slot = (slot + 1) & (table_.size() - 1)) {
        const Block& block = blocks_[table_[slot] - 1];
        if (block.x == x && block.y == y && block.z == z) return &block;
    }
    return nullptr;
}

std::uint32_t PointGrid::findOrAdd(std::int32_t x, std::int32_t y, std::int32_t z) {
    if (const Block* found = find(x, y, z)) return static_cast<std::uint32_t>(found - blocks_.data());
    blocks_.push_back({.x = x, .y = y, .z = z});
    std::size_t first = blocks_.size() - 1;
    if (2 * blocks_.size() > table_.size()) {
        table_.assign(4 * table_.size(), 0);
        first = 0;
    }
    for (std::size_t b = first; b < blocks_.size(); ++b) {
        std::size_t slot = hashOf(blocks_[b].x, blocks_[b].y, blocks_[b].z) & (table_.size() - 1);
        while (table_[slot] != 0) slot = (slot + 1) & (table_.size() - 1);
        table_[slot] = static_cast<std::uint32_t>(b + 1);
    }
    return static_cast<std::uint32_t>(blocks_.size() - 1);
}

void PointGrid::cellsOf(std::size_t block, std::vector<Cell>& cells) const {
    cells.clear();
    const Block& b = blocks_[block];
    for (int c = 0; c < 64; ++c)
        if (const std::span<const Entry> here = cellAt(b, c); !here.empty())
            cells.push_back({4 * b.x + (c & 3), 4 * b.y + (c >> 2 & 3), 4 * b.z + (c >> 4), here});
}

void PointGrid::gatherCells(const std::int32_t (&first)[3], const std::int32_t (&last)[3],
                            std::vector<Entry>& found) const {
    for (std::int32_t bz = first[2] >> 2; bz <= last[2] >> 2; ++bz)
        for (std::int32_t by = first[1] >> 2; by <= last[1] >> 2; ++by)
            for (std::int32_t bx = first[0] >> 2; bx <= last[0] >> 2; ++bx) {
                const Block* block = find(bx, by, bz);
                if (!block) continue;
                const std::int32_t x0 = std::max(first[0], 4 * bx), x1 = std::min(last[0], 4 * bx + 3);
                for (std::int32_t z = std::max(first[2], 4 * bz); z <= std::min(last[2], 4 * bz + 3); ++z)
                    for (std::int32_t y = std::max(first[1], 4 * by); y <= std::min(last[1], 4 * by + 3); ++y) {
                        // A row of cells is one run of entries.
                        const Entry* begin = entries_.data() + block->starts[cellInBlock(x0, y, z)];
                        const Entry* end = entries_.data() + block->starts[cellInBlock(x1, y, z) + 1];
                        found.insert(found.end(), begin, end);
                    }
            }
}

void PointGrid::gather(Vec3f low, Vec3f high, std::vector<Entry>& found) const {
    gatherCells({coordinate(low.x, low_.x), coordinate(low.y, low_.y), coordinate(low.z, low_.z)},
                {coordinate(high.x, low_.x), coordinate(high.y, low_.y), coordinate(high.z, low_.z)}, found);
}

void PointGrid::gatherAround(const Cell& cell, std::vector<Entry>& found) const {
    gatherCells({cell.x - 1, cell.y - 1, cell.z - 1}, {cell.x + 1, cell.y + 1, cell.z + 1}, found);
}

}  // namespace searchlight
