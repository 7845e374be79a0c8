// The hierarchical sum of a model that is not radial, on the CPU: the model itself, evaluated at nodes and points.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "light/irradiance.h"
#include "model/evaluator.h"
#include "render/heap_tree.h"
#include "render/model_nodes.h"
#include "render/radial_table_gl.h"
#include "render/view.h"
#include "scene/point_cloud.h"

namespace searchlight {

/// Receivers stand in small groups, each with its list of nodes and leaves; a node is evaluated at the four points of a
/// ModelNode, so that the error is of third order in its size.
class DirectionalSum {
public:
    explicit DirectionalSum(int threads) : threads_(threads) {}  ///< 0: all

    /// At least one point, with normals and areas; all dark.
    void setPoints(const PointCloud& points);

    /// Takes the medium, and makes an evaluator per thread where the model has native ones. Others, like `given`, which
    /// is set to the medium and stays alive, are one. Requires points. The model's azimuthal mean decides which nodes
    /// are opened.
    void setModel(const Model& model, const Medium& medium, const ParamValues& parameters, Evaluator& given);

    /// Light by beams, or along the normals for a model that does not read wi. Requires points.
    void setLight(const Irradiance& irradiance, bool reads_wi);

    void setReceivers(const VisibleSurface& visible);  ///< at least one

    /// Receivers in the order of their tree: place k is receiver order()[k]. Neighbours in it are neighbours in space.
    std::span<const std::uint32_t> order() const { return receiver_tree_.order; }
    std::size_t groups() const { return std::size_t{1} << receiver_tree_.depth; }
    /// The places of group k begin here; those of the last end at k = groups().
    std::size_t firstOf(std::size_t k) const { return receiver_tree_.first(receiver_tree_.depth, k); }

    /// Points times beams: most evaluations that a receiver takes.
    std::size_t terms() const { return std::max<std::size_t>(1, points_.positions.size() * beams_.size()); }

    struct Result {
        std::vector<Rgb> exitance;
        std::uint64_t evaluations = 0;
    };
    /// Sums for places [first, last) of group `group`.
    struct Part {
        std::size_t group, first, last;
    };
    /// Exitance at the places of the parts, part after part. The error grows with `opening`, by which a term may be
    /// wrong relative to what stands there; with 0 every point is evaluated. Does not depend on the number of threads.
    Result sum(std::span<const Part> parts, double opening);

    std::string backend() const { return evaluators_.front()->backend(); }

private:
    class Worker;

    struct Beam {
        std::vector<ModelNode> nodes;
        std::vector<ModelPoint> points;  // in the tree's order
    };
    // What a group sums: nodes, and leaves as complements of their numbers.
    std::vector<int> listOf(std::size_t group, double opening) const;
    void addBeam(std::vector<ModelPoint> points);

    int threads_;
    PointCloud points_;
    HeapTree tree_;
    std::vector<double> least_mm_;  // in the tree's order
    double area_mm2_ = 0;
    std::vector<Beam> beams_;
    std::vector<std::uint8_t> folded_;  // nodes whose normals or directions differ too much to have a mean
    RadialTableGl table_;
    std::array<bool, Rgb::channels> scatters_{};
    std::vector<std::unique_ptr<Evaluator>> own_;
    std::vector<Evaluator*> evaluators_;
    HeapTree receiver_tree_;
    std::vector<Vec3> xo_, no_, wo_;  // by place
};

}  // namespace searchlight
