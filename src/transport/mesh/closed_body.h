// Bodies that walks stay inside of: a sphere, and what a closed mesh encloses. Lengths are mm.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geometry/rays.h"
#include "scene/mesh.h"
#include "transport/mesh/flights.h"
#include "transport/mesh/safe_regions.h"
#include "transport/mesh/surface_cells.h"
#include "transport/mesh/triangle_grid.h"

namespace searchlight {

/// A point of a surface.
struct SurfacePoint {
    Vec3 position;
    Vec3 normal;  ///< geometric, outward, unit
};

/// A question: does the body hide what lies `distance` away in direction wi (unit, above the surface)?
struct Shadow {
    SurfacePoint point;
    Vec3 wi;
    double distance = 0;
};

/// Where a flight meets the surface from inside.
struct Crossing {
    enum class What : std::uint8_t { none, surface, lost };

    What what = What::none;  ///< lost: rounding has put the flight on the wrong side of the surface
    std::uint32_t cell = 0;  ///< of the surface; for `surface` alone, like what follows
    Vec3f position;          ///< on the surface
    Vec3f inside;  ///< the same, moved inwards by as much as it may be rounded: from where a reflection goes on
    Vec3 normal;   ///< outward, unit
    std::uint32_t triangle = 0;  ///< of a mesh
    float u = 0, v = 0;          ///< barycentric, as RayHit has them
};

/// Throws an input Error for a body so large against the mean free path that single precision would not do.
void requireResolved(double longest_mm, double mfp_mm);

/// A sphere about the origin.
class Ball {
public:
    /// Throws an input Error unless the radius is positive, and that of makeSphereCells.
    Ball(double radius_mm, double cell_area_mm2);

    double radius() const { return radius_; }
    double area() const;
    double volume() const;
    const SphereCells& cells() const { return cells_; }
    std::size_t cellCount() const { return cells_.size(); }
    double cellArea(std::size_t) const { return cells_.area_mm2(); }

    /// Uniform by area for uniform numbers in [0, 1).
    SurfacePoint pointAt(double u, double v, double w) const;
    /// Where to start from just below a point of the surface.
    Vec3f below(const SurfacePoint& point) const { return toFloat(point.position); }
    /// Whether the body hides what lies `distance` away in direction wi (unit, above the surface).
    bool occluded(const SurfacePoint&, Vec3, double) const { return false; }
    /// The same for many, which are near one another: 1 or 0 for each.
    void occluded(std::span<const Shadow> shadows, std::span<std::uint8_t> hidden) const {
        std::fill_n(hidden.begin(), shadows.size(), std::uint8_t{0});
    }
    /// Where a ray from outside meets the surface, its direction unit.
    std::optional<SurfacePoint> seen(Vec3 origin, Vec3 direction) const;
    /// How far it is to the surface from inside towards wi (unit), mm; nothing when light from there, `distance` away,
    /// is hidden by another part of the body.
    std::optional<double> wayOut(Vec3 position, Vec3 wi, double distance) const;
    /// Flights that may have left: where from t_min to t_max they cross from inside.
    void cross(std::span<const Ray> flights, std::span<Crossing> crossings) const;
    /// The same for flights side by side. The cells are left to cellOf().
    void cross(const Flights& flights, FlightHits& hits) const;
    void seekCell(std::uint32_t) const {}
    /// No walk inside is beyond this box.
    Vec3f low() const { return {-kEndless, -kEndless, -kEndless}; }
    Vec3f high() const { return {kEndless, kEndless, kEndless}; }
    std::uint32_t cellOf(const Crossing& crossing) const { return cells_.at(crossing.normal); }

private:
    static constexpr float kEndless = std::numeric_limits<float>::max();
    double radius_;
    SphereCells cells_;
};

struct MeshBodyOptions {
    double cell_area_mm2 = 0;  ///< of the receivers; 0: one per triangle
    double shortest_mfp = 1;   ///< mm, of the walks to come: chooses the grid of safe regions
    bool regions = true;       ///< false: a ray of Embree for each flight; slow, and what walks are tested against
    bool grid_alone = false;   ///< without regions: each flight is tested by the grid instead, to measure that
    int threads = 0;
};

/// What a closed mesh encloses. Immutable; all queries may run on many threads at once.
class MeshBody {
public:
    /// Throws an input Error for a mesh that encloses nothing: open, inconsistently oriented, inside out, without
    /// volume; and that of requireResolved.
    MeshBody(const Mesh& mesh, const MeshBodyOptions& options);

    double area() const { return area_to_.back(); }
    double volume() const { return volume_; }
    /// The mesh, its triangles and vertices in an order of their own, and nothing beside them.
    const Mesh& mesh() const { return mesh_; }
    const RayScene& rays() const { return rays_; }
    const SurfaceCells& cells() const { return cells_; }
    std::size_t cellCount() const { return cells_.size(); }
    double cellArea(std::size_t cell) const { return cells_.areas_mm2()[cell]; }
    const SafeRegions& regions() const { return regions_; }
    double build_seconds() const { return build_seconds_; }

    SurfacePoint pointAt(double u, double v, double w) const;
    Vec3f below(const SurfacePoint& point) const;
    bool occluded(const SurfacePoint& point, Vec3 wi, double distance) const;
    void occluded(std::span<const Shadow> shadows, std::span<std::uint8_t> hidden) const;
    std::optional<SurfacePoint> seen(Vec3 origin, Vec3 direction) const;
    std::optional<double> wayOut(Vec3 position, Vec3 wi, double distance) const;
    void cross(std::span<const Ray> flights, std::span<Crossing> crossings) const;
    void cross(const Flights& flights, FlightHits& hits) const;
    Vec3f low() const { return low_; }
    Vec3f high() const { return high_; }
    /// Asks the memory for what cellOf() will read.
    void seekCell(std::uint32_t triangle) const { cells_.seek(triangle); }
    std::uint32_t cellOf(const Crossing& crossing) const {
        return cells_.at(crossing.triangle, crossing.u, crossing.v);
    }

private:
    Vec3 positionOf(const RayHit& hit) const;
    bool beyond(Vec3f end) const;
    void fill(const RayHit& hit, Vec3 at, Crossing& crossing) const;
    /// What becomes of a flight whose nearest hit is at `at`.
    Crossing::What cross(const Ray& flight, RayHit hit, Vec3 at, Crossing& crossing) const;
    std::optional<RayHit> leaving(const Ray& flight, const RayHit& entered) const;

    Mesh mesh_;
    RayScene rays_;
    SurfaceCells cells_;
    SafeRegions regions_;
    TriangleGrid grid_;                  ///< empty without regions
    std::vector<double> area_to_;        ///< of the triangles up to each
    std::vector<std::ptrdiff_t> first_;  ///< of the triangles that end beyond each of as many equal parts of the area
    Vec3f low_, high_;                   ///< of a box around the mesh and a little more: no walk inside is beyond
    double volume_ = 0;
    double nudge_ = 0;  ///< mm: how far a point on the surface may be rounded off it
    double build_seconds_ = 0;
};

/// Of the volume that the mesh encloses, mm^3; below 0 when it is inside out.
double enclosedVolume(const Mesh& mesh);

/// Throws an input Error that says what is wrong unless every edge has exactly two triangles that run along it in
/// opposite ways and the volume is positive. Vertices at one place count as one.
void checkClosed(const Mesh& mesh);

}  // namespace searchlight
