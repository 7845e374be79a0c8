// Shadow maps: a mesh in depth, as a light sees it.
#pragma once

#include <initializer_list>
#include <string_view>

#include "base/vec.h"
#include "geometry/object.h"
#include "gl/buffer.h"
#include "gl/raster_program.h"

namespace searchlight {

/// A mesh on the device, and the program that draws its depth.
class ShadowCasterGl {
public:
    /// What a fragment leaves: nothing but its depth.
    static constexpr std::string_view depth_alone = "src/light/shadow_gl.frag.glsl";

    /// `fragment`: the file of another fragment stage. The context outlives it.
    ShadowCasterGl(gl::Context& context, const Object& object, std::string_view fragment = depth_alone);

    /// Radius of the bounding sphere about 0, mm.
    double radius() const { return radius_; }

    /// How a map sees the world: with s, t and z along the axes from `origin`, it spans [-1, 1] in scale * s and
    /// scale * t, and depth is depth_factor * z + depth_term. From a point s and t are divided by z, and depth is
    /// depth_factor + depth_term / z.
    struct Projection {
        Vec3 origin, axis_s, axis_t, axis_depth;
        double scale = 1, depth_factor = 1, depth_term = 0;
        bool from_point = false;
    };

    /// Parallel light that comes from `wi` (unit): the bounding sphere fills the map.
    Projection parallel(Vec3 wi) const;

    /// From a point that lies outside the bounding sphere, which fills the map.
    Projection towardsCentre(Vec3 place) const;

    /// Face `face` of a cube around `place`, mm, as GL orients them.
    Projection cubeFace(Vec3 place, int face) const;

    /// Clears the target, which has a depth, and draws what the projection sees. `textures`: what the fragment stage
    /// reads.
    void draw(gl::Framebuffer& target, const Projection& projection,
              std::initializer_list<gl::TextureBinding> textures = {});

    /// For the uniforms of another fragment stage.
    gl::RasterProgram& program() { return program_; }

    /// Three numbers of vertices a triangle; x, y, z of a vertex, mm.
    const gl::Buffer& corners() const { return corners_; }
    const gl::Buffer& vertices() const { return vertices_; }

private:
    gl::RasterProgram program_;
    gl::Buffer corners_, vertices_;
    unsigned triangles_;
    double radius_;
};

}  // namespace searchlight
