#include "light/lit_points_gl.h"

#include <algorithm>

#include "base/embedded.h"
#include "gl/context.h"

namespace searchlight {

namespace {

constexpr unsigned group_size = 64;  // local_size_x

using Texel = std::array<float, 4>;

void upload(gl::Buffer& buffer, std::span<const Vec3f> vectors) {
    std::vector<Texel> texels;
    texels.reserve(vectors.size());
    for (const Vec3f& v : vectors) texels.push_back({v.x, v.y, v.z, 0});
    buffer.reserve(texels.size() * sizeof(Texel));
    buffer.upload<Texel>(texels);
}

}  // namespace

ShadowMapGl::ShadowMapGl(gl::Context& context, int side, bool cube)
    : depth(context, {.format = gl::Format::depth32f,
                      .width = side,
                      .height = side,
                      .cube = cube,
                      .linear = true,
                      .compare = true}) {
    for (int layer = 0; layer < (cube ? 6 : 1); ++layer)
        layers.push_back(
            std::make_unique<gl::Framebuffer>(context, std::initializer_list<const gl::Texture*>{}, &depth, layer));
}

LitPointsGl::LitPointsGl(gl::Context& context, const LitPoints& points, const Object& object, bool shadows)
    : context_(context), points_(points), object_(object), normals_(context), origins_(context), positions_(context) {
    upload(normals_, points.normals);
    upload(origins_, points.origins);
    upload(positions_, points.positions);
    if (shadows && !object.mesh.triangles.empty()) caster_.emplace(context, object);
}

gl::Buffer LitPointsGl::sums() const {
    return gl::Buffer(context_, std::max<std::size_t>(1, points_.size()) * sizeof(Texel));
}

ShadowMapGl& LitPointsGl::sharedMap() {
    if (!shared_) shared_.emplace(context_, shared_map, false);
    return *shared_;
}

gl::Source LitPointsGl::source(Kind kind) {
    gl::Source source;
    source.add("#version 450 core", "searchlight");
    if (kind != Kind::parallel) source.add("#define FROM_POINT", "searchlight");
    if (kind == Kind::near_point) source.add("#define CUBE_MAP", "searchlight");
    for (const std::string_view file : {"physics/fresnel.glsl", "src/light/irradiance_gl.comp.glsl"})
        source.add(embeddedText(file).value(), file);
    return source;
}

gl::Program& LitPointsGl::program(Kind kind) {
    std::optional<gl::Program>& found = programs_[static_cast<std::size_t>(kind)];
    if (!found) found.emplace(context_, source(kind));
    return *found;
}

void LitPointsGl::addDirection(ShadowMapGl& map, Vec3 wi, Rgb weight, double eta, const gl::Buffer& sums,
                               bool shadowed) {
    ShadowCasterGl::Projection projection;
    if (caster_ && shadowed) {
        projection = caster_->parallel(wi);
        caster_->draw(*map.layers.front(), projection);
    }
    dispatch(Kind::parallel, projection, map, wi, weight, eta, shadowed, sums);
}

void LitPointsGl::addPoint(Vec3 place, Rgb weight, double eta, const gl::Buffer& sums) {
    ShadowCasterGl::Projection projection;
    // From nearby the object is seen under too wide an angle for one map.
    const bool near = caster_ && length(place) < 1.5 * caster_->radius();
    ShadowMapGl map(context_, near ? cube_map : single_map, near);
    for (int face = 0; face < (near ? 6 : 1) && caster_; ++face) {
        projection = near ? caster_->cubeFace(place, face) : caster_->towardsCentre(place);
        caster_->draw(*map.layers[static_cast<std::size_t>(face)], projection);
    }
    dispatch(near ? Kind::near_point : Kind::far_point, projection, map, place, weight, eta, true, sums);
}

void LitPointsGl::dispatch(Kind kind, const ShadowCasterGl::Projection& projection, const ShadowMapGl& map,
                           Vec3 towards, Rgb weight, double eta, bool shadowed, const gl::Buffer& sums) {
    gl::Program& light = program(kind);
    light.set("axis_s", projection.axis_s);
    light.set("axis_t", projection.axis_t);
    light.set("axis_depth", projection.axis_depth);
    light.set("scale", static_cast<float>(projection.scale));
    light.set("texel", static_cast<float>(2 / (projection.scale * map.depth.width())));
    light.set("depth_factor", static_cast<float>(projection.depth_factor));
    light.set("depth_term", static_cast<float>(projection.depth_term));
    light.set("point_count", static_cast<int>(points_.size()));
    light.set("towards", towards);
    light.set("weight", weight);
    light.set("unit_mm", static_cast<float>(object_.longest_mm));
    light.set("inverse_eta", static_cast<float>(1 / eta));
    light.set("shadows", caster_ && shadowed ? 1 : 0);
    light.dispatch(static_cast<unsigned>((points_.size() + group_size - 1) / group_size),
                   {{0, normals_}, {1, origins_}, {2, positions_}, {3, sums}}, {{0, map.depth}});
}

std::vector<Rgbf> LitPointsGl::download(const gl::Buffer& sums, double factor) const {
    std::vector<Texel> texels(points_.size());
    sums.download<Texel>(texels);
    std::vector<Rgbf> values(points_.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        values[points_.order[i]] = toFloat(factor * Rgb{texels[i][0], texels[i][1], texels[i][2]});
    return values;
}

}  // namespace searchlight
