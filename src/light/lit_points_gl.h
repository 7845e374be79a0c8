// Surface points and the object that shadows them on a device: what is done once per set of points there.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/vec.h"
#include "gl/program.h"
#include "light/lit_points.h"
#include "light/shadow_gl.h"

namespace searchlight {

/// A depth map, and the way to draw into each of its layers.
struct ShadowMapGl {
    gl::Texture depth;
    std::vector<std::unique_ptr<gl::Framebuffer>> layers;

    /// `side` texels; `cube`: six layers, else one.
    ShadowMapGl(gl::Context& context, int side, bool cube);
};

/// Points on a device, and programs that add light from one direction or point to sums over them.
class LitPointsGl {
public:
    static constexpr int single_map = 2048, cube_map = 1024, shared_map = 512;  ///< texels a side

    /// `shadows`: the object's mesh casts them. `points` and `object` are kept; they, and the context, outlive this.
    LitPointsGl(gl::Context& context, const LitPoints& points, const Object& object, bool shadows);

    gl::Context& context() const { return context_; }
    const LitPoints& points() const { return points_; }
    const Object& object() const { return object_; }
    bool shadows() const { return caster_.has_value(); }

    /// A sum per point, all 0.
    gl::Buffer sums() const;

    /// One map that lives as long as this, of shared_map texels: for light from many directions.
    ShadowMapGl& sharedMap();

    /// Adds T12 cos for light from `wi` (unit). Draws `map`, which has one layer, anew. `weight`: irradiance on a
    /// surface that faces the light. `shadowed` false: every point that faces the light receives it.
    void addDirection(ShadowMapGl& map, Vec3 wi, Rgb weight, double eta, const gl::Buffer& sums, bool shadowed = true);

    /// The same from a point, mm; `weight` at the distance of the object's longest side.
    void addPoint(Vec3 place, Rgb weight, double eta, const gl::Buffer& sums);

    /// `factor` times the sums, in the caller's order of points.
    std::vector<Rgbf> download(const gl::Buffer& sums, double factor) const;

private:
    // Where light comes from, and what its shadow map looks like.
    enum class Kind { parallel, far_point, near_point };

    static gl::Source source(Kind kind);
    gl::Program& program(Kind kind);
    void dispatch(Kind kind, const ShadowCasterGl::Projection& projection, const ShadowMapGl& map, Vec3 towards,
                  Rgb weight, double eta, bool shadowed, const gl::Buffer& sums);

    gl::Context& context_;
    const LitPoints& points_;
    const Object& object_;
    std::array<std::optional<gl::Program>, 3> programs_;  // by Kind, made when needed
    gl::Buffer normals_, origins_, positions_;
    std::optional<ShadowCasterGl> caster_;  // none: nothing casts shadows
    std::optional<ShadowMapGl> shared_;
};

}  // namespace searchlight
