// Which beams may pass through a place: lists of a grid over a mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "scene/mesh.h"

namespace searchlight {

/// Aligned with the axes.
struct Box {
    Vec3 low, high;

    void hold(Vec3 p);
    /// What both hold; where that is nothing, something as small.
    Box both(const Box& other) const;
};

/// All that is reached from a box in directions within another, up to a distance.
struct Sweep {
    Box base, directions;
    double reach = 0;
};

/// A grid over a mesh, with cells about as large as its facets.
class BeamCells {
public:
    /// At most so many cells along the mesh.
    explicit BeamCells(const Mesh& mesh, double most = 128);

    std::size_t count() const;
    std::size_t at(Vec3f position) const;
    Box boxOf(std::size_t cell) const;
    /// At least the cells that a sweep of unit directions from within the mesh meets, each at least once, with the
    /// least distance from the sweep's base at which it may.
    void forEach(const Sweep& sweep, const std::function<void(std::size_t, double)>& visit) const;
    /// The distance from its base up to which the sweep meets no cell that is blocked; infinity where it meets none.
    double clear(const Sweep& sweep, const std::function<bool(std::size_t)>& blocked) const;

private:
    template <class Visit>
    void slices(const Sweep& sweep, const Visit& visit) const;

    Vec3 low_;
    double cell_mm_ = 1, diagonal_mm_ = 0;
    std::int32_t nx_ = 1, ny_ = 1, nz_ = 1;
};

/// For each cell the things that may reach it, ascending.
class CellLists {
public:
    CellLists() = default;
    /// Of things first to end - 1. Nothing when that takes more than so many references. `nearest`, one number for each
    /// cell, sinks to the distance of what comes to a cell from nearest.
    static std::optional<CellLists> of(const BeamCells& cells, std::uint32_t first, std::uint32_t end,
                                       const std::function<Sweep(std::uint32_t)>& sweep, double most,
                                       std::span<float> nearest = {});

    std::size_t size() const { return list_.size(); }
    std::span<const std::uint32_t> at(std::size_t cell) const {
        return {list_.data() + first_[cell], list_.data() + first_[cell + 1]};
    }

private:
    std::vector<std::uint32_t> first_, list_;
};

}  // namespace searchlight
