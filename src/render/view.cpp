#include "render/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/parallel.h"

namespace searchlight {

namespace {

constexpr int tile_size = 8;
constexpr int tile_pixels = tile_size * tile_size;
constexpr double degree = std::numbers::pi / 180;

// Normals further apart than 25 degrees are a crease: closer ones shade alike.
constexpr double crease_cosine = 0.9;
// A neighbour on the same smooth surface lies within this many pixel widths of the tangent plane.
constexpr double depth_jump_pixels = 2;

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

struct Sample {
    bool hit = false;
    float depth = 0;  // along the forward axis
    Vec3f position, normal, geometric_normal;
};

// The second coordinate of a Hammersley point, in the middle of its stratum.
double radicalInverse(int k, int count) {
    double value = 0, digit = 0.5;
    for (int rest = k; rest > 0; rest >>= 1, digit /= 2)
        if (rest & 1) value += digit;
    return value + 0.5 / count;
}

class Tracer {
public:
    // Of `rays` and `found` one is null.
    Tracer(const View& view, const Object& object, const RayScene* rays, const PictureHits* found,
           const TraceOptions& options)
        : view_(view),
          mesh_(object.mesh),
          rays_(rays),
          found_(found),
          options_(options),
          columns_((view.width + tile_size - 1) / tile_size),
          rows_((view.height + tile_size - 1) / tile_size),
          pattern_(edgePattern(std::max(1, options.edge_samples))),
          centres_(static_cast<std::size_t>(view.width) * view.height) {}

    VisibleSurface run(Observer& observer) {
        const std::size_t tiles = static_cast<std::size_t>(columns_) * rows_;
        forTiles(tiles, observer, [&](std::size_t tile) { traceCentres(tile); });
        std::vector<VisibleSurface> parts(tiles);
        forTiles(tiles, observer, [&](std::size_t tile) { gather(tile, parts[tile]); });
        return joined(parts);
    }

private:
    template <class Body>
    void forTiles(std::size_t tiles, Observer& observer, const Body& body) const {
        parallelFor(tiles, options_.threads, [&](std::size_t tile) {
            if (observer.cancelled()) throw interruptedError();
            body(tile);
        });
    }

    template <class Body>
    void forPixels(std::size_t tile, const Body& body) const {
        const int left = static_cast<int>(tile % static_cast<std::size_t>(columns_)) * tile_size;
        const int top = static_cast<int>(tile / static_cast<std::size_t>(columns_)) * tile_size;
        for (int y = top; y < std::min(top + tile_size, view_.height); ++y)
            for (int x = left; x < std::min(left + tile_size, view_.width); ++x) body(x, y);
    }

    Ray rayThrough(double x, double y) const { return {toFloat(view_.eye), toFloat(view_.direction(x, y))}; }
    Sample& centre(int x, int y) { return centres_[static_cast<std::size_t>(y) * view_.width + x]; }
    const Sample& centre(int x, int y) const { return const_cast<Tracer*>(this)->centre(x, y); }

    Sample sampleOf(const Ray& ray, const RayHit& hit) const {
        Sample sample;
        if (!std::isfinite(hit.t)) return sample;
        sample.hit = true;
        sample.depth = hit.t;  // the direction's forward component is 1
        const auto& corners = mesh_.triangles[hit.triangle];
        const auto interpolated = [&](const std::vector<Vec3f>& values) {
            return (1.0 - hit.u - hit.v) * toDouble(values[corners[0]]) + hit.u * toDouble(values[corners[1]]) +
                   hit.v * toDouble(values[corners[2]]);
        };
        const Vec3 to_eye = normalize(-1.0 * toDouble(ray.direction));
        Vec3 geometric = toDouble(hit.normal);
        // Open meshes show their inside.
        const bool inside = dot(geometric, to_eye) < 0;
        if (inside) geometric = -1.0 * geometric;
        Vec3 normal = mesh_.normals.empty() ? geometric : interpolated(mesh_.normals);
        if (inside && !mesh_.normals.empty()) normal = -1.0 * normal;
        if (!(length(normal) > 1e-6) || dot(normal, geometric) <= 0) normal = geometric;
        sample.position = toFloat(interpolated(mesh_.positions));
        sample.normal = toFloat(normalize(normal));
        sample.geometric_normal = toFloat(geometric);
        return sample;
    }

    void traceCentres(std::size_t tile) {
        std::array<Ray, tile_pixels> rays;
        std::array<RayHit, tile_pixels> hits;
        std::size_t count = 0;
        forPixels(tile, [&](int x, int y) { rays[count++] = rayThrough(x + 0.5, y + 0.5); });
        if (rays_) rays_->intersect(std::span(rays).first(count), std::span(hits).first(count), true);
        std::size_t next = 0;
        forPixels(tile, [&](int x, int y) {
            if (found_) hits[next] = found_->hit(x, y, -1, rays[next]);
            centre(x, y) = sampleOf(rays[next], hits[next]);
            ++next;
        });
    }

    bool samePatch(const Sample& a, const Sample& b) const {
        const Vec3 step = toDouble(b.position) - toDouble(a.position);
        const double pixel_mm = 2 * view_.tan_half / view_.height * std::min(a.depth, b.depth);
        return dot(toDouble(a.normal), toDouble(b.normal)) > crease_cosine &&
               std::abs(dot(step, toDouble(a.geometric_normal))) < depth_jump_pixels * pixel_mm;
    }

    bool isEdge(int x, int y) const {
        const Sample& here = centre(x, y);
        for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
            const int nx = x + dx, ny = y + dy;
            if (nx < 0 || ny < 0 || nx >= view_.width || ny >= view_.height) continue;
            const Sample& there = centre(nx, ny);
            if (here.hit != there.hit) return true;
            if (here.hit && !samePatch(here, there)) return true;
        }
        return false;
    }

    static void append(VisibleSurface& part, std::uint32_t pixel, float coverage, const Sample& sample) {
        part.pixels.push_back(pixel);
        part.coverage.push_back(coverage);
        part.positions.push_back(sample.position);
        part.normals.push_back(sample.normal);
        part.geometric_normals.push_back(sample.geometric_normal);
    }

    // The samples of an edge pixel, those of one patch as one: exitance hardly changes within a pixel.
    void gatherEdge(int x, int y, VisibleSurface& part) const {
        struct Patch {
            Sample first;
            Vec3 normals;
            int count = 0;
        };
        std::vector<Ray> rays;
        for (const auto& [px, py] : pattern_) rays.push_back(rayThrough(x + px, y + py));
        std::vector<RayHit> hits(rays.size());
        if (rays_) rays_->intersect(rays, hits, true);
        for (std::size_t k = 0; k < rays.size() && found_; ++k)
            hits[k] = found_->hit(x, y, static_cast<int>(k), rays[k]);
        std::vector<Patch> patches;
        for (std::size_t k = 0; k < rays.size(); ++k) {
            const Sample sample = sampleOf(rays[k], hits[k]);
            if (!sample.hit) continue;
            auto patch = std::ranges::find_if(patches, [&](const Patch& p) { return samePatch(p.first, sample); });
            if (patch == patches.end()) patch = patches.insert(patches.end(), {sample, {}, 0});
            patch->normals = patch->normals + toDouble(sample.normal);
            ++patch->count;
        }
        const auto pixel =
            static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(view_.width) + static_cast<std::uint32_t>(x);
        for (Patch& patch : patches) {
            patch.first.normal = toFloat(normalize(patch.normals));
            append(part, pixel, static_cast<float>(patch.count) / static_cast<float>(rays.size()), patch.first);
        }
    }

    void gather(std::size_t tile, VisibleSurface& part) const {
        forPixels(tile, [&](int x, int y) {
            if (options_.edge_samples > 1 && isEdge(x, y)) return gatherEdge(x, y, part);
            const auto pixel =
                static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(view_.width) + static_cast<std::uint32_t>(x);
            if (centre(x, y).hit) append(part, pixel, 1, centre(x, y));
        });
    }

    VisibleSurface joined(const std::vector<VisibleSurface>& parts) const {
        VisibleSurface all{.width = view_.width, .height = view_.height, .eye = view_.eye};
        const auto join = [&](auto member) {
            std::size_t size = 0;
            for (const VisibleSurface& part : parts) size += (part.*member).size();
            (all.*member).reserve(size);
            for (const VisibleSurface& part : parts)
                (all.*member).insert((all.*member).end(), (part.*member).begin(), (part.*member).end());
        };
        join(&VisibleSurface::pixels);
        join(&VisibleSurface::coverage);
        join(&VisibleSurface::positions);
        join(&VisibleSurface::normals);
        join(&VisibleSurface::geometric_normals);
        return all;
    }

    const View& view_;
    const Mesh& mesh_;
    const RayScene* rays_;
    const PictureHits* found_;
    TraceOptions options_;
    int columns_, rows_;
    std::vector<std::pair<double, double>> pattern_;  // within a pixel
    std::vector<Sample> centres_;
};

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
    return Tracer(view, object, &rays, nullptr, options).run(observer);
}

std::vector<std::pair<double, double>> edgePattern(int count) {
    std::vector<std::pair<double, double>> pattern;
    for (int k = 0; k < count; ++k) pattern.push_back({(k + 0.5) / count, radicalInverse(k, count)});
    return pattern;
}

VisibleSurface visibleSurface(const View& view, const Object& object, const PictureHits& hits,
                              const TraceOptions& options, Observer& observer) {
    return Tracer(view, object, nullptr, &hits, options).run(observer);
}

}  // namespace searchlight
