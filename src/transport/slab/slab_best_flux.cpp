#include "transport/slab/slab_best_flux.h"

#include <algorithm>
#include <numeric>

namespace searchlight {

namespace {

double sumOf(const std::vector<double>& list) { return std::accumulate(list.begin(), list.end(), 0.0); }

// Per layer.
std::vector<double> collidedIn(const SlabBestPlan& plan, const SlabBestSums& found) {
    std::vector<double> sums(plan.walk.layers.size());
    for (std::size_t i = 0; i < plan.depths.slots.size(); ++i) sums[plan.depths.slots[i].layer] += found.collided[i];
    return sums;
}

}  // namespace

void addKnown(const SlabBestPlan& plan, double walks, SlabBestSums& found) {
    const auto add = [&](std::vector<double>& list, const std::vector<double>& known) {
        for (std::size_t i = 0; i < list.size(); ++i) list[i] += walks * known[i];
    };
    if (plan.single) {
        add(found.single, plan.single->reflected);
        add(found.transmitted, plan.single->transmitted);
        add(found.reflected_a, plan.single->reflected_a);
        add(found.transmitted_a, plan.single->transmitted_a);
    }
    const SlabLayout& layout = plan.layout;
    for (std::size_t i = 0; i < plan.depths.slots.size(); ++i) {
        const auto [index, depth] = plan.depths.slots[i];
        const SlabWalk::Layer& layer = plan.walk.layers[index];
        const double top = layout.layers()[index].top_mm, bottom = top + layer.thickness_mm;
        const double begin = std::max(top, static_cast<double>(depth) / layout.depthsPerMm());
        const bool beyond = depth + 1 == layout.depths();
        const double end = beyond ? bottom : std::min(bottom, static_cast<double>(depth + 1) / layout.depthsPerMm());
        if (end > begin)
            found.collided[i] += walks * plan.control.unscattered.collides(layer, index, begin - top, end - top);
    }
}

SlabShape shapeOf(const SlabBestPlan& plan, const std::vector<SlabBestSums>& all) {
    const auto parts = [&](std::vector<double> SlabBestSums::*list) {
        std::vector<double> sum((all[0].*list).size());
        for (const SlabBestSums& found : all)
            for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += (found.*list)[i];
        const double total = sumOf(sum);
        for (double& part : sum) part = total > 0 ? part / total : 0;
        return sum;
    };
    SlabShape shape{parts(&SlabBestSums::reflected_a), parts(&SlabBestSums::transmitted_a),
                    parts(&SlabBestSums::collided)};
    SlabBestSums mean;
    mean.collided = shape.collided;
    const std::vector<double> layers = collidedIn(plan, mean);
    for (std::size_t i = 0; i < shape.collided.size(); ++i)
        if (const double layer = layers[plan.depths.slots[i].layer]; layer > 0) shape.collided[i] /= layer;
    return shape;
}

std::vector<double> fluxOf(const SlabBestPlan& plan, SlabBestSums found, double walks,
                           const std::vector<double>& better) {
    const SlabLayout& layout = plan.layout;
    std::vector<double> flux(layout.slots());
    const auto at = [&](SlabLayout::Run run, std::size_t i = 0) -> double& { return flux[layout.first(run) + i]; };
    const auto level = [&](std::vector<double>& list, const std::vector<double>& parts, SlabLayout::Run run) {
        if (better.empty()) return;
        const double surplus = sumOf(list) - better[layout.first(run)];
        for (std::size_t i = 0; i < list.size(); ++i) list[i] -= surplus * parts[i];
    };
    level(found.reflected_a, plan.shape.reflected_a, SlabLayout::R_scattered);
    level(found.transmitted_a, plan.shape.transmitted_a, SlabLayout::T_scattered);
    const std::vector<double> collided = collidedIn(plan, found);
    for (std::size_t i = 0; i < plan.depths.slots.size(); ++i) {
        const auto [index, depth] = plan.depths.slots[i];
        const SlabWalk::Layer& layer = plan.walk.layers[index];
        double weight = found.collided[i];
        at(SlabLayout::A_total) += weight * layer.absorbed;
        at(SlabLayout::A_layer, index) += weight * layer.absorbed;
        if (layer.absorbed > 0 && !better.empty())
            weight -= plan.shape.collided[i] *
                      (collided[index] - better[layout.first(SlabLayout::A_layer) + index] / layer.absorbed);
        at(SlabLayout::A_z, depth) += weight * layer.absorbed;
        at(SlabLayout::F_z, depth) += weight * layer.mfp_mm;
    }
    at(SlabLayout::R_single) = sumOf(found.single);
    at(SlabLayout::R_scattered) = sumOf(found.single) + sumOf(found.multiple);
    at(SlabLayout::T_scattered) = sumOf(found.transmitted);
    at(SlabLayout::R_unscattered) = walks * plan.control.unscattered.R;
    at(SlabLayout::T_unscattered) = walks * plan.control.unscattered.T;
    for (std::size_t row = 0; row < layout.rows(); ++row) {
        at(SlabLayout::R_r_single, row) = found.single[row];
        at(SlabLayout::R_r_multiple, row) = found.multiple[row];
        at(SlabLayout::R_r, row) = found.single[row] + found.multiple[row];
        at(SlabLayout::T_r, row) = found.transmitted[row];
    }
    std::ranges::copy(found.reflected_a, &at(SlabLayout::R_a));
    std::ranges::copy(found.transmitted_a, &at(SlabLayout::T_a));
    return flux;
}

}  // namespace searchlight
