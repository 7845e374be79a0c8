#include "transport/mesh/lit_walk.h"

#include <algorithm>
#include <cmath>

#include "model/physics.h"
#include "transport/walk/fresnel.h"
#include "transport/walk/henyey_greenstein.h"

namespace searchlight {

namespace {

// From one collision, or the surface, to the next collision.
struct Flight {
    Vec3f from, end;
    Vec3 direction;
    double length_mm = 0;
};

// Radiance that a collision scatters towards where a walk came from.
template <class Body>
class MatchedLights {
public:
    MatchedLights(const Body& body, const BodyMedium& medium, const LightSampler& lights, int channel)
        : body_(body), medium_(medium), lights_(lights), channel_(channel) {}

    // From one light and direction of all.
    double at(const Flight& flight, SplitMix64& random, std::uint64_t& rays) const {
        const Vec3 position = toDouble(flight.end);
        const double u_light = random.uniform(), u = random.uniform(), v = random.uniform();
        const LightSample light = lights_.sample(position, u_light, u, v);
        const double irradiance = light.irradiance_over_pdf[channel_];
        if (irradiance == 0) return 0;
        const std::optional<double> out = body_.wayOut(position, light.wi, light.distance);
        ++rays;
        if (!out) return 0;
        return irradiance * std::exp(-medium_.sigma_t * *out) *
               Physics<double>::henyeyGreenstein(dot(flight.direction, light.wi), medium_.g);
    }
    double along(Vec3f, Vec3, SplitMix64&) const { return 0; }
    bool collects(bool scatters) const { return !scatters; }

private:
    const Body& body_;
    const BodyMedium& medium_;
    const LightSampler& lights_;
    int channel_;
};

class SphereLights {
public:
    explicit SphereLights(const SphereBeams& beams) : beams_(beams) {}

    double at(const Flight& flight, SplitMix64& random, std::uint64_t&) const {
        return beams_.atCollision(flight.from, flight.direction, flight.length_mm, random);
    }
    double along(Vec3f from, Vec3 direction, SplitMix64& random) const {
        return beams_.alongFlight(from, direction, random);
    }
    bool collects(bool) const { return true; }

private:
    const SphereBeams& beams_;
};

// Whether a flight surely stays inside, so that no ray is asked.
bool staysInside(const Ball& ball, Vec3f, Vec3f to) {
    return length(toDouble(to)) < ball.radius() * (1 - 1e-6);  // convex, and float
}
bool staysInside(const MeshBody& mesh, Vec3f from, Vec3f to) { return mesh.regions().safe(from, to); }

template <class Body, class Lights>
class LitWalker {
public:
    LitWalker(const Body& body, const BodyMedium& medium, const Lights& lights, CameraSource<Body>& source,
              SplitMix64 random)
        : body_(body), medium_(medium), lights_(lights), source_(source), random_(random) {}

    BodyChunk run() {
        for (Entry entry; source_.next(entry);) walk(entry);
        return std::move(chunk_);
    }

private:
    void walk(const Entry& entry) {
        Vec3f position = entry.position;
        Vec3 direction = toDouble(entry.direction);
        double collected = 0;
        for (bool scatters = false;;) {
            collected += lights_.along(position, direction, random_);
            const double length = -std::log(random_.uniform()) / medium_.sigma_t;
            const Vec3f end = toFloat(toDouble(position) + length * direction);
            const Crossing crossing = cross(position, end);
            if (crossing.what == Crossing::What::lost) {
                ++chunk_.lost;
                break;
            }
            if (crossing.what == Crossing::What::surface) {
                const double cosine = std::clamp(dot(direction, crossing.normal), 0.0, 1.0);
                if (medium_.eta != 1 && random_.uniform() < internalReflectance(medium_.eta, cosine)) {
                    position = crossing.inside;
                    direction = normalize(direction - 2 * cosine * crossing.normal);
                    continue;
                }
                if (lights_.collects(scatters)) {
                    left_.clear();
                    source_.leave(entry.tag, 1, direction, crossing, left_);
                    for (const CellExit& exit : left_) collected += static_cast<double>(exit.weight);
                }
                break;
            }
            ++chunk_.collisions;
            if (random_.uniform() < medium_.absorbed) break;
            collected += lights_.at({position, end, direction, length}, random_, chunk_.rays);
            position = end;
            direction = scatteredDirection(direction, medium_.g, random_);
            scatters = true;
        }
        // One exit for all: the error is that of walks, and what one of them finds in two ways is not independent.
        if (collected > 0) chunk_.cells.push_back({entry.tag, static_cast<float>(collected) * entry.weight});
    }

    Crossing cross(Vec3f position, Vec3f end) {
        Crossing crossing;
        if (staysInside(body_, position, end)) return crossing;
        const Ray flight{position, {end.x - position.x, end.y - position.y, end.z - position.z}, 0, 1};
        body_.cross({&flight, 1}, {&crossing, 1});
        ++chunk_.rays;
        return crossing;
    }

    const Body& body_;
    BodyMedium medium_;
    Lights lights_;
    CameraSource<Body>& source_;
    SplitMix64 random_;
    BodyChunk chunk_;
    std::vector<CellExit> left_;
};

template <class Body>
BodyChunk walkMatched(const Body& body, const BodyMedium& medium, const LightSampler& lights, int channel,
                      CameraSource<Body>& source, SplitMix64 random) {
    const MatchedLights<Body> asked(body, medium, lights, channel);
    return LitWalker<Body, MatchedLights<Body>>(body, medium, asked, source, random).run();
}

}  // namespace

BodyChunk walkMatchedChunk(const Ball& ball, const BodyMedium& medium, const LightSampler& lights, int channel,
                           CameraSource<Ball>& source, SplitMix64 random) {
    return walkMatched(ball, medium, lights, channel, source, random);
}

BodyChunk walkMatchedChunk(const MeshBody& mesh, const BodyMedium& medium, const LightSampler& lights, int channel,
                           CameraSource<MeshBody>& source, SplitMix64 random) {
    return walkMatched(mesh, medium, lights, channel, source, random);
}

BodyChunk walkBeamsChunk(const Ball& ball, const BodyMedium& medium, const SphereBeams& beams,
                         CameraSource<Ball>& source, SplitMix64 random) {
    return LitWalker<Ball, SphereLights>(ball, medium, SphereLights(beams), source, random).run();
}

}  // namespace searchlight
