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
    Vec3f normal;        ///< geometric, unit, outward by the triangle's orientation
};

/// Immutable once built; all queries may run on many threads at once. Watertight at shared edges.
class RayScene {
public:
    /// Copies the mesh's triangles. Throws an input Error when there are none.
    explicit RayScene(const Mesh& mesh);
    ~RayScene();
    RayScene(RayScene&&) noexcept;
    RayScene& operator=(RayScene&&) noexcept;

    /// The nearest hit in (t_min, t_max).
    std::optional<RayHit> intersect(const Ray& ray) const;

    /// Whether anything is hit in (t_min, t_max).
    bool occluded(const Ray& ray) const;

    /// The same for many rays, in streams of packets; `results` as long as `rays`; a miss has t = infinity.
    void intersect(std::span<const Ray> rays, std::span<RayHit> results, bool coherent) const;
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> results, bool coherent) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace searchlight
