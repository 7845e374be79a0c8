#include "transport/mesh/reference_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <type_traits>

#include "base/error.h"
#include "base/parallel.h"
#include "transport/mesh/ball_gl.h"
#include "transport/mesh/body_walk.h"
#include "transport/mesh/strayed_walks.h"
#include "transport/walk/chunks.h"

namespace searchlight {

namespace {

constexpr double kFewestChunks = 64;
constexpr double kLargestChunk = 65'536;  // walks
constexpr std::uint64_t kPilot = 65'536;  // candidates
constexpr std::uint64_t kPilotChunk = ~std::uint64_t{0};

// What candidates weigh, from some that are not used again.
struct Pilot {
    double whole = 0;     // the weight they are rouletted up to
    double arrivals = 0;  // walks that reach the surface, per candidate
    double largest = 0;   // weight of a walk over the mean
};

template <class Body>
Pilot pilotOf(const Body& body, const Illumination& light, const EntryOptions& options, std::uint64_t seed) {
    EntrySource<Body> source(body, light, options, kPilot, streamOf(seed, kPilotChunk));
    std::vector<double> weights;
    double sum = 0, squares = 0;
    for (std::uint64_t i = 0; i < kPilot; ++i) {
        const auto candidate = source.draw();
        if (!(candidate.weight > 0)) continue;
        if (candidate.shadowed &&
            body.occluded({candidate.position, candidate.normal}, candidate.wi, candidate.distance))
            continue;
        weights.push_back(candidate.weight);
        sum += candidate.weight;
        squares += candidate.weight * candidate.weight;
    }
    if (weights.empty()) throw inputError("no light reaches the surface in this channel");
    // Weights that spread little (a beam on a sphere) are all made equal; of those that spread widely the few heaviest
    // stay above.
    Pilot pilot;
    const double largest = *std::ranges::max_element(weights);
    pilot.whole = std::min(largest, 2 * squares / sum);
    for (const double weight : weights) pilot.arrivals += std::min(1.0, weight / pilot.whole) / kPilot;
    pilot.largest = std::max(largest, pilot.whole) * pilot.arrivals * kPilot / sum;
    return pilot;
}

enum Sum { incident, entered, left, absorbed, collisions, exit_x, exit_y, exit_z, sums };
// Follow in the sums per candidate; then for each cell the weights that left, and their squares.
enum Count { arrivals = sums, entries, flights, rays, taken_back, lost, cells };

// What the sums are divided by.
enum Per { per_candidate, per_incident, per_entry, per_left };

std::vector<BatchRatios> emptySums(std::size_t cell_count) {
    return {BatchRatios(cells + 2 * cell_count), BatchRatios(sums), BatchRatios(sums), BatchRatios(sums)};
}

void addChunk(const BodyChunk& chunk, std::size_t cell_count, std::vector<BatchRatios>& to) {
    const auto number = [](std::uint64_t count) { return static_cast<double>(count); };
    std::vector<double> values{chunk.entry.arrived,      chunk.entry.entered, chunk.left,    chunk.absorbed,
                               number(chunk.collisions), chunk.exits.x,       chunk.exits.y, chunk.exits.z};
    to[per_incident].add(values, chunk.entry.arrived);
    to[per_entry].add(values, number(chunk.entry.walks));
    to[per_left].add(values, chunk.left);
    values.insert(values.end(), {number(chunk.entry.arrivals), number(chunk.entry.walks), number(chunk.flights),
                                 number(chunk.rays), number(chunk.taken_back), number(chunk.lost)});
    values.resize(cells + 2 * cell_count);
    for (const CellExit& exit : chunk.cells) {
        const double weight = exit.weight;
        values[cells + exit.cell] += weight;
        values[cells + cell_count + exit.cell] += weight * weight;
    }
    to[per_candidate].add(values, number(chunk.candidates));
}

template <class Body>
BodyResult resultOf(const ChunkedResult& walked, const Body& body, const Pilot& pilot) {
    BodyResult r;
    const std::uint64_t n = walked.walks;
    const double candidates = static_cast<double>(n);
    const std::vector<BatchRatios>& by = walked.sums;
    const auto total = [&](std::size_t sum) { return by[per_candidate].estimate(sum, n).mean * candidates; };
    const auto count = [&](Count of) { return static_cast<std::uint64_t>(std::llround(total(of))); };
    // An error is at least that of one walk of the lot: few may all have met the same end.
    const auto known = [&](Per per, std::size_t sum, double most) {
        Estimate e = by[per].estimate(sum, n);
        if (most > 0) e.standard_error = std::max(e.standard_error, 1 / most);
        return e;
    };
    const auto flux = [&](Sum sum) {
        const Estimate e = known(per_candidate, sum, candidates);
        return Estimate{pilot.whole * e.mean, pilot.whole * e.standard_error, n};
    };
    r.candidates = n;
    r.collisions = walked.collisions;
    r.arrivals = count(arrivals), r.entries = count(entries);
    r.flights = count(flights), r.rays = count(rays);
    r.taken_back = count(taken_back), r.lost = count(lost);
    r.incident = flux(incident);
    r.entered = flux(entered);
    r.left = flux(left);
    r.reflectance = known(per_incident, left, total(incident));
    r.absorbed = known(per_incident, absorbed, total(incident));
    r.collisions_per_entry = by[per_entry].estimate(collisions, r.entries);
    for (std::size_t axis = 0; axis < 3; ++axis) r.mean_exit[axis] = by[per_left].estimate(exit_x + axis, n);
    for (std::size_t cell = 0; cell < body.cellCount(); ++cell) {
        const double area = body.cellArea(cell), scale = area > 0 ? pilot.whole / (candidates * area) : 0;
        const double sum = total(cells + cell), squares = total(cells + body.cellCount() + cell);
        r.exitance.push_back(scale * sum);
        r.standard_error.push_back(scale * std::sqrt(std::max(squares - sum * sum / candidates, 1.0)));
    }
    r.largest_weight = pilot.largest;
    r.seconds = walked.seconds;
    r.interrupted = walked.interrupted;
    return r;
}

template <class Body>
BodyResult walkAny(const Body& body, const Medium& medium, int channel, const Illumination& light,
                   const BodyOptions& options, Observer& observer) {
    checkMedium(medium);
    if (options.walks == 0) throw inputError("a reference needs at least one walk");
    if (!medium.scatters(channel)) throw inputError("the medium does not scatter in this channel");
    const double sigma_t = medium.sigmaT()[channel];
    if constexpr (std::is_same_v<Body, Ball>) requireResolved(2 * body.radius(), 1 / sigma_t);
    BodyMedium walk{sigma_t, medium.sigma_a[channel] / sigma_t, medium.g[channel], medium.eta};
    EntryOptions entry{channel, medium.eta};
    const Pilot pilot = pilotOf(body, light, entry, options.seed);
    entry.whole = pilot.whole;

    const double walks = static_cast<double>(options.walks);
    const double chunks = std::max(kFewestChunks, std::ceil(walks / kLargestChunk));
    ChunkedWalk job;
    job.plan.walks = static_cast<std::uint64_t>(std::ceil(walks / pilot.arrivals));
    job.plan.size = static_cast<std::uint64_t>(std::ceil(static_cast<double>(job.plan.walks) / chunks));
    job.plan = job.plan.goingOn(options.control.state);
    if (options.large_steps)
        walk.ways = waysFor(static_cast<std::uint64_t>(static_cast<double>(job.plan.size) * pilot.arrivals));
    job.threads = options.threads;
    if (const double error = options.control.until_error; error > 0)
        job.enough = [error](const std::vector<BatchRatios>& by, std::uint64_t n) {
            const Estimate e = by[per_incident].estimate(left, n);
            return e.mean > 0 && e.standard_error <= error * e.mean;
        };
    job.control = options.control;
    // Channels have streams of their own.
    const auto streamOfChunk = [&](std::uint64_t chunk) {
        return streamOf(options.seed, 4 * chunk + static_cast<std::uint64_t>(channel));
    };
    std::optional<BallGl> device;
    if constexpr (std::is_same_v<Body, Ball>) {
        if (options.gl) {
            const auto sourceOf = [&](std::uint64_t chunk) {
                return EntrySource<Ball>(body, light, entry, job.plan.walksOf(chunk),
                                         SplitMix64(streamOfChunk(chunk).next()));
            };
            device.emplace(*options.gl, body, walk, streamOf(options.seed, static_cast<std::uint64_t>(channel)).next(),
                           chunksOnGl(options.control, job.plan.chunks(), job.plan.size), sourceOf);
            job.threads = 1;
        }
    } else if (options.gl) {
        throw inputError("OpenGL does not walk in meshes", "a sphere, or the CPU (--backend cpu)");
    }
    StrayedWalks strayed;
    const ChunkedResult walked = walkChunks(
        job, emptySums(body.cellCount()), BodyChunk(),
        [&](std::uint64_t chunk, std::uint64_t tried, BodyChunk& tally) {
            if (device) {
                tally = device->walkChunk(chunk);
                return tally.collisions;
            }
            SplitMix64 seeds = streamOfChunk(chunk);
            EntrySource<Body> source(body, light, entry, tried, SplitMix64(seeds.next()));
            tally = walkBodyChunk(body, walk, source, SplitMix64(seeds.next()));
            tally.entry = source.totals();
            tally.candidates = source.tried();
            return tally.collisions;
        },
        [&](const BodyChunk& chunk, std::uint64_t, std::vector<BatchRatios>& to) {
            strayed.add(chunk.taken_back + chunk.lost, chunk.entry.walks);
            addChunk(chunk, body.cellCount(), to);
        },
        observer);
    BodyResult result = resultOf(walked, body, pilot);
    result.threads = device ? 1 : options.threads > 0 ? options.threads : hardwareThreads();
    StrayedWalks::check(result.taken_back + result.lost, result.entries);
    return result;
}

}  // namespace

BodyResult walkBody(const Ball& body, const Medium& medium, int channel, const Illumination& light,
                    const BodyOptions& options, Observer& observer) {
    return walkAny(body, medium, channel, light, options, observer);
}

BodyResult walkBody(const MeshBody& body, const Medium& medium, int channel, const Illumination& light,
                    const BodyOptions& options, Observer& observer) {
    return walkAny(body, medium, channel, light, options, observer);
}

}  // namespace searchlight
