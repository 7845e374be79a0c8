#include "transport/mesh/radiance_body.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include "base/error.h"
#include "base/parallel.h"
#include "transport/mesh/beam_source.h"
#include "transport/mesh/body_walk.h"
#include "transport/mesh/facet_beams.h"
#include "transport/mesh/lit_walk.h"
#include "transport/mesh/sphere_beams.h"
#include "transport/mesh/strayed_walks.h"
#include "transport/walk/chunks.h"

namespace searchlight {

namespace {

constexpr std::uint64_t kLargestChunk = 65'536;
constexpr std::uint64_t kFewestChunks = 64;

// Sums of a job; after the counts the values of each pixel, and their squares.
enum Sum { lost, rays, pixels };

// Whether light comes through a refractive surface from where no walk meets it, or few do, where there are beams of
// that.
template <class Beams>
bool needsBeams(const Illumination& light, double eta) {
    if (std::holds_alternative<PencilLight>(light)) throw inputError("no camera sees light from a pencil beam");
    const auto* const lights = std::get_if<const LightSampler*>(&light);
    return lights && eta != 1 && ((*lights)->singular() || (std::is_same_v<Beams, FacetBeams> && (*lights)->narrow()));
}

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

template <class Beams, class Body>
BodyRadiance walkAny(const Body& body, const Medium& medium, int channel, const Illumination& light,
                     const CameraRays& camera, const BodyRadianceOptions& options, Observer& observer) {
    checkMedium(medium);
    if (options.walks_per_pixel == 0) throw inputError("a reference needs at least one walk per pixel");
    if (!medium.scatters(channel)) throw inputError("the medium does not scatter in this channel");
    const double sigma_t = medium.sigmaT()[channel];
    if constexpr (std::is_same_v<Body, Ball>) requireResolved(2 * body.radius(), 1 / sigma_t);
    BodyMedium walk{sigma_t, medium.sigma_a[channel] / sigma_t, medium.g[channel], medium.eta};
    const auto* const lights = std::get_if<const LightSampler*>(&light);

    ChunkedWalk job;
    job.plan.walks = options.walks_per_pixel * camera.pixels();
    job.plan.size = std::clamp((job.plan.walks + kFewestChunks - 1) / kFewestChunks, std::uint64_t{1}, kLargestChunk);
    job.plan = job.plan.goingOn(options.control.state);
    if (options.large_steps) walk.ways = waysFor(job.plan.size);
    job.threads = options.threads;
    job.control = options.control;
    std::optional<Beams> beams;
    if (needsBeams<Beams>(light, medium.eta)) beams.emplace(body, walk, **lights, channel);
    StrayedWalks strayed;
    const ChunkedResult walked = walkChunks(
        job, {BatchRatios(pixels + 2 * camera.pixels())}, BodyChunk(),
        [&](std::uint64_t chunk, std::uint64_t count, BodyChunk& tally) {
            SplitMix64 seeds = streamOf(options.seed, 4 * chunk + static_cast<std::uint64_t>(channel));
            CameraSource<Body> source(body, camera, light, channel, medium.eta, job.plan.firstOf(chunk), count,
                                      SplitMix64(seeds.next()));
            const SplitMix64 random(seeds.next());
            tally = beams                       ? walkBeamsChunk(body, walk, *beams, source, random)
                    : lights && medium.eta == 1 ? walkMatchedChunk(body, walk, **lights, channel, source, random)
                                                : walkBodyChunk(body, walk, source, random);
            return tally.collisions;
        },
        [&](const BodyChunk& chunk, std::uint64_t count, std::vector<BatchRatios>& to) {
            std::vector<double> values(pixels + 2 * camera.pixels());
            values[lost] = static_cast<double>(chunk.lost + chunk.taken_back);
            strayed.add(chunk.lost + chunk.taken_back, count);
            values[rays] = static_cast<double>(chunk.rays);
            for (const CellExit& exit : chunk.cells) {
                const double value = static_cast<double>(exit.weight);
                values[pixels + exit.cell] += value;
                values[pixels + camera.pixels() + exit.cell] += value * value;
            }
            to[0].add(values, static_cast<double>(count));
        },
        observer);
    BodyRadiance result = resultOf(walked, camera);
    if constexpr (std::is_same_v<Beams, FacetBeams>)
        if (beams) result.mirrored = beams->mirrored(), result.orders = beams->orders();
    result.threads = options.threads > 0 ? options.threads : hardwareThreads();
    StrayedWalks::check(result.lost, result.walks);
    return result;
}

}  // namespace

BodyRadiance walkRadiance(const Ball& body, const Medium& medium, int channel, const Illumination& light,
                          const CameraRays& camera, const BodyRadianceOptions& options, Observer& observer) {
    return walkAny<SphereBeams>(body, medium, channel, light, camera, options, observer);
}

BodyRadiance walkRadiance(const MeshBody& body, const Medium& medium, int channel, const Illumination& light,
                          const CameraRays& camera, const BodyRadianceOptions& options, Observer& observer) {
    return walkAny<FacetBeams>(body, medium, channel, light, camera, options, observer);
}

}  // namespace searchlight
