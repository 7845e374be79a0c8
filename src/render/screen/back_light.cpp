#include "render/screen/back_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "light/environment.h"
#include "light/environment_beams.h"
#include "light/light_filter.h"
#include "light/single_lights.h"
#include "light/transmitted_cosine.h"

namespace searchlight {

namespace {

constexpr std::size_t block = 256;
constexpr std::pair<std::string_view, Thickness> words[] = {{"nearest", Thickness::nearest},
                                                            {"material", Thickness::material},
                                                            {"outermost", Thickness::outermost},
                                                            {"none", Thickness::nothing}};

// A line through more walls than that is followed no further.
constexpr int most_walls = 64;

struct BackBeam {
    Vec3 place;  // towards the light, unit; of a point: where it is, mm
    bool from_point = false;
    Rgb irradiance;  // on a surface that faces it; of a point: at unit_mm
    double unit_mm = 1;
    std::shared_ptr<const LightFilter> filter;
};

class Beams {
public:
    Beams(const Scene& scene, const Object& object, const BackLightOptions& options)
        : object_(object), options_(options) {
        for (const Light& light : scene.lights) std::visit([&](const auto& kind) { add(kind); }, light);
    }

    std::vector<BackBeam> take() { return std::move(beams_); }

private:
    void add(const DirectionalLight& light) {
        std::shared_ptr<const LightFilter> filter;
        if (!light.filter.empty())
            filter = std::make_shared<const LightFilter>(light.filter, light.direction, boundingRadius(object_));
        const DiscSamples disc = discSamples(light, options_.beam_count, options_.seed);
        for (const Vec3f& wi : disc.directions)
            beams_.push_back({.place = toDouble(wi), .irradiance = disc.weight * light.irradiance, .filter = filter});
    }
    void add(const PointLight& light) {
        beams_.push_back({.place = object_.longest_mm * light.position,
                          .from_point = true,
                          .irradiance = light.intensity,
                          .unit_mm = object_.longest_mm});
    }
    void add(const EnvironmentLight& light) {
        for (const EnvironmentBeam& part : environmentBeams(Environment(light), options_.beam_count, options_.seed))
            beams_.push_back({.place = part.wi, .irradiance = part.irradiance});
    }

    const Object& object_;
    const BackLightOptions& options_;
    std::vector<BackBeam> beams_;
};

Vec3 normalAt(const Mesh& mesh, const RayHit& hit) {
    if (mesh.normals.empty()) return toDouble(hit.normal);
    const auto& [a, b, c] = mesh.triangles[hit.triangle];
    const double u = static_cast<double>(hit.u), v = static_cast<double>(hit.v);
    const Vec3 sum =
        (1 - u - v) * toDouble(mesh.normals[a]) + u * toDouble(mesh.normals[b]) + v * toDouble(mesh.normals[c]);
    return length(sum) > 0 ? normalize(sum) : toDouble(hit.normal);
}

// A line from a visible point to the light, as far as it has been followed.
struct Line {
    std::size_t sample;
    Vec3 origin, wi;  // unit
    double end = 0;   // distance to the light
    double at = 0, material = 0, entered = 0;
    std::optional<RayHit> way_out;  // the one that counts so far, at distance `out`
    double out = 0;
    bool shadowed = false;
    bool done = false;
};

class Walls {
public:
    Walls(const VisibleSurface& visible, const Object& object, const RayScene& rays, const BackLightOptions& options)
        : visible_(visible), object_(object), rays_(rays), options_(options) {}

    // The lines of samples [begin, end) that lead into the object.
    void start(const BackBeam& beam, std::size_t begin, std::size_t end) {
        lines_.clear();
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3 position = toDouble(visible_.positions[i]);
            const Vec3f outwards = visible_.geometric_normals[i];
            const Vec3 way = beam.from_point ? beam.place - position : beam.place;
            const double distance = length(way);
            if (distance == 0 || dot(toDouble(outwards), way) >= 0) continue;
            const Vec3f origin = rays_.offsetOrigin(visible_.positions[i], {-outwards.x, -outwards.y, -outwards.z});
            Line line{.sample = i, .origin = toDouble(origin), .wi = (1 / distance) * way};
            line.end = beam.from_point ? distance : std::numeric_limits<double>::infinity();
            lines_.push_back(line);
        }
    }

    // Follows them until each knows where its light came in.
    void follow() {
        for (int wall = 0; wall < most_walls; ++wall) {
            active_.clear();
            wanted_.clear();
            for (Line& line : lines_)
                if (!line.done) {
                    active_.push_back(&line);
                    wanted_.push_back({toFloat(line.origin), toFloat(line.wi), static_cast<float>(line.at),
                                       static_cast<float>(line.end)});
                }
            if (active_.empty()) return;
            hits_.resize(active_.size());
            rays_.intersect(wanted_, hits_, true);
            for (std::size_t k = 0; k < active_.size(); ++k) meet(*active_[k], hits_[k]);
        }
    }

    const std::vector<Line>& lines() const { return lines_; }

private:
    void meet(Line& line, const RayHit& hit) const {
        if (!std::isfinite(hit.t)) {
            line.done = true;
            return;
        }
        const bool leaves = dot(toDouble(hit.normal), line.wi) > 0;
        const double at = static_cast<double>(hit.t);
        // Two walls at one place are told apart by rounding alone.
        line.at = at + 1e-6 * object_.longest_mm;
        if (line.way_out && options_.thickness == Thickness::nearest) {
            line.shadowed = line.done = true;
            return;
        }
        if (!leaves) {
            line.entered = at;
            return;
        }
        line.material += at - line.entered;
        line.entered = at;
        line.way_out = hit;
        line.out = at;
    }

    const VisibleSurface& visible_;
    const Object& object_;
    const RayScene& rays_;
    const BackLightOptions& options_;
    std::vector<Line> lines_;
    std::vector<Line*> active_;
    std::vector<Ray> wanted_;
    std::vector<RayHit> hits_;
};

}  // namespace

Param thicknessOption() {
    Param param{.name = "thickness", .type = ParamType::choice, .value = std::string(words[0].first)};
    for (const auto& [word, thickness] : words) param.choices.emplace_back(word);
    param.doc =
        "how far it is to where light came in that shines through: to the nearest way out, or to the surface that the "
        "light sees, without the gaps or with them";
    return param;
}

Thickness thicknessOf(const ParamValues& options) {
    const auto& given = std::get<std::string>(options.find("thickness")->second);
    return std::ranges::find(words, given, &std::pair<std::string_view, Thickness>::first)->second;
}

std::vector<Rgbf> backLight(const VisibleSurface& visible, const Scene& scene, const Object& object,
                            const RayScene& rays, const Profile& profile, const BackLightOptions& options,
                            Observer& observer) {
    const std::size_t count = visible.positions.size();
    std::vector<Rgbf> result(count);
    if (options.thickness == Thickness::nothing) return result;
    const std::vector<BackBeam> beams = Beams(scene, object, options).take();
    const TransmittedCosine transmitted_cosine(options.eta);
    const Rgb total = profile.total();
    const double spacing_mm = object.longest_mm / std::max(visible.width, visible.height);
    parallelFor((count + block - 1) / block, options.threads, [&](std::size_t part) {
        if (observer.cancelled()) throw interruptedError();
        Walls walls(visible, object, rays, options);
        std::array<Rgb, block> sums{};
        const std::size_t begin = part * block, end = std::min(count, begin + block);
        for (const BackBeam& beam : beams) {
            walls.start(beam, begin, end);
            walls.follow();
            for (const Line& line : walls.lines()) {
                if (!line.way_out || line.shadowed) continue;
                const Vec3 entry = line.origin + line.out * line.wi;
                const Vec3 normal = normalAt(object.mesh, *line.way_out);
                const double cosine = dot(normal, line.wi);
                if (cosine <= 0) continue;
                const double way = options.thickness == Thickness::material ? line.material : line.out;
                Rgb flux = static_cast<double>(transmitted_cosine(static_cast<float>(cosine))) * beam.irradiance;
                if (beam.filter) flux = flux * (*beam.filter)(entry, spacing_mm);
                if (beam.from_point) flux = std::pow(beam.unit_mm / (line.end - line.out), 2) * flux;
                sums[line.sample - begin] = sums[line.sample - begin] + flux * (total - profile.encircled(way));
            }
        }
        for (std::size_t i = begin; i < end; ++i) result[i] = toFloat(sums[i - begin]);
    });
    return result;
}

}  // namespace searchlight
