#include "light/irradiance_gl.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>

#include "base/embedded.h"
#include "base/error.h"
#include "base/parallel.h"
#include "gl/context.h"
#include "gl/program.h"
#include "light/environment.h"
#include "light/environment_irradiance.h"
#include "light/light_filter.h"
#include "light/shadow_gl.h"
#include "light/single_lights.h"
#include "light/stratified.h"

namespace searchlight {

namespace {

constexpr int single_map = 2048, cube_map = 1024, shared_map = 512;  // texels a side
constexpr unsigned group_size = 64;                                  // local_size_x

using Texel = std::array<float, 4>;

// Where light comes from, and what its shadow map looks like.
enum class Kind { parallel, far_point, near_point };

gl::Source lightSource(Kind kind) {
    gl::Source source;
    source.add("#version 450 core", "searchlight");
    if (kind != Kind::parallel) source.add("#define FROM_POINT", "searchlight");
    if (kind == Kind::near_point) source.add("#define CUBE_MAP", "searchlight");
    for (const std::string_view file : {"physics/fresnel.glsl", "src/light/irradiance_gl.comp.glsl"})
        source.add(embeddedText(file).value(), file);
    return source;
}

void add(Rgbf& sum, const Rgbf& value) { sum = {sum.r + value.r, sum.g + value.g, sum.b + value.b}; }

void upload(gl::Buffer& buffer, std::span<const Vec3f> vectors) {
    std::vector<Texel> texels;
    texels.reserve(vectors.size());
    for (const Vec3f& v : vectors) texels.push_back({v.x, v.y, v.z, 0});
    buffer.reserve(texels.size() * sizeof(Texel));
    buffer.upload<Texel>(texels);
}

// A depth map and the way to draw into it.
struct Map {
    gl::Texture depth;
    std::vector<std::unique_ptr<gl::Framebuffer>> layers;

    Map(gl::Context& context, int side, bool cube)
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
};

// An environment that the object shadows, by the sum of what the light samples so far gave.
struct Occluded {
    std::unique_ptr<const Environment> environment;
    StratifiedSequence sequence;
    std::unique_ptr<gl::Buffer> sums;
    int samples = 0;
};

}  // namespace

struct ProgressiveIrradianceGl::Impl {
    gl::Context& context;
    const LitPoints& points;
    const Object& object;
    IrradianceOptions options;
    std::array<std::optional<gl::Program>, 3> programs;  // by Kind, made when needed
    gl::Buffer normals, origins, positions;
    std::optional<ShadowCasterGl> caster;  // none: nothing casts shadows
    std::optional<Map> shared;             // of the directions of discs and environments
    Irradiance fixed;                      // all but occluded environments
    std::vector<Occluded> occluded;

    Impl(gl::Context& context_, const LitPoints& points_, const Object& object_, bool shadows,
         const IrradianceOptions& options_)
        : context(context_),
          points(points_),
          object(object_),
          options(options_),
          normals(context_),
          origins(context_),
          positions(context_) {
        upload(normals, points.normals);
        upload(origins, points.origins);
        upload(positions, points.positions);
        if (shadows && !object.mesh.triangles.empty()) caster.emplace(context, object);
        fixed.transmitted.resize(points.size());
    }

    std::size_t sumBytes() const { return std::max<std::size_t>(1, points.size()) * sizeof(Texel); }

    gl::Program& program(Kind kind) {
        std::optional<gl::Program>& found = programs[static_cast<std::size_t>(kind)];
        if (!found) found.emplace(context, lightSource(kind));
        return *found;
    }

    // Draws the map anew and adds to `sums`. `weight`: irradiance on a surface that faces the light.
    void addDirection(Map& map, Vec3 wi, Rgb weight, const gl::Buffer& sums) {
        ShadowCasterGl::Projection projection;
        if (caster) {
            projection = caster->parallel(wi);
            caster->draw(*map.layers.front(), projection);
        }
        dispatch(Kind::parallel, projection, map, wi, weight, sums);
    }

    // The same from a point; `weight` at the distance of the object's longest side.
    void addPoint(Vec3 place, Rgb weight, const gl::Buffer& sums) {
        ShadowCasterGl::Projection projection;
        // From nearby the object is seen under too wide an angle for one map.
        const bool near = caster && length(place) < 1.5 * caster->radius();
        Map map(context, near ? cube_map : single_map, near);
        for (int face = 0; face < (near ? 6 : 1) && caster; ++face) {
            projection = near ? caster->cubeFace(place, face) : caster->towardsCentre(place);
            caster->draw(*map.layers[static_cast<std::size_t>(face)], projection);
        }
        dispatch(near ? Kind::near_point : Kind::far_point, projection, map, place, weight, sums);
    }

    void dispatch(Kind kind, const ShadowCasterGl::Projection& projection, const Map& map, Vec3 towards, Rgb weight,
                  const gl::Buffer& sums) {
        gl::Program& light = program(kind);
        light.set("axis_s", projection.axis_s);
        light.set("axis_t", projection.axis_t);
        light.set("axis_depth", projection.axis_depth);
        light.set("scale", static_cast<float>(projection.scale));
        light.set("texel", static_cast<float>(2 / (projection.scale * map.depth.width())));
        light.set("depth_factor", static_cast<float>(projection.depth_factor));
        light.set("depth_term", static_cast<float>(projection.depth_term));
        light.set("point_count", static_cast<int>(points.size()));
        light.set("towards", towards);
        light.set("weight", weight);
        light.set("unit_mm", static_cast<float>(object.longest_mm));
        light.set("inverse_eta", static_cast<float>(1 / options.eta));
        light.set("shadows", caster ? 1 : 0);
        light.dispatch(static_cast<unsigned>((points.size() + group_size - 1) / group_size),
                       {{0, normals}, {1, origins}, {2, positions}, {3, sums}}, {{0, map.depth}});
    }

    // In the caller's order.
    std::vector<Rgbf> download(const gl::Buffer& sums, double factor) const {
        std::vector<Texel> texels(points.size());
        sums.download<Texel>(texels);
        std::vector<Rgbf> values(points.size());
        for (std::size_t i = 0; i < values.size(); ++i)
            values[points.order[i]] = toFloat(factor * Rgb{texels[i][0], texels[i][1], texels[i][2]});
        return values;
    }

    void addBeam(Beam beam) {
        for (std::size_t i = 0; i < points.size(); ++i) add(fixed.transmitted[i], beam.flux[i]);
        if (options.beams) fixed.beams.push_back(std::move(beam));
    }

    Map& sharedMap() {
        if (!shared) shared.emplace(context, shared_map, false);
        return *shared;
    }

    void addLight(const DirectionalLight& light, Observer& observer) {
        const DiscSamples disc = discSamples(light, options.disc_samples, options.seed);
        const gl::Buffer sums(context, sumBytes());
        std::optional<Map> own;
        if (disc.directions.size() == 1) own.emplace(context, single_map, false);
        for (const Vec3f& wi : disc.directions) {
            if (observer.cancelled()) throw interruptedError();
            addDirection(own ? *own : sharedMap(), toDouble(wi), disc.weight * light.irradiance, sums);
        }
        Beam beam{{toFloat(normalize(light.direction))}, download(sums, 1)};
        if (!light.filter.empty()) {
            const LightFilter filter(light.filter, light.direction, boundingRadius(object));
            parallelFor(points.size(), options.threads, [&](std::size_t i) {
                Rgbf& flux = beam.flux[points.order[i]];
                flux = toFloat(toDouble(flux) * filter(toDouble(points.positions[i]), points.spacing_mm));
            });
        }
        addBeam(std::move(beam));
    }

    void addLight(const PointLight& light, Observer&) {
        const Vec3 place = object.longest_mm * light.position;
        const gl::Buffer sums(context, sumBytes());
        addPoint(place, light.intensity, sums);
        Beam beam{std::vector<Vec3f>(options.beams ? points.size() : 0), download(sums, 1)};
        for (std::size_t i = 0; i < beam.wi.size(); ++i) {
            const Vec3 to_light = place - toDouble(points.positions[i]);
            if (length(to_light) > 0) beam.wi[points.order[i]] = toFloat(normalize(to_light));
        }
        addBeam(std::move(beam));
    }

    void addLight(const EnvironmentLight& light, Observer& observer) {
        if (options.beams)
            throw usageError("an environment is not cut into beams on OpenGL",
                             "use the CPU for models that read directions");
        auto environment = std::make_unique<const Environment>(light);
        if (observer.cancelled()) throw interruptedError();
        if (light.occlusion && caster) {
            occluded.push_back({std::move(environment), StratifiedSequence(options.seed + occluded.size()),
                                std::make_unique<gl::Buffer>(context, sumBytes())});
            return;
        }
        const EnvironmentIrradiance by_normal(*environment, options.eta, options.threads);
        parallelFor(points.size(), options.threads,
                    [&](std::size_t i) { add(fixed.transmitted[points.order[i]], by_normal(points.normals[i])); });
    }
};

ProgressiveIrradianceGl::ProgressiveIrradianceGl(gl::Context& context, const LitPoints& points, const Scene& scene,
                                                 const Object& object, bool shadows, const IrradianceOptions& options,
                                                 Observer& observer)
    : impl_(new Impl(context, points, object, shadows, options)) {
    assert(options.light_samples >= 1 && options.disc_samples >= 1);
    for (const Light& light : scene.lights)
        std::visit([&](const auto& kind) { impl_->addLight(kind, observer); }, light);
}

ProgressiveIrradianceGl::~ProgressiveIrradianceGl() = default;
ProgressiveIrradianceGl::ProgressiveIrradianceGl(ProgressiveIrradianceGl&&) noexcept = default;
ProgressiveIrradianceGl& ProgressiveIrradianceGl::operator=(ProgressiveIrradianceGl&&) noexcept = default;

int ProgressiveIrradianceGl::samples() const { return impl_->occluded.empty() ? 0 : impl_->occluded.front().samples; }

bool ProgressiveIrradianceGl::complete() const {
    return impl_->occluded.empty() || samples() >= impl_->options.light_samples;
}

void ProgressiveIrradianceGl::step(int count, Observer& observer) {
    for (int i = 0; i < count; ++i) {
        if (observer.cancelled()) throw interruptedError();
        for (Occluded& light : impl_->occluded) {
            const auto [u, v] = light.sequence(static_cast<std::uint32_t>(light.samples));
            const EnvironmentSample chosen = light.environment->sample(u, v);
            if (chosen.pdf > 0)
                impl_->addDirection(impl_->sharedMap(), chosen.wi, (1 / chosen.pdf) * chosen.radiance, *light.sums);
            ++light.samples;
        }
    }
    observer.progress("irradiance", static_cast<std::uint64_t>(samples()),
                      static_cast<std::uint64_t>(impl_->options.light_samples), "light samples");
}

Irradiance ProgressiveIrradianceGl::result() const {
    Irradiance result = impl_->fixed;
    for (const Occluded& light : impl_->occluded) {
        if (light.samples == 0) continue;
        const std::vector<Rgbf> flux = impl_->download(*light.sums, 1.0 / light.samples);
        for (std::size_t i = 0; i < flux.size(); ++i) add(result.transmitted[i], flux[i]);
    }
    return result;
}

Irradiance computeIrradianceGl(gl::Context& context, const LitPoints& points, const Scene& scene, const Object& object,
                               bool shadows, const IrradianceOptions& options, Observer& observer) {
    ProgressiveIrradianceGl irradiance(context, points, scene, object, shadows, options, observer);
    while (!irradiance.complete())
        irradiance.step(std::min(64, options.light_samples - irradiance.samples()), observer);
    return irradiance.result();
}

}  // namespace searchlight
