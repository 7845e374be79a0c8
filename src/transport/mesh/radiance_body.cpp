#include "transport/mesh/radiance_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/parallel.h"
#include "model/physics.h"
#include "transport/mesh/body_walk.h"
#include "transport/walk/chunks.h"

namespace searchlight {

namespace {

constexpr std::uint64_t kLargestChunk = 65'536;
constexpr std::uint64_t kFewestChunks = 64;
constexpr double kMostLost = 1e-4;  // of all walks, as in reference_body.cpp

// Sums of a job; after the counts the values of each pixel, and their squares.
enum Sum { lost, rays, pixels };

// By inversion [HenyeyGreenstein1941].
Vec3 scattered(Vec3 d, double g, SplitMix64& random) {
    const double s = 2 * random.uniform() - 1, turn = 2 * std::numbers::pi * random.uniform();
    const double q = (1 - g * g) / (1 + g * s), c = std::abs(g) < 1e-6 ? s : (1 + g * g - q * q) / (2 * g);
    const double ring = std::sqrt(std::max(0.0, (1 - c) * (1 + c)));
    // Frame of [Duff2017].
    const double sign = std::copysign(1.0, d.z), k = -1 / (sign + d.z), xy = d.x * d.y * k;
    const Vec3 tangent{1 + sign * d.x * d.x * k, sign * xy, -sign * d.x}, bitangent{xy, sign + d.y * d.y * k, -d.y};
    return normalize(ring * std::cos(turn) * tangent + ring * std::sin(turn) * bitangent + c * d);
}

// At eta 1 light reaches a collision along straight lines: each asks for it. Only walks that pass unscattered collect
// it where they leave.
template <class Body>
class MatchedWalker {
public:
    MatchedWalker(const Body& body, const BodyMedium& medium, const LightSampler& lights, int channel,
                  CameraSource<Body>& source, SplitMix64 random)
        : body_(body), medium_(medium), lights_(lights), channel_(channel), source_(source), random_(random) {}

    BodyChunk run() {
        for (Entry entry; source_.next(entry);) walk(entry);
        return std::move(chunk_);
    }

private:
    void walk(const Entry& entry) {
        Vec3f position = entry.position;
        Vec3 direction = toDouble(entry.direction);
        double collected = 0;
        for (bool scatters = false;; scatters = true) {
            const double length = -std::log(random_.uniform()) / medium_.sigma_t;
            const Vec3f end = toFloat(toDouble(position) + length * direction);
            const Ray flight{position, {end.x - position.x, end.y - position.y, end.z - position.z}, 0, 1};
            Crossing crossing;
            body_.cross({&flight, 1}, {&crossing, 1});
            ++chunk_.rays;
            if (crossing.what == Crossing::What::lost) ++chunk_.lost;
            if (crossing.what == Crossing::What::surface && !scatters)
                source_.leave(entry.tag, entry.weight, direction, crossing, chunk_.cells);
            if (crossing.what != Crossing::What::none) break;
            ++chunk_.collisions;
            if (random_.uniform() < medium_.absorbed) break;
            position = end;
            collected += lightAt(toDouble(position), direction);
            direction = scattered(direction, medium_.g, random_);
        }
        if (collected > 0) chunk_.cells.push_back({entry.tag, static_cast<float>(collected) * entry.weight});
    }

    // In-scattered radiance, from one light and direction of all.
    double lightAt(Vec3 position, Vec3 direction) {
        const double u_light = random_.uniform(), u = random_.uniform(), v = random_.uniform();
        const LightSample light = lights_.sample(position, u_light, u, v);
        const double irradiance = light.irradiance_over_pdf[channel_];
        if (irradiance == 0) return 0;
        const std::optional<double> out = body_.wayOut(position, light.wi, light.distance);
        ++chunk_.rays;
        if (!out) return 0;
        return irradiance * std::exp(-medium_.sigma_t * *out) *
               Physics<double>::henyeyGreenstein(dot(direction, light.wi), medium_.g);
    }

    const Body& body_;
    BodyMedium medium_;
    const LightSampler& lights_;
    int channel_;
    CameraSource<Body>& source_;
    SplitMix64 random_;
    BodyChunk chunk_;
};

void checkLight(const Illumination& light, double eta) {
    if (std::holds_alternative<PencilLight>(light)) throw inputError("no camera sees light from a pencil beam");
    const auto* const lights = std::get_if<const LightSampler*>(&light);
    if (lights && eta != 1 && (*lights)->singular())
        throw inputError("through a refractive surface no walk meets light from a single direction or point",
                         "give the sun a disc (--sun-angle 10), use an environment, or leave out --radiance");
}

template <class Body>
BodyRadiance resultOf(const ChunkedResult& walked, const CameraRays& camera) {
    BodyRadiance r;
    r.walks = walked.walks;
    r.collisions = walked.collisions;
    r.seconds = walked.seconds;
    r.interrupted = walked.interrupted;
    const double all = static_cast<double>(walked.walks);
    const auto total = [&](std::size_t sum) { return walked.sums[0].estimate(sum, walked.walks).mean * all; };
    r.lost = static_cast<std::uint64_t>(std::llround(total(lost)));
    r.rays = static_cast<std::uint64_t>(std::llround(total(rays)));
    const std::size_t count = camera.pixels();
    double brightness = 0, lit = 0;  // of pixels in which something was collected
    for (std::size_t pixel = 0; pixel < count; ++pixel) {
        const double walks = static_cast<double>(walked.walks / count + (pixel < walked.walks % count ? 1 : 0));
        const double sum = total(pixels + pixel), squares = total(pixels + count + pixel);
        r.radiance.push_back(walks > 0 ? sum / walks : 0);
        const double spread = walks > 1 ? std::max(0.0, squares - sum * sum / walks) / (walks * (walks - 1)) : 0;
        r.standard_error.push_back(std::sqrt(spread));
        if (sum > 0) brightness += r.radiance.back(), ++lit;
    }
    const double least = lit > 0 ? brightness / lit * static_cast<double>(count) / all : 0;
    for (double& error : r.standard_error) error = std::max(error, least);
    return r;
}

template <class Body>
BodyRadiance walkAny(const Body& body, const Medium& medium, int channel, const Illumination& light,
                     const CameraRays& camera, const RadianceOptions& options, Observer& observer) {
    checkMedium(medium);
    checkLight(light, medium.eta);
    if (options.walks_per_pixel == 0) throw inputError("a reference needs at least one walk per pixel");
    if (!medium.scatters(channel)) throw inputError("the medium does not scatter in this channel");
    const double sigma_t = medium.sigmaT()[channel];
    BodyMedium walk{sigma_t, medium.sigma_a[channel] / sigma_t, medium.g[channel], medium.eta};
    const auto* const lights = std::get_if<const LightSampler*>(&light);

    ChunkedWalk job;
    job.plan.walks = options.walks_per_pixel * camera.pixels();
    job.plan.size = std::clamp((job.plan.walks + kFewestChunks - 1) / kFewestChunks, std::uint64_t{1}, kLargestChunk);
    if (options.control.state && !options.control.state->empty()) job.plan.size = options.control.state->chunk_size;
    if (options.large_steps) walk.ways = waysFor(job.plan.size);
    job.threads = options.threads;
    job.control = options.control;
    const ChunkedResult walked = walkChunks(
        job, {BatchRatios(pixels + 2 * camera.pixels())}, BodyChunk(),
        [&](std::uint64_t chunk, std::uint64_t count, BodyChunk& tally) {
            SplitMix64 seeds = streamOf(options.seed, 4 * chunk + static_cast<std::uint64_t>(channel));
            CameraSource<Body> source(body, camera, light, channel, medium.eta, chunk * job.plan.size, count,
                                      SplitMix64(seeds.next()));
            const SplitMix64 random(seeds.next());
            tally = lights && medium.eta == 1 ? MatchedWalker<Body>(body, walk, **lights, channel, source, random).run()
                                              : walkBodyChunk(body, walk, source, random);
            return tally.collisions;
        },
        [&](const BodyChunk& chunk, std::uint64_t count, std::vector<BatchRatios>& to) {
            std::vector<double> values(pixels + 2 * camera.pixels());
            values[lost] = static_cast<double>(chunk.lost + chunk.taken_back);
            values[rays] = static_cast<double>(chunk.rays);
            for (const CellExit& exit : chunk.cells) {
                const double value = static_cast<double>(exit.weight);
                values[pixels + exit.cell] += value;
                values[pixels + camera.pixels() + exit.cell] += value * value;
            }
            to[0].add(values, static_cast<double>(count));
        },
        observer);
    BodyRadiance result = resultOf<Body>(walked, camera);
    result.threads = options.threads > 0 ? options.threads : hardwareThreads();
    if (static_cast<double>(result.lost) > kMostLost * static_cast<double>(result.walks) + 3)
        throw inputError(
            fmt::format("{} of {} walks left the mesh without crossing its surface", result.lost, result.walks),
            "a mesh that crosses or folds onto itself does not bound a body");
    return result;
}

}  // namespace

BodyRadiance walkRadiance(const Ball& body, const Medium& medium, int channel, const Illumination& light,
                          const CameraRays& camera, const RadianceOptions& options, Observer& observer) {
    return walkAny(body, medium, channel, light, camera, options, observer);
}

BodyRadiance walkRadiance(const MeshBody& body, const Medium& medium, int channel, const Illumination& light,
                          const CameraRays& camera, const RadianceOptions& options, Observer& observer) {
    return walkAny(body, medium, channel, light, camera, options, observer);
}

}  // namespace searchlight
