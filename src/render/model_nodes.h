// Points under one beam, gathered in the nodes of their tree for models that are evaluated as they are.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/vec.h"
#include "render/heap_tree.h"
#include "scene/point_cloud.h"

namespace searchlight {

/// What a model reads at a point of entry.
struct ModelPoint {
    Vec3 position, normal, wi;
    Rgb flux;
};

/// The points of a cloud under one beam. `wi`: one for all, or one per point; `flux` per mm^2.
std::vector<ModelPoint> modelPoints(const PointCloud& points, std::span<const Vec3f> wi, std::span<const Rgbf> flux);

/// The least distance from its receiver at which a point of that area enters, mm: half the radius of its cell, where
/// 1/r has its mean over the cell, and what is smooth on the cell hardly changes.
double leastDistance(double area_mm2);

/// Where light of the point at `position` enters for a receiver at `xo`: no nearer than `least_mm`.
Vec3 pointOfEntry(Vec3 position, Vec3 normal, double least_mm, Vec3 xo);

/// The four points mean + offset and mean - offset, with a quarter of the flux each, have the node's second moments,
/// weighted with the luminance of the flux, along its surface. Position, normal and wi move by their offsets together;
/// normal and wi are not unit. A dark node is all zero.
struct ModelNode {
    Vec3f position;
    std::array<Vec3f, 2> offsets;
    Vec3f normal;
    Rgbf flux;
    std::array<Vec3f, 2> normal_offsets;
    Vec3f wi;
    std::array<Vec3f, 2> wi_offsets;
};

/// Normals or directions differ so much that their mean and slopes say nothing: such a node does not stand for its
/// points at any distance, as that of the two sides of a thin sheet.
bool isFolded(const ModelNode& node);

/// One per node of the tree (0 is none), from one point per point of the tree.
std::vector<ModelNode> modelNodes(const HeapTree& tree, std::span<const ModelPoint> points, int threads);

}  // namespace searchlight
