#include "render/direct/walked_single.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "transport/mesh/first_orders.h"

namespace searchlight {

namespace {

// As cells of the exitance reference in a contest.
constexpr double pixels_per_cell = 4;
constexpr int light_draws = 1024;
constexpr std::uint32_t no_cell = std::numeric_limits<std::uint32_t>::max();

MeshBody bodyOf(const RenderInput& input) {
    const View& view = *input.view;
    const double distance = std::max(length(view.eye), 1e-3 * input.object->longest_mm);
    const double pixel = 2 * view.tan_half / view.height * distance;
    const Rgb sigma_t = input.medium->sigmaT();
    return {input.object->mesh,
            {.cell_area_mm2 = pixels_per_cell * pixel * pixel,
             .shortest_mfp = 1 / std::max({sigma_t.r, sigma_t.g, sigma_t.b}),
             .regions = false,  // for walks of many short flights: these are a few long ones
             .threads = input.threads}};
}

// The cell below each receiver, met by a short ray from outside.
std::vector<std::uint32_t> cellsOf(const VisibleSurface& visible, const MeshBody& body) {
    const std::size_t count = visible.positions.size();
    const float away = 1e-3f * body.rays().extent();
    std::vector<Ray> rays(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 n = toDouble(visible.geometric_normals[i]);
        rays[i] = {toFloat(toDouble(visible.positions[i]) + static_cast<double>(away) * n), toFloat(-1 * n), 0,
                   2 * away};
    }
    std::vector<RayHit> hits(count);
    body.rays().intersect(rays, hits, false);
    std::vector<std::uint32_t> cells(count, no_cell);
    for (std::size_t i = 0; i < count; ++i)
        if (std::isfinite(hits[i].t)) cells[i] = body.cells().at(hits[i].triangle, hits[i].u, hits[i].v);
    return cells;
}

}  // namespace

WalkedSingle::WalkedSingle(const RenderInput& input)
    : medium_(*input.medium),
      threads_(input.threads),
      lights_(*input.scene, *input.object),
      body_(bodyOf(input)),
      cells_(cellsOf(*input.visible, body_)) {
    std::ranges::fill(lit_, false);
    if (lights_.dark()) return;
    SplitMix64 random = streamOf(input.light.seed, 0);
    for (int i = 0; i < light_draws; ++i) {
        const double light = random.uniform(), u = random.uniform(), v = random.uniform();
        const Rgb found = lights_.sample({}, light, u, v).irradiance_over_pdf;
        for (int c = 0; c < Rgb::channels; ++c) lit_[c] = lit_[c] || found[c] > 0;
    }
}

void WalkedSingle::addTo(std::span<Rgb> exitance, std::uint64_t walks, std::uint64_t seed, Observer& observer) const {
    for (int c = 0; c < Rgb::channels; ++c) {
        if (!lit_[c] || !medium_.scatters(c)) continue;
        const FirstOrders orders =
            walkFirstOrders(body_, medium_, c, &lights_, {.walks = walks, .seed = seed, .threads = threads_}, observer);
        for (std::size_t i = 0; i < exitance.size(); ++i)
            if (cells_[i] != no_cell) exitance[i][c] += orders.single[cells_[i]];
    }
}

}  // namespace searchlight
