#include "render/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "render/visible/gather.h"

namespace searchlight {

namespace {

constexpr double degree = std::numbers::pi / 180;

struct Basis {
    Vec3 right, up, forward;
};

Basis basisOf(const Camera& camera) {
    const double azimuth = camera.azimuth_deg * degree, elevation = camera.elevation_deg * degree;
    const Vec3 to_eye{std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                      std::cos(azimuth) * std::cos(elevation)};
    // From the azimuth alone, so that a camera straight above has its up side too.
    const Vec3 right{std::cos(azimuth), 0, -std::sin(azimuth)};
    const Vec3 forward = -1.0 * to_eye;
    return {right, cross(right, forward), forward};
}

// The second coordinate of a Hammersley point, in the middle of its stratum.
double radicalInverse(int k, int count) {
    double value = 0, digit = 0.5;
    for (int rest = k; rest > 0; rest >>= 1, digit /= 2)
        if (rest & 1) value += digit;
    return value + 0.5 / count;
}

Ray rayThrough(const View& view, double x, double y) { return {toFloat(view.eye), toFloat(view.direction(x, y))}; }

// Whether something is hit.
bool put(const RayHit& hit, std::size_t at, Hits& hits) {
    if (!std::isfinite(hit.t)) return false;
    hits.inverse_depth[at] = 1 / hit.t;  // the direction's forward component is 1
    hits.triangle[at] = hit.triangle;
    hits.u[at] = hit.u;
    hits.v[at] = hit.v;
    return true;
}

// Rays against the mesh.
class TracedHits final : public HitSource {
public:
    TracedHits(const View& view, const RayScene& rays, const TraceOptions& options)
        : view_(view), rays_(rays), pattern_(edgePattern(std::max(1, options.edge_samples))) {}

    bool centres(const Tile& tile, Hits& hits) const override {
        // Blocks of 8 x 8, whose rays go the same way.
        bool any = false;
        Batch batch;
        for (int top = 0; top < tile.height + 2; top += block_side)
            for (int left = 0; left < tile.width + 2; left += block_side) {
                batch.count = 0;
                forPixels(tile, left, top,
                          [&](int x, int y, std::size_t at) { batch.add(rayThrough(view_, x + 0.5, y + 0.5), at); });
                any = batch.intersect(rays_, hits) || any;
            }
        return any;
    }

    void samples(const Tile& tile, std::span<const std::uint16_t> pixels, std::size_t stride,
                 Hits& hits) const override {
        Batch batch;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const int x = tile.left + pixels[i] % Tile::side, y = tile.top + pixels[i] / Tile::side;
            for (std::size_t k = 0; k < pattern_.size(); ++k) {
                batch.add(rayThrough(view_, x + pattern_[k].first, y + pattern_[k].second), i * stride + k);
                if (batch.count == batch.rays.size()) batch.intersect(rays_, hits);
            }
        }
        batch.intersect(rays_, hits);
    }

private:
    static constexpr int block_side = 8;

    struct Batch {
        std::array<Ray, block_side * block_side> rays;
        std::array<std::size_t, block_side * block_side> at;
        std::size_t count = 0;

        void add(const Ray& ray, std::size_t place) {
            rays[count] = ray;
            at[count++] = place;
        }
        bool intersect(const RayScene& scene, Hits& hits) {
            std::array<RayHit, block_side * block_side> found;
            scene.intersect(std::span(rays).first(count), std::span(found).first(count), true);
            bool any = false;
            for (std::size_t i = 0; i < count; ++i) any = put(found[i], at[i], hits) || any;
            count = 0;
            return any;
        }
    };

    // Those of a block of the window that lie in the picture.
    template <class Body>
    void forPixels(const Tile& tile, int left, int top, const Body& body) const {
        for (int wy = top; wy < std::min(top + block_side, tile.height + 2); ++wy)
            for (int wx = left; wx < std::min(left + block_side, tile.width + 2); ++wx) {
                const int x = tile.left + wx - 1, y = tile.top + wy - 1;
                if (x >= 0 && y >= 0 && x < view_.width && y < view_.height) body(x, y, Tile::at(wx, wy));
            }
    }

    const View& view_;
    const RayScene& rays_;
    std::vector<std::pair<double, double>> pattern_;
};

// What a picture of hits says.
class FoundHits final : public HitSource {
public:
    FoundHits(const View& view, const PictureHits& found, const TraceOptions& options)
        : view_(view), found_(found), pattern_(edgePattern(std::max(1, options.edge_samples))) {}

    bool centres(const Tile& tile, Hits& hits) const override {
        bool any = false;
        for (int y = std::max(0, tile.top - 1); y < std::min(view_.height, tile.top + tile.height + 1); ++y)
            for (int x = std::max(0, tile.left - 1); x < std::min(view_.width, tile.left + tile.width + 1); ++x)
                any = put(found_.hit(x, y, -1, rayThrough(view_, x + 0.5, y + 0.5)),
                          Tile::at(x - tile.left + 1, y - tile.top + 1), hits) ||
                      any;
        return any;
    }

    void samples(const Tile& tile, std::span<const std::uint16_t> pixels, std::size_t stride,
                 Hits& hits) const override {
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const int x = tile.left + pixels[i] % Tile::side, y = tile.top + pixels[i] / Tile::side;
            for (std::size_t k = 0; k < pattern_.size(); ++k)
                put(found_.hit(x, y, static_cast<int>(k),
                               rayThrough(view_, x + pattern_[k].first, y + pattern_[k].second)),
                    i * stride + k, hits);
        }
    }

private:
    const View& view_;
    const PictureHits& found_;
    std::vector<std::pair<double, double>> pattern_;
};

VisibleSurface gathered(const View& view, const Object& object, const HitSource& source, const TraceOptions& options,
                        Observer& observer) {
    VisibleSurface visible;
    SurfaceGatherer().gather(view, object.mesh, source, options, observer, visible);
    return visible;
}

}  // namespace

Camera framedCamera(const Camera& camera, const Object& object, int width, int height) {
    if (camera.distance > 0) return camera;
    constexpr double height_filled = 0.7, width_filled = 0.84;
    const Basis basis = basisOf(camera);
    const double tan_y = std::tan(0.5 * camera.field_of_view_deg * degree);
    const double limit_y = height_filled * tan_y, limit_x = width_filled * tan_y * width / height;
    // A point at (x, y, z) from the target, z towards the eye, is seen within the limits from z + |y| / limit_y on.
    double distance = 0;
    for (const Vec3f& position : object.mesh.positions) {
        const Vec3 offset = (1 / object.longest_mm) * toDouble(position) - camera.target;
        const double towards = -dot(offset, basis.forward);
        distance = std::max({distance, towards + std::abs(dot(offset, basis.up)) / limit_y,
                             towards + std::abs(dot(offset, basis.right)) / limit_x});
    }
    Camera framed = camera;
    framed.distance = distance;
    return framed;
}

View makeView(const Camera& camera, const Object& object, int width, int height) {
    const Camera framed = framedCamera(camera, object, width, height);
    const Basis basis = basisOf(framed);
    View view{.width = width, .height = height, .right = basis.right, .up = basis.up, .forward = basis.forward};
    view.eye = object.longest_mm * (framed.target - framed.distance * basis.forward);
    view.tan_half = std::tan(0.5 * framed.field_of_view_deg * degree);
    return view;
}

VisibleSurface traceVisible(const View& view, const Object& object, const RayScene& rays, const TraceOptions& options,
                            Observer& observer) {
    return gathered(view, object, TracedHits(view, rays, options), options, observer);
}

std::vector<std::pair<double, double>> edgePattern(int count) {
    std::vector<std::pair<double, double>> pattern;
    for (int k = 0; k < count; ++k) pattern.push_back({(k + 0.5) / count, radicalInverse(k, count)});
    return pattern;
}

VisibleSurface visibleSurface(const View& view, const Object& object, const PictureHits& hits,
                              const TraceOptions& options, Observer& observer) {
    return gathered(view, object, FoundHits(view, hits, options), options, observer);
}

}  // namespace searchlight
