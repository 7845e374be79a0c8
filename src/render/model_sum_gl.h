// The hierarchical sum of any model on a device: its own GLSL, evaluated at nodes and points.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/param.h"
#include "light/irradiance.h"
#include "model/gl_program.h"
#include "model/model.h"
#include "model/profile.h"
#include "render/model_nodes_gl.h"
#include "render/sum_gl.h"
#include "render/view.h"
#include "scene/point_cloud.h"

namespace searchlight {

/// Per group of receivers a list of nodes and of leaves; a node is evaluated at four points that have its moments, so
/// that the error is of third order in its size, as with the expansions of a radial model.
class ModelSumGl final : public SumGl {
public:
    /// The context outlives the sum.
    explicit ModelSumGl(gl::Context& context);

    /// Compiles the model, if it is another one, and sets its medium; a sum has a program for each part. `mean`: its
    /// azimuthal mean at normal incidence, by which nodes are chosen. Requires points. Throws an input Error with the
    /// model's file, line and column, and a usage Error for a sum with a measured part, of which there is no GLSL.
    void setModel(const Model& model, const Medium& medium, const ParamValues& parameters, const Profile& mean);

    /// At least one point, with normals and areas; all dark.
    void setPoints(const PointCloud& points, int threads);

    /// Light by beams, or along the normals for a model that does not read wi.
    void setLight(const Irradiance& irradiance, bool reads_wi, int threads);

    void setReceivers(const VisibleSurface& visible, int threads);  ///< at least one

    Pilot pilot() const override { return {16, 2, 4}; }
    Work run(const Chains& chains, double error) override;
    std::vector<Rgb> direct(std::span<const std::uint32_t> places) override;
    std::vector<Rgbf> exitance(std::size_t first, std::size_t last) const override;

private:
    struct Beam {
        TableGl nodes, points;
        explicit Beam(gl::Context& context) : nodes(context), points(context) {}
    };

    // A model, or one of those that are added.
    struct Part {
        BssrdfFile file;
        std::optional<gl::Program> init;
        gl::Program evaluate;
        gl::Buffer state;
        Part(gl::Context& context, const BssrdfFile& file, const LoopBudget& budget);
    };

    bool knows(std::span<const Model> parts) const;
    std::size_t receiversPerSlice() const override { return 512; }
    void addBeam(std::span<const ModelPoint> points, int threads);
    unsigned makeLists(const Chains& chains, double error, Work& work);  // returns the longest
    void dispatch(Part& part, std::size_t invocations, const gl::Buffer& receivers, const gl::Buffer& values);
    void checkLoops(const Part& part, const gl::Buffer& values);

    gl::Program lists_pass_;
    TableGl radial_, spheres_;
    std::vector<std::array<float, 4>> sphere_texels_;  // of the points' tree; a radius below 0: folded in some beam
    gl::Buffer leaf_begins_, counters_, lists_, values_, direct_values_, chosen_;

    LoopBudget budget_;
    std::vector<std::unique_ptr<Part>> parts_;

    PointCloud points_;
    HeapTree tree_;
    double area_mm2_ = 0;
    int table_entries_ = 0, table_first_bits_ = 0;
    double table_offset_ = 1;
    std::vector<std::unique_ptr<Beam>> beams_;
    std::vector<std::array<float, 4>> receivers_and_normals_;  // two a place of the tree
    gl::Buffer receiver_data_;
    Vec3 eye_;
    int list_size_ = 512;
};

}  // namespace searchlight
