#include "render/visible_gl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/embedded.h"
#include "base/error.h"
#include "gl/context.h"

namespace searchlight {

namespace {

gl::Source stage(std::string_view file) {
    gl::Source source;
    source.add("#version 450 core", "searchlight");
    source.add(embeddedText(file).value(), file);
    return source;
}

using Triangles = std::vector<std::uint32_t>;

// Where rays meet the triangles that a rasteriser found for them.
class RasterHits final : public PictureHits {
public:
    RasterHits(const View& view, const Mesh& mesh, Triangles centres, std::vector<Triangles> samples)
        : view_(view), mesh_(mesh), centres_(std::move(centres)), samples_(std::move(samples)) {}

    RayHit hit(int x, int y, int sample, const Ray& ray) const override {
        const Triangles& seen = sample < 0 ? centres_ : samples_[static_cast<std::size_t>(sample)];
        const std::uint32_t number = seen[static_cast<std::size_t>(y) * view_.width + x];
        RayHit hit{.t = std::numeric_limits<float>::infinity()};
        if (number == 0) return hit;
        const auto& corners = mesh_.triangles[number - 1];
        const Vec3 p0 = toDouble(mesh_.positions[corners[0]]);
        const Vec3 e1 = toDouble(mesh_.positions[corners[1]]) - p0, e2 = toDouble(mesh_.positions[corners[2]]) - p0;
        const Vec3 normal = cross(e1, e2), direction = toDouble(ray.direction), from = toDouble(ray.origin) - p0;
        const double det = -dot(direction, normal);
        if (det == 0 || !(length(normal) > 0)) return hit;
        const Vec3 side = cross(from, direction);
        // A fragment at an edge may lie outside by the rasteriser's rounding.
        double u = std::clamp(dot(e2, side) / det, 0.0, 1.0), v = std::clamp(-dot(e1, side) / det, 0.0, 1.0);
        if (const double sum = u + v; sum > 1) u /= sum, v /= sum;
        hit.t = static_cast<float>(dot(p0 + u * e1 + v * e2 - toDouble(ray.origin), view_.forward));
        hit.triangle = number - 1;
        hit.u = static_cast<float>(u);
        hit.v = static_cast<float>(v);
        hit.normal = toFloat(normalize(normal));
        return hit;
    }

private:
    const View& view_;
    const Mesh& mesh_;
    Triangles centres_;
    std::vector<Triangles> samples_;
};

}  // namespace

VisibleGl::VisibleGl(gl::Context& context, const Object& object)
    : context_(context),
      object_(object),
      program_(context, stage("src/light/shadow_gl.vert.glsl"), stage("src/render/visible_gl.frag.glsl")),
      corners_(context, sizeof(object.mesh.triangles[0]) * object.mesh.triangles.size()),
      vertices_(context, sizeof(Vec3f) * object.mesh.positions.size()) {
    corners_.upload<std::array<std::uint32_t, 3>>(object.mesh.triangles);
    vertices_.upload<Vec3f>(object.mesh.positions);
}

VisibleSurface VisibleGl::visible(const View& view, const TraceOptions& options, Observer& observer) {
    std::vector<Triangles> samples;
    if (options.edge_samples > 1)
        for (const auto& [x, y] : edgePattern(options.edge_samples)) {
            if (observer.cancelled()) throw interruptedError();
            samples.push_back(triangles(view, x, y));
        }
    const RasterHits hits(view, object_.mesh, triangles(view, 0.5, 0.5), std::move(samples));
    return visibleSurface(view, object_, hits, options, observer);
}

std::vector<std::uint32_t> VisibleGl::triangles(const View& view, double x, double y) {
    const gl::Texture seen(context_, {.format = gl::Format::r32ui, .width = view.width, .height = view.height});
    const gl::Texture depth(context_, {.format = gl::Format::depth32f, .width = view.width, .height = view.height});
    gl::Framebuffer target(context_, {&seen}, &depth);
    target.clear();
    // Everything between a thousandth of the object before the eye, or its bounding sphere, and the sphere's far end.
    const double radius = length(object_.half_extent), distance = length(view.eye);
    const double near = std::max(1e-3 * radius, distance - 1.01 * radius), far = distance + 1.01 * radius;
    // The rasteriser looks at the centres of pixels, so the picture is moved instead.
    const Vec3 right = (view.height / (view.tan_half * view.width)) * view.right;
    const Vec3 down = (-1 / view.tan_half) * view.up;
    program_.set("origin", view.eye);
    program_.set("axis_s", right + (2 * (0.5 - x) / view.width) * view.forward);
    program_.set("axis_t", down + (2 * (0.5 - y) / view.height) * view.forward);
    program_.set("axis_depth", view.forward);
    program_.set("scale", 1.0f);
    program_.set("depth_factor", static_cast<float>(far / (far - near)));
    program_.set("depth_term", static_cast<float>(-near * far / (far - near)));
    program_.set("from_point", 1);
    program_.draw(target, {.triangles = static_cast<unsigned>(object_.mesh.triangles.size())},
                  {{0, corners_}, {1, vertices_}});
    std::vector<std::uint32_t> numbers(static_cast<std::size_t>(view.width) * view.height);
    seen.download<std::uint32_t>(numbers);
    return numbers;
}

}  // namespace searchlight
