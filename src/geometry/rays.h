// Rays against a triangle mesh. The only door to Embree.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "scene/mesh.h"

namespace searchlight {

struct Ray {
    Vec3f origin;
    Vec3f direction;  ///< need not be unit: distances are in multiples of it
    float t_min = 0;
    float t_max = std::numeric_limits<float>::infinity();
};

struct RayHit {
    float t = 0;
    std::uint32_t triangle = 0;
    float u = 0, v = 0;  ///< barycentric: position = (1 - u - v) p0 + u p1 + v p2
    Vec3f normal;        ///< geometric, unit, outward by the triangle's orientation, whichever side was hit
};

/// Rays side by side, and how far to look along all of them. Up to 7 numbers behind the last of each list may be read.
struct RayColumns {
    const float *x, *y, *z, *dx, *dy, *dz, *t_min;
    std::size_t count = 0;
    float t_max = std::numeric_limits<float>::infinity();
};

/// The hit of one of many rays.
struct ListedHit {
    std::uint32_t ray = 0;
    RayHit hit;
};

/// Immutable once built; all queries may run on many threads at once. Both sides of a triangle are hit; one without
/// area is not. Watertight at shared edges. Of rays that meet a vertex within a few ulps about 1 in 400 slips through,
/// as Embree rounds the edges around it one by one: a walk that finds no way out of a closed mesh has to try again.
class RayScene {
public:
    /// Copies the mesh's triangles. Throws an input Error when there are none, a device Error when memory ends.
    explicit RayScene(const Mesh& mesh);
    ~RayScene();
    RayScene(RayScene&&) noexcept;
    RayScene& operator=(RayScene&&) noexcept;

    /// The nearest hit in (t_min, t_max].
    std::optional<RayHit> intersect(const Ray& ray) const;

    /// Whether anything is hit in (t_min, t_max].
    bool occluded(const Ray& ray) const;

    /// The same for many rays on the calling thread; `results` as long as `rays`; a miss has t = infinity, and
    /// occluded() says 1 or 0. `coherent`: neighbours in the list start near one another and point the same way.
    void intersect(std::span<const Ray> rays, std::span<RayHit> results, bool coherent) const;
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> results, bool coherent) const;

    /// The nearest hits of those that meet something, in their order, and how many these are; `hits` as long as the
    /// rays.
    std::size_t intersect(const RayColumns& rays, std::span<ListedHit> hits) const;

    /// The same for parallel rays to infinity from many origins, which are fastest when neighbours in the list are
    /// neighbours in space.
    void occluded(std::span<const Vec3f> origins, Vec3f direction, std::span<std::uint8_t> results) const;

    /// Where a ray that leaves the surface at `position` to the side that `geometric_normal` points to has to start, so
    /// that rounding cannot put it behind its own triangle: by 256 ulps per coordinate, and near a coordinate plane by
    /// 2^-16 of extent() [WachterBinder2019]. Then t_min may be 0. For rays into the object pass the negated normal.
    Vec3f offsetOrigin(Vec3f position, Vec3f geometric_normal) const;

    /// The largest coordinate, in magnitude, of the mesh.
    float extent() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace searchlight
