#include "render/cell_view.h"

#include <optional>

#include "base/parallel.h"

namespace searchlight {

namespace {

constexpr int kPixelRays = 3;  // per side of a pixel: edges are smooth, and cells blend

// What stands behind a ray: a cell and the cosine between ray and normal.
struct Seen {
    std::uint32_t cell = 0;
    double cosine = 0;
};

std::optional<Seen> seen(const MeshBody& body, Vec3 eye, Vec3 direction) {
    const auto hit = body.rays().intersect({toFloat(eye), toFloat(direction)});
    if (!hit) return {};
    return Seen{body.cells().at(hit->triangle, hit->u, hit->v), -dot(direction, toDouble(hit->normal))};
}

std::optional<Seen> seen(const Ball& ball, Vec3 eye, Vec3 direction) {
    const auto point = ball.seen(eye, direction);
    if (!point) return {};
    return Seen{ball.cells().at(point->normal), -dot(direction, point->normal)};
}

template <class Body>
CellView viewOf(const View& camera, const Body& body, double eta, int threads) {
    std::vector<std::vector<CellSample>> rows(static_cast<std::size_t>(camera.height));
    parallelFor(rows.size(), threads, [&](std::size_t y) {
        for (int x = 0; x < camera.width; ++x)
            for (int i = 0; i < kPixelRays * kPixelRays; ++i) {
                const double dx = (i % kPixelRays + 0.5) / kPixelRays, dy = (i / kPixelRays + 0.5) / kPixelRays;
                const Vec3 direction = normalize(camera.direction(x + dx, static_cast<double>(y) + dy));
                const std::optional<Seen> found = seen(body, camera.eye, direction);
                if (!found || !(found->cosine > 0)) continue;
                rows[y].push_back({static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(camera.width) +
                                       static_cast<std::uint32_t>(x),
                                   found->cell, 1.0f / (kPixelRays * kPixelRays),
                                   static_cast<float>(exitFactor(eta, found->cosine))});
            }
    });
    CellView view{camera.width, camera.height, {}};
    for (const auto& row : rows) view.samples.insert(view.samples.end(), row.begin(), row.end());
    return view;
}

}  // namespace

CellView cellView(const View& camera, const Ball& ball, double eta, int threads) {
    return viewOf(camera, ball, eta, threads);
}

CellView cellView(const View& camera, const MeshBody& body, double eta, int threads) {
    return viewOf(camera, body, eta, threads);
}

}  // namespace searchlight
