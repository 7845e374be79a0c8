#include "render/screen/back_light_gl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <string>

#include "base/embedded.h"
#include "base/error.h"
#include "base/parallel.h"
#include "gl/context.h"
#include "gl/program.h"
#include "light/lit_points_gl.h"
#include "light/shadow_gl.h"
#include "render/screen/back_beams.h"

namespace searchlight {

namespace {

using Texel = std::array<float, 4>;
using Way = std::array<std::uint32_t, 4>;  // as in the program

constexpr unsigned group_size = 64;       // local_size_x
constexpr std::size_t slice = 1024 * 64;  // lines in one dispatch
constexpr std::size_t grain = 4096;
constexpr int most_layers = 64;

gl::Source linesSource() {
    constexpr std::string_view file = "src/render/screen/back_light_gl.comp.glsl";
    gl::Source source;
    source.add("#version 450 core", "searchlight");
    source.add(embeddedText(file).value(), file);
    return source;
}

// A map of `side` texels in which layers follow each other: each is drawn by what the one before shows.
struct Layers {
    gl::Texture walls, depth;
    std::array<gl::Texture, 2> depths;
    std::array<gl::Framebuffer, 2> targets;

    Layers(gl::Context& context, int side)
        : walls(context, {.format = gl::Format::r32ui, .width = side, .height = side}),
          depth(context, {.format = gl::Format::depth32f, .width = side, .height = side}),
          depths{gl::Texture(context, {.format = gl::Format::r32f, .width = side, .height = side}),
                 gl::Texture(context, {.format = gl::Format::r32f, .width = side, .height = side})},
          targets{gl::Framebuffer(context, {&walls, &depths[0]}, &depth),
                  gl::Framebuffer(context, {&walls, &depths[1]}, &depth)} {}
};

}  // namespace

struct BackLightGl::Device {
    gl::Context& context;
    gl::Program lines;
    gl::Buffer places, outwards, ways, going;
    std::optional<ShadowCasterGl> caster;
    std::string drawn;  // content_hash of what the caster holds
    std::optional<Layers> layers;

    explicit Device(gl::Context& context_)
        : context(context_),
          lines(context_, linesSource()),
          places(context_),
          outwards(context_),
          ways(context_),
          going(context_, sizeof(std::uint32_t)) {}

    void setObject(const Object& object) {
        if (caster && drawn == object.content_hash && !drawn.empty()) return;
        caster.emplace(context, object, "src/render/screen/back_light_gl.frag.glsl");
        drawn = object.content_hash;
    }

    void setLines(const VisibleSurface& visible) {
        const auto put = [&](gl::Buffer& buffer, const std::vector<Vec3f>& vectors) {
            std::vector<Texel> texels;
            texels.reserve(vectors.size());
            for (const Vec3f& v : vectors) texels.push_back({v.x, v.y, v.z, 0});
            buffer.reserve(texels.size() * sizeof(Texel));
            buffer.upload<Texel>(texels);
        };
        put(places, visible.positions);
        put(outwards, visible.geometric_normals);
    }

    // Per line what is known when all its walls have been seen, or those that it needs.
    std::vector<Way> follow(const BackBeam& beam, std::size_t count, Thickness thickness, int side,
                            Observer& observer) {
        std::vector<Way> found(count);
        ways.reserve(count * sizeof(Way));
        ways.upload<Way>(found);
        lines.set("nearest", thickness == Thickness::nearest ? 1 : 0);
        // A second way out puts the nearest one into shadow; the light sees the farthest one first.
        lines.set("most", thickness == Thickness::nearest ? 2 : thickness == Thickness::outermost ? 1 : most_layers);
        lines.set("from_point", beam.from_point ? 1 : 0);
        lines.set("towards", beam.place);
        // From nearby the object is seen under too wide an angle for one map.
        const bool near = beam.from_point && length(beam.place) < 1.5 * caster->radius();
        if (near) side = LitPointsGl::cube_map;
        if (!layers || layers->walls.width() != side) layers.emplace(context, side);
        for (int face = 0; face < (near ? 6 : 1); ++face)
            peel(near              ? caster->cubeFace(beam.place, face)
                 : beam.from_point ? caster->towardsCentre(beam.place)
                                   : caster->parallel(beam.place),
                 count, observer);
        ways.download<Way>(found);
        return found;
    }

private:
    void peel(const ShadowCasterGl::Projection& projection, std::size_t count, Observer& observer) {
        lines.set("origin", projection.origin);
        lines.set("axis_s", projection.axis_s);
        lines.set("axis_t", projection.axis_t);
        lines.set("axis_depth", projection.axis_depth);
        lines.set("scale", static_cast<float>(projection.scale));
        lines.set("depth_factor", static_cast<float>(projection.depth_factor));
        lines.set("depth_term", static_cast<float>(projection.depth_term));
        for (int layer = 0; layer < most_layers; ++layer) {
            if (observer.cancelled()) throw interruptedError();
            const auto to = static_cast<std::size_t>(layer % 2);
            caster->program().set("first", layer == 0 ? 1 : 0);
            caster->draw(layers->targets[to], projection, {{0, layers->depths[1 - to]}});
            std::array<std::uint32_t, 1> more{0};
            going.upload<std::uint32_t>(more);
            for (std::size_t first = 0; first < count; first += slice) {
                const std::size_t end = std::min(count, first + slice);
                lines.set("first", static_cast<int>(first));
                lines.set("end", static_cast<int>(end));
                lines.dispatch(static_cast<unsigned>((end - first + group_size - 1) / group_size),
                               {{0, places},
                                {1, outwards},
                                {2, ways},
                                {3, caster->corners()},
                                {4, caster->vertices()},
                                {5, going}},
                               {{0, layers->walls}, {1, layers->depths[to]}});
            }
            going.download<std::uint32_t>(more);
            if (more[0] == 0) return;
        }
    }
};

BackLightGl::BackLightGl(gl::Context& context) : context_(context) {}
BackLightGl::~BackLightGl() = default;

std::vector<Rgbf> BackLightGl::operator()(const VisibleSurface& visible, const Scene& scene, const Object& object,
                                          const Profile& profile, const BackLightOptions& options, Observer& observer) {
    const std::size_t count = visible.positions.size();
    std::vector<Rgbf> result(count);
    if (options.thickness == Thickness::nothing || count == 0 || object.mesh.triangles.empty()) return result;
    const std::vector<BackBeam> beams = backBeams(scene, object, options);
    if (beams.empty()) return result;
    if (!device_) device_ = std::make_unique<Device>(context_);
    device_->setObject(object);
    device_->setLines(visible);
    const LightThrough through(object, profile, options.eta,
                               object.longest_mm / std::max(visible.width, visible.height));
    // Of many beams each has little to say.
    const int side = beams.size() > 4 ? LitPointsGl::shared_map : LitPointsGl::single_map;
    std::vector<Rgb> sums(count);
    for (const BackBeam& beam : beams) {
        const std::vector<Way> ways = device_->follow(beam, count, options.thickness, side, observer);
        parallelFor((count + grain - 1) / grain, options.threads, [&](std::size_t part) {
            for (std::size_t i = part * grain; i < std::min(count, (part + 1) * grain); ++i) {
                const auto& [out, material, ways_out, wall] = ways[i];
                if (ways_out == 0 || (options.thickness == Thickness::nearest && ways_out > 1)) continue;
                WayOut line{.from = toDouble(visible.positions[i]),
                            .wi = beam.place,
                            .out = static_cast<double>(std::bit_cast<float>(out)),
                            .triangle = wall - 1};
                if (beam.from_point) {
                    const Vec3 to_light = beam.place - line.from;
                    line.wi = normalize(to_light);
                    line.behind = length(to_light) - line.out;
                }
                line.way = options.thickness == Thickness::material
                               ? std::max(0.0, static_cast<double>(std::bit_cast<float>(material)))
                               : line.out;
                sums[i] = sums[i] + through(beam, line);
            }
        });
    }
    std::ranges::transform(sums, result.begin(), [](const Rgb& sum) { return toFloat(sum); });
    return result;
}

}  // namespace searchlight
