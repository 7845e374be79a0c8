// The sum at the heart of a radial model's picture: exitance at receivers from flux at points, by a dual tree.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/vec.h"
#include "model/profile.h"
#include "scene/point_cloud.h"

namespace searchlight {

/// R_d(r) and its first two derivatives for three channels, indexed by the float bits of r^2 + c^2.
class RadialTable {
public:
    /// `profile` per transmitted flux; `cell_area_mm2`: the area that a point stands for, below which R_d is averaged.
    RadialTable(const Profile& profile, double cell_area_mm2);
    ~RadialTable();
    RadialTable(RadialTable&&) noexcept;
    RadialTable& operator=(RadialTable&&) noexcept;

    struct Impl;
    const Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

/// Points with their area, in a tree that depends on positions alone; the light's moments are refitted into it.
class PointTree {
public:
    /// Copies positions and areas. Requires at least one point, finite.
    explicit PointTree(const PointCloud& points, int threads = 0);
    ~PointTree();
    PointTree(PointTree&&) noexcept;
    PointTree& operator=(PointTree&&) noexcept;

    /// Flux per mm^2 at each point, in the order of the cloud.
    void setTransmitted(std::span<const Rgbf> transmitted);

    std::size_t size() const;

    struct Impl;
    const Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

struct SumOptions {
    double error = 0.005;  ///< relative RMSE over the receivers that the caller asks for, against the full sum
    int threads = 0;
};

struct SumStatistics {
    std::uint64_t interactions = 0;  ///< point to point
    std::uint64_t expansions = 0;    ///< node to node and node to receiver
    double error_bound = 0;          ///< what is known of the relative RMSE: at most SumOptions::error
    double largest_error_bound = 0;  ///< of a single receiver, relative to the mean exitance
    double tree_ms = 0, sum_ms = 0;
};

/// Exitance per receiver, R_d summed over the points: sum of R_d(|xo - xi|) flux_i area_i. Receivers need no order;
/// those that stand near one another in the list should stand near one another in space (pixels of a tile).
std::vector<Rgbf> sumExitance(const PointTree& points, const RadialTable& table, std::span<const Vec3f> receivers,
                              const SumOptions& options, SumStatistics* statistics = nullptr);

/// The same in double and without approximation but the table's: what the error is measured against.
std::vector<Rgb> sumExitanceDirectly(const PointCloud& points, std::span<const Rgbf> transmitted,
                                     const Profile& profile, std::span<const Vec3f> receivers, int threads = 0);

}  // namespace searchlight
