// The sum at the heart of a radial model's picture: exitance at receivers from flux at points, by a dual tree.
// docs/hierarchical.md says how, and what is promised.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/observer.h"
#include "base/vec.h"
#include "model/profile.h"
#include "scene/point_cloud.h"

namespace searchlight {

/// R_d(r) and its derivatives for three channels, indexed by the float bits of r^2 + c^2.
class RadialTable {
public:
    /// `profile` per transmitted flux. `cell_area_mm2` > 0: the area that a point stands for; R_d is averaged over a
    /// disc of that area, so a receiver close to a point sees no speck. The integral over the plane stays.
    RadialTable(const Profile& profile, double cell_area_mm2);
    ~RadialTable();
    RadialTable(RadialTable&&) noexcept;
    RadialTable& operator=(RadialTable&&) noexcept;

    /// R_d as the sum sees it, 1/mm^2.
    Rgb operator()(double r_mm) const;

    struct Impl;
    const Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

/// Points with their area, in a tree that depends on positions alone; the light's moments are refitted into it.
class PointTree {
public:
    /// Copies positions and areas. Requires at least one point, finite, and an area per point.
    explicit PointTree(const PointCloud& points, int threads = 0);
    ~PointTree();
    PointTree(PointTree&&) noexcept;
    PointTree& operator=(PointTree&&) noexcept;

    /// Flux per mm^2 at each point, in the order of the cloud. Before the first call all is dark.
    void setTransmitted(std::span<const Rgbf> transmitted, int threads = 0);

    std::size_t size() const;
    double meanArea() const;  ///< mm^2 per point: the cell area of a RadialTable

    struct Impl;
    const Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

/// Receivers in a tree: what stays while the camera does not move.
class ReceiverTree {
public:
    /// Copies positions, which are finite. They need no order, but those that stand near one another in space should
    /// stand near one another in the list (pixels of a tile): otherwise they are sorted first, which costs more than
    /// the tree.
    explicit ReceiverTree(std::span<const Vec3f> receivers, int threads = 0);
    ~ReceiverTree();
    ReceiverTree(ReceiverTree&&) noexcept;
    ReceiverTree& operator=(ReceiverTree&&) noexcept;

    std::size_t size() const;

    struct Impl;
    const Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

/// How fine the trees are opened, found by a pilot on some of the receivers. Kept by the caller from one sum to the
/// next, it saves the pilot: where points, light, table, receivers and error are the same it is used as it is;
/// elsewhere the sum is taken with it, judged on a sample, and taken again where the error was not kept.
struct SumCalibration {
    std::uint64_t key = 0;   ///< of what it was found for; 0: nothing yet
    Rgb opening;             ///< the parameter of the acceptance test, per channel
    Rgb next;                ///< what to begin with when something has changed; 0: what a pilot finds
    double error_bound = 0;  ///< as in SumStatistics
    double largest_error_bound = 0;
};

/// What a sum needs while it is taken, of use again for the next: memory and rules of opening.
class SumMemory {
public:
    SumMemory();
    ~SumMemory();
    SumMemory(SumMemory&&) noexcept;
    SumMemory& operator=(SumMemory&&) noexcept;

    struct Impl;
    Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

struct SumOptions {
    /// Relative RMSE over the receivers, against the full sum: the root of the mean squared error over that of the mean
    /// squared exitance, in every channel. From 1e-4 to 0.5; others are moved there.
    double error = 0.005;
    bool one_by_one = false;  ///< every receiver takes every point: time is their product, error is rounding
    int threads = 0;          ///< 0: all
    SumCalibration* calibration = nullptr;  ///< read and written where given
    SumMemory* memory = nullptr;            ///< used where given, by one sum at a time
    Observer* observer = nullptr;           ///< asked some hundred times a sum whether to stop: interruptedError()
};

struct SumStatistics {
    std::uint64_t interactions = 0;  ///< point to receiver
    std::uint64_t expansions = 0;    ///< node to node, and node to receiver
    double error_bound = 0;  ///< upper confidence of the relative RMSE, worst channel; at most SumOptions::error
    /// Of the largest error of a receiver, relative to the RMS exitance: extrapolated from a sample, so an estimate.
    double largest_error_bound = 0;
    double tree_ms = 0, pilot_ms = 0, sum_ms = 0;  ///< pilot: or what judged the sum afterwards
    int taken = 0;            ///< how often the sum was taken: once, unless what was kept did not keep the error
    bool calibrated = false;  ///< false: the calibration that was given was used as it is
};

/// Exitance per receiver, in their order: the sum of R_d(|xo - xi|) flux_i area_i over the points. The result does not
/// depend on the number of threads.
std::vector<Rgbf> sumExitance(const PointTree& points, const RadialTable& table, const ReceiverTree& receivers,
                              const SumOptions& options, SumStatistics* statistics = nullptr);

/// The same into memory that is used again.
void sumExitance(const PointTree& points, const RadialTable& table, const ReceiverTree& receivers,
                 const SumOptions& options, std::vector<Rgbf>& exitance, SumStatistics* statistics = nullptr);

/// The same for receivers that are used once.
std::vector<Rgbf> sumExitance(const PointTree& points, const RadialTable& table, std::span<const Vec3f> receivers,
                              const SumOptions& options, SumStatistics* statistics = nullptr);

/// The same in double, point by point, with R_d averaged over the cloud's mean area: what the error is measured
/// against.
std::vector<Rgb> sumExitanceDirectly(const PointCloud& points, std::span<const Rgbf> transmitted,
                                     const Profile& profile, std::span<const Vec3f> receivers, int threads = 0);

}  // namespace searchlight
