#include "transport/slab/slab_tally.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "transport/walk/long_walk.h"

namespace searchlight {

namespace {

double weightOf(std::int32_t collisions) { return collisions <= kLongWalk ? 1.0 : longWalkWeight(collisions); }

}  // namespace

std::vector<double> sineEdges(std::size_t angles) {
    std::vector<double> edges;
    for (std::size_t i = 0; i <= angles; ++i)
        edges.push_back(std::sin(0.5 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(angles)));
    return edges;
}

SlabLayout::SlabLayout(std::span<const double> edges, std::size_t angles, std::size_t depths, double depth_mm,
                       Maps maps, std::vector<Layer> layers)
    : radii_(edges),
      sines_(sineEdges(angles)),
      angles_(angles),
      depths_(depths),
      depths_per_mm_(static_cast<double>(depths) / depth_mm),
      maps_(maps),
      cells_per_mm_(maps.grid > 0 ? 0.5 * static_cast<double>(maps.grid) / maps.grid_extent_mm : 0),
      layers_(std::move(layers)) {
    std::size_t sizes[runs];
    std::fill(std::begin(sizes), std::end(sizes), std::size_t{1});
    sizes[A_layer] = layers_.size();
    for (const Run run : {R_r, R_r_single, R_r_multiple, T_r}) sizes[run] = rows();
    for (const Run run : {R_a, T_a}) sizes[run] = angles_;
    for (const Run run : {A_z, F_z}) sizes[run] = this->depths();
    for (const Run run : {R_ra, T_ra}) sizes[run] = maps.radial ? rows() * angles_ : 0;
    for (const Run run : {A_rz, F_rz}) sizes[run] = maps.radial ? rows() * this->depths() : 0;
    for (const Run run : {R_xy, T_xy}) sizes[run] = maps.grid * maps.grid;
    for (int run = 0; run < runs; ++run) first_[run + 1] = first_[run] + sizes[run];
}

SlabLayout SlabLayout::withoutAnnuli() const {
    constexpr double edges[] = {0, 1};
    return {edges, angles_, depths_, static_cast<double>(depths_) / depths_per_mm_, {}, layers_};
}

std::size_t SlabLayout::angle(double cosine) const {
    return std::clamp<std::size_t>(sines_.slot(1 - cosine * cosine), 1, angles_) - 1;
}

std::size_t SlabLayout::depth(double z_mm) const {
    const double cell = z_mm * depths_per_mm_;
    return cell < static_cast<double>(depths_) ? static_cast<std::size_t>(cell) : depths_;
}

std::optional<std::size_t> SlabLayout::cell(double x_mm, double y_mm) const {
    const double side = static_cast<double>(maps_.grid);
    const double column = (x_mm + maps_.grid_extent_mm) * cells_per_mm_;
    const double row = (y_mm + maps_.grid_extent_mm) * cells_per_mm_;
    if (!(column >= 0 && column < side && row >= 0 && row < side)) return {};
    return static_cast<std::size_t>(row) * maps_.grid + static_cast<std::size_t>(column);
}

void SlabTally::addAbsorbed(const Ends& ends) {
    for (std::size_t i = 0; i < ends.layer.size(); ++i) {
        const double weight = weightOf(ends.collisions[i]);
        at(SlabLayout::A_total, 0) += weight;
        at(SlabLayout::A_layer, static_cast<std::size_t>(ends.layer[i])) += weight;
    }
}

void SlabTally::addCollisions(const Ends& collisions) {
    for (std::size_t i = 0; i < collisions.x.size(); ++i) {
        const double x = collisions.x[i], y = collisions.y[i];
        const SlabLayout::Layer& layer = layout_->layers()[static_cast<std::size_t>(collisions.layer[i])];
        const double weight = weightOf(collisions.collisions[i] - 1);  // that with which the walk came here
        const double absorbed = weight * layer.absorbed, fluence = weight * layer.fluence_mm;
        const std::size_t depth = layout_->depth(layer.top_mm + static_cast<double>(collisions.depth_or_cosine[i]));
        at(SlabLayout::A_z, depth) += absorbed;
        at(SlabLayout::F_z, depth) += fluence;
        if (!layout_->maps()) continue;
        const std::size_t cell = layout_->row(x * x + y * y) * layout_->depths() + depth;
        at(SlabLayout::A_rz, cell) += absorbed;
        at(SlabLayout::F_rz, cell) += fluence;
    }
}

void SlabTally::addDepth(std::size_t depth, double weight, double absorbed, double path_mm) {
    at(SlabLayout::A_z, depth) += weight * absorbed;
    at(SlabLayout::F_z, depth) += weight * path_mm;
}

void SlabTally::addExits(const Ends& ends) {
    for (std::size_t i = 0; i < ends.x.size(); ++i) {
        const double x = ends.x[i], y = ends.y[i];
        const bool reflected = ends.layer[i] == above;
        const double weight = weightOf(ends.collisions[i]);
        if (ends.collisions[i] == 0) {
            at(reflected ? SlabLayout::R_unscattered : SlabLayout::T_unscattered, 0) += weight;
            continue;
        }
        const std::size_t row = layout_->row(x * x + y * y), angle = layout_->angle(ends.depth_or_cosine[i]);
        if (reflected) {
            const bool single = ends.collisions[i] == 1;
            at(SlabLayout::R_scattered, 0) += weight;
            at(single ? SlabLayout::R_single : SlabLayout::R_multiple, 0) += weight;
            at(single ? SlabLayout::R_r_single : SlabLayout::R_r_multiple, row) += weight;
        } else {
            at(SlabLayout::T_scattered, 0) += weight;
        }
        at(reflected ? SlabLayout::R_r : SlabLayout::T_r, row) += weight;
        at(reflected ? SlabLayout::R_a : SlabLayout::T_a, angle) += weight;
        if (layout_->maps())
            at(reflected ? SlabLayout::R_ra : SlabLayout::T_ra, row * layout_->angles() + angle) += weight;
        if (layout_->grid() == 0) continue;
        if (const std::optional<std::size_t> cell = layout_->cell(x, y))
            at(reflected ? SlabLayout::R_xy : SlabLayout::T_xy, *cell) += weight;
    }
}

}  // namespace searchlight
