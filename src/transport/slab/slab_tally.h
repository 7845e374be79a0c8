// Where walks through a slab ended: one event per walk, and what is counted of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "transport/walk/tally.h"

namespace searchlight {

/// Angles are found by their sine, which grows with them as a radius does: the edges of equal parts of 90 degrees.
std::vector<double> sineEdges(std::size_t angles);

/// What is counted of a slab, as runs of slots of one list. Rows are the slots of `radii` (below the first edge, the
/// annuli, beyond the last); angles are `angles` equal parts of 90 degrees; depths are `depths` equal parts and one
/// slot for what lies deeper.
class SlabLayout {
public:
    enum Run {
        R_scattered,    ///< 1: reflected after a collision or more
        R_single,       ///< 1: after exactly one
        R_multiple,     ///< 1
        R_unscattered,  ///< 1: came back from an interface below, without a collision
        T_scattered,    ///< 1
        T_unscattered,  ///< 1
        A_total,        ///< 1: absorbed
        A_layer,        ///< per layer
        R_r,            ///< per row, scattered
        R_r_single,     ///< per row
        R_r_multiple,   ///< per row
        T_r,            ///< per row, scattered
        R_a,            ///< per angle, scattered
        T_a,            ///< per angle, scattered
        A_z,            ///< per depth: absorbed, as expected at collisions
        F_z,            ///< per depth: fluence times volume
        R_ra,           ///< rows x angles, scattered; this and the next are empty unless maps are wanted
        T_ra,           ///< rows x angles, scattered
        A_rz,           ///< rows x depths
        F_rz,           ///< rows x depths
        R_xy,           ///< cells, scattered; this and the next are empty unless there is a grid
        T_xy,           ///< cells, scattered
        runs
    };

    struct Layer {
        double top_mm = 0;
        double absorbed = 0;    ///< expected at a collision that is counted, per unit of weight
        double fluence_mm = 0;  ///< times volume, the same
    };

    /// What may be tallied over two variables.
    struct Maps {
        bool radial = false;   ///< over the annulus, and angle or depth
        std::size_t grid = 0;  ///< cells per side of [-extent, extent]^2
        double grid_extent_mm = 0;
    };

    /// edges: of the annuli, mm, as RadialBins takes them.
    SlabLayout(std::span<const double> edges, std::size_t angles, std::size_t depths, double depth_mm, Maps maps,
               std::vector<Layer> layers);

    /// The same without maps, and with a single annulus.
    SlabLayout withoutAnnuli() const;

    std::size_t first(Run run) const { return first_[run]; }
    std::size_t size(Run run) const { return first_[run + 1] - first_[run]; }
    std::size_t slots() const { return first_[runs]; }
    std::size_t rows() const { return radii_.slots(); }
    std::size_t angles() const { return angles_; }
    std::size_t depths() const { return depths_ + 1; }
    double depthsPerMm() const { return depths_per_mm_; }
    bool maps() const { return maps_.radial; }
    std::size_t grid() const { return maps_.grid; }

    const std::vector<Layer>& layers() const { return layers_; }
    std::size_t row(double r2) const { return radii_.slot(r2); }
    std::size_t angle(double cosine) const;
    std::size_t depth(double z_mm) const;
    /// Index of the cell of the grid; none outside.
    std::optional<std::size_t> cell(double x_mm, double y_mm) const;

private:
    RadialBins radii_, sines_;
    std::size_t angles_, depths_;
    double depths_per_mm_;
    Maps maps_;
    double cells_per_mm_;
    std::vector<Layer> layers_;
    std::size_t first_[runs + 1] = {};
};

/// The ends of the walks of one chunk, and where they collided. Each walk adds 1 to exactly one of R, T and absorbed
/// (unless it was so long that it met the roulette of long_walk.h, where that holds on average).
class SlabTally {
public:
    /// Ends of walks at (x, y) mm after so many collisions; all spans have the same length.
    struct Ends {
        std::span<const float> x, y;
        std::span<const float> depth_or_cosine;  ///< mm below the top of the layer; or of the exit direction, outside
        std::span<const std::int32_t> collisions;
        std::span<const std::int32_t> layer;  ///< the one that absorbed it; or `above`, or any other for below
    };
    static constexpr std::int32_t above = -1;

    explicit SlabTally(const SlabLayout& layout) : layout_(&layout), flux_(layout.slots(), 0.0) {}

    void addAbsorbed(const Ends& ends);
    /// Collisions that are counted, also of walks that go on.
    void addCollisions(const Ends& collisions);
    void addExits(const Ends& ends);
    /// So much weight came to collisions in a bin of depth, with what is absorbed and the path for each.
    void addDepth(std::size_t depth, double weight, double absorbed, double path_mm);

    std::span<const double> flux() const { return flux_; }

    /// All sums as one list, and back.
    std::vector<double> pack() const { return flux_; }
    void unpack(std::span<const double> values) { flux_.assign(values.begin(), values.end()); }

private:
    double& at(SlabLayout::Run run, std::size_t index) { return flux_[layout_->first(run) + index]; }

    const SlabLayout* layout_;
    std::vector<double> flux_;
};

}  // namespace searchlight
