#include "light/lit_points.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "geometry/point_start.h"

namespace searchlight {

namespace {

constexpr std::size_t block = 1024;

// The bits of x at every third place.
std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x1f00000000ffffu;
    x = (x | x << 16) & 0x1f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    return (x | x << 2) & 0x1249249249249249u;
}

// Along the Morton curve through the bounding box; equal places keep the caller's order.
std::vector<std::uint32_t> curveOrder(std::span<const Vec3f> positions) {
    Vec3f low = positions[0], high = positions[0];
    for (const Vec3f& p : positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const float side = std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-30f});
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(positions.size());
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        const auto cell = [&](float p, float from) {
            return spread(static_cast<std::uint64_t>((p - from) / side * 65535));
        };
        const Vec3f& p = positions[i];
        keys[i] = {cell(p.x, low.x) | cell(p.y, low.y) << 1 | cell(p.z, low.z) << 2, i};
    }
    std::ranges::sort(keys);
    std::vector<std::uint32_t> order(positions.size());
    std::ranges::transform(keys, order.begin(), [](const auto& key) { return key.second; });
    return order;
}

double areaOf(const Object& object) {
    if (object.isMesh()) return surfaceArea(object.mesh);
    double area = 0;
    for (const float part : object.cloud.areas) area += part;
    return area;
}

// From the flat triangle to the surface that the corners' normals span, [Hanika2021]: the mean of the point's
// projections to the corners' tangent planes, only those that lie above it.
Vec3 liftToSmooth(const Mesh& mesh, const RayHit& hit, Vec3 position) {
    if (mesh.normals.empty()) return {};
    const double weights[] = {1.0 - hit.u - hit.v, hit.u, hit.v};
    Vec3 lift;
    for (int k = 0; k < 3; ++k) {
        const std::uint32_t corner = mesh.triangles[hit.triangle][k];
        const Vec3 normal = toDouble(mesh.normals[corner]);
        const double below = std::min(0.0, dot(position - toDouble(mesh.positions[corner]), normal));
        lift = lift - (weights[k] * below) * normal;
    }
    return lift;
}

class Preparation {
public:
    Preparation(const Object& object, const RayScene& rays, LitNormals kind, double spacing_mm)
        : object_(object), rays_(rays), kind_(kind), spacing_mm_(spacing_mm) {}

    // Sets the normal and the origin of a point.
    void prepare(Vec3f position, Vec3f& normal, Vec3f& origin) const {
        if (!object_.isMesh()) {
            origin = toFloat(toDouble(position) + spacing_mm_ * toDouble(normal));
            return;
        }
        const std::optional<RayHit> hit = triangleAt(position, normal);
        if (!hit) {
            origin = rays_.offsetOrigin(position, normal);
            return;
        }
        origin = rays_.offsetOrigin(position, hit->normal);
        if (kind_ == LitNormals::geometric) {
            normal = hit->normal;
            return;
        }
        const Vec3 lift = liftToSmooth(object_.mesh, *hit, toDouble(position));
        if (length(lift) > 0 && !rays_.occluded({origin, toFloat(lift), 0, 1}))
            origin = toFloat(toDouble(origin) + lift);
    }

private:
    // The triangle that the point lies on, by a ray through it, 2^-14 of the extent to both sides: far more than the
    // rounding of a point and far less than what is worth a shadow.
    std::optional<RayHit> triangleAt(Vec3f position, Vec3f normal) const {
        const double reach = std::ldexp(rays_.extent(), -14);
        const Vec3 up = reach * toDouble(normal);
        return rays_.intersect({toFloat(toDouble(position) + up), toFloat(-1.0 * up), 0, 2});
    }

    const Object& object_;
    const RayScene& rays_;
    LitNormals kind_;
    double spacing_mm_;
};

}  // namespace

LitPoints prepareLitPoints(const SurfacePoints& points, const Object& object, const RayScene* rays, LitNormals normals,
                           int threads, Observer& observer) {
    assert(points.positions.size() == points.normals.size());
    assert(rays || normals == LitNormals::shading);
    LitPoints lit;
    const std::size_t count = points.positions.size();
    if (count == 0) return lit;
    lit.order = curveOrder(points.positions);
    lit.spacing_mm = std::sqrt(areaOf(object) / static_cast<double>(count));
    lit.positions.resize(count);
    lit.normals.resize(count);
    lit.origins.resize(count);
    parallelFor((count + block - 1) / block, threads, [&](std::size_t b) {
        if (observer.cancelled()) throw interruptedError();
        for (std::size_t i = b * block; i < std::min(count, (b + 1) * block); ++i) {
            lit.positions[i] = points.positions[lit.order[i]];
            lit.normals[i] = points.normals[lit.order[i]];
            lit.origins[i] = lit.positions[i];
            if (rays)
                Preparation(object, *rays, normals, lit.spacing_mm)
                    .prepare(lit.positions[i], lit.normals[i], lit.origins[i]);
        }
    });
    return lit;
}

}  // namespace searchlight
