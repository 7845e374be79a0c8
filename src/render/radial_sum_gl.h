// The hierarchical sum of a radial model on a device: exitance at receivers from flux at points.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/profile.h"
#include "render/sum_gl.h"
#include "scene/point_cloud.h"

namespace searchlight {

/// Points and receivers stand in two trees. Level by level of the receivers' tree, every group takes over its parent's
/// expansion (of second order, as are the moments of the points' nodes) and adds to it those nodes that are far enough
/// for their size and its own; what is left is handed down, at last to single receivers and single points.
class RadialSumGl final : public SumGl {
public:
    /// Compiles the passes. The context outlives the sum.
    explicit RadialSumGl(gl::Context& context);

    /// At least one point, and an area per point; all dark. Throws a device Error where they do not fit the device.
    void setPoints(const PointCloud& points, int threads);
    void setTransmitted(std::span<const Rgbf> transmitted, int threads);  ///< per mm^2, in the order of the cloud
    void setProfile(const Profile& profile);                              ///< requires points: their areas matter

    Work run(const Chains& chains, double error) override;
    std::vector<Rgb> direct(std::span<const std::uint32_t> places) override;
    std::vector<Rgbf> exitance(std::size_t first, std::size_t last) const override;

private:
    // One level of groups of the slice that runs.
    struct Level {
        gl::Buffer expansions, lists;
        explicit Level(gl::Context& context) : expansions(context, 4), lists(context, 4) {}
    };

    void uploadPoints(std::span<const Rgb> flux, int threads);
    std::size_t receiversPerSlice() const override { return 4096; }
    void setCommon(gl::Program& program, const Chains& chains, int level, double error);
    void runGroups(const Chains& chains, std::size_t index, double error);
    void runReceivers(const Chains& chains, double error);
    void reserveLists(const Chains& chains);

    gl::Program groups_, receivers_pass_, direct_;
    TableGl radial_, spheres_, moments_, points_;
    gl::Buffer leaf_begins_, exitance_, counters_, sums_, chosen_;
    Level even_, odd_;

    HeapTree tree_;  // of the points
    std::vector<Vec3f> positions_;
    std::vector<float> areas_;
    double area_mm2_ = 0;
    int table_entries_ = 0, table_first_bits_ = 0;
    double table_offset_ = 1;

    int list_size_ = 256;
};

}  // namespace searchlight
