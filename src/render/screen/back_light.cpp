#include "render/screen/back_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "render/screen/back_beams.h"

namespace searchlight {

namespace {

constexpr std::size_t block = 256;
constexpr std::pair<std::string_view, Thickness> words[] = {{"nearest", Thickness::nearest},
                                                            {"material", Thickness::material},
                                                            {"outermost", Thickness::outermost},
                                                            {"none", Thickness::nothing}};

// A line through more walls than that is followed no further.
constexpr int most_walls = 64;

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
    const std::vector<BackBeam> beams = backBeams(scene, object, options);
    const LightThrough through(object, profile, options.eta,
                               object.longest_mm / std::max(visible.width, visible.height));
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
                Rgb& sum = sums[line.sample - begin];
                sum = sum + through(beam, {.from = line.origin,
                                           .wi = line.wi,
                                           .out = line.out,
                                           .way = options.thickness == Thickness::material ? line.material : line.out,
                                           .behind = line.end - line.out,
                                           .triangle = line.way_out->triangle});
            }
        }
        for (std::size_t i = begin; i < end; ++i) result[i] = toFloat(sums[i - begin]);
    });
    return result;
}

}  // namespace searchlight
