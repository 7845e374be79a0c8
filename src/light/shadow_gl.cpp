#include "light/shadow_gl.h"

#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include "base/embedded.h"

namespace searchlight {

namespace {

gl::Source stage(std::string_view file) {
    gl::Source source;
    source.add("#version 450 core", "searchlight");
    source.add(embeddedText(file).value(), file);
    return source;
}

// s, t and depth of the faces +x, -x, +y, -y, +z, -z: table 8.19 of the OpenGL 4.5 specification.
constexpr std::array<std::array<Vec3, 3>, 6> faces{{{{{0, 0, -1}, {0, -1, 0}, {1, 0, 0}}},
                                                    {{{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}}},
                                                    {{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}}},
                                                    {{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}},
                                                    {{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}},
                                                    {{{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}}}};

// So that nothing lies on the edge of a map or at its end.
constexpr double room = 1.01;

// Two axes of a map for light from `wi`.
std::pair<Vec3, Vec3> across(Vec3 wi) {
    const Vec3 s = normalize(cross(std::abs(wi.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}, wi));
    return {s, cross(wi, s)};
}

}  // namespace

ShadowCasterGl::ShadowCasterGl(gl::Context& context, const Object& object, std::string_view fragment)
    : program_(context, stage("src/light/shadow_gl.vert.glsl"), stage(fragment)),
      corners_(context, sizeof(object.mesh.triangles[0]) * object.mesh.triangles.size()),
      vertices_(context, sizeof(Vec3f) * object.mesh.positions.size()),
      triangles_(static_cast<unsigned>(object.mesh.triangles.size())),
      radius_(length(object.half_extent)) {
    corners_.upload<std::array<std::uint32_t, 3>>(object.mesh.triangles);
    vertices_.upload<Vec3f>(object.mesh.positions);
}

ShadowCasterGl::Projection ShadowCasterGl::parallel(Vec3 wi) const {
    const auto [s, t] = across(wi);
    const double reach = room * radius_;
    return {{}, s, t, -1 * wi, 1 / reach, 0.5 / reach, 0.5, false};
}

ShadowCasterGl::Projection ShadowCasterGl::towardsCentre(Vec3 place) const {
    const double distance = length(place), reach = room * radius_;
    assert(distance > reach);
    const Vec3 wi = (1 / distance) * place;
    const auto [s, t] = across(wi);
    const double near = distance - reach, far = distance + reach;
    // Tangent of the angle under which the sphere is seen.
    const double tangent = reach / std::sqrt(near * far);
    return {place, s, t, -1 * wi, 1 / tangent, far / (far - near), -near * far / (far - near), true};
}

ShadowCasterGl::Projection ShadowCasterGl::cubeFace(Vec3 place, int face) const {
    const auto& [s, t, depth] = faces[static_cast<std::size_t>(face)];
    const double far = length(place) + room * radius_, near = 1e-3 * radius_;
    return {place, s, t, depth, 1, far / (far - near), -near * far / (far - near), true};
}

void ShadowCasterGl::draw(gl::Framebuffer& target, const Projection& projection,
                          std::initializer_list<gl::TextureBinding> textures) {
    target.clear();
    program_.set("origin", projection.origin);
    program_.set("axis_s", projection.axis_s);
    program_.set("axis_t", projection.axis_t);
    program_.set("axis_depth", projection.axis_depth);
    program_.set("scale", static_cast<float>(projection.scale));
    program_.set("depth_factor", static_cast<float>(projection.depth_factor));
    program_.set("depth_term", static_cast<float>(projection.depth_term));
    program_.set("from_point", projection.from_point ? 1 : 0);
    program_.draw(target, {.triangles = triangles_}, {{0, corners_}, {1, vertices_}}, textures);
}

}  // namespace searchlight
