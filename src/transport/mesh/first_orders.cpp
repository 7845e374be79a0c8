#include "transport/mesh/first_orders.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>

#include "base/error.h"
#include "base/parallel.h"
#include "transport/mesh/entry.h"
#include "transport/walk/fresnel.h"
#include "transport/walk/henyey_greenstein.h"

namespace searchlight {

namespace {

constexpr std::uint64_t pilot_candidates = 16'384;
constexpr std::uint64_t pilot_stream = ~std::uint64_t{1};
constexpr std::uint64_t chunk_count = 128;
// Of what entered: rays that carry less go on by roulette.
constexpr double least_part = 1e-3;

// A candidate's weight up to which candidates are rouletted, and the part of them that arrives: as in walkBody().
struct Pilot {
    double whole = 0, arrivals = 0;
};

Pilot pilotOf(const MeshBody& body, const Illumination& light, const EntryOptions& options, std::uint64_t seed) {
    EntrySource<MeshBody> source(body, light, options, pilot_candidates, streamOf(seed, pilot_stream));
    std::vector<double> weights;
    double sum = 0, squares = 0;
    for (std::uint64_t i = 0; i < pilot_candidates; ++i) {
        const auto candidate = source.draw();
        if (!(candidate.weight > 0)) continue;
        weights.push_back(candidate.weight);
        sum += candidate.weight;
        squares += candidate.weight * candidate.weight;
    }
    if (weights.empty()) throw inputError("no light reaches the surface in this channel");
    Pilot pilot{std::min(*std::ranges::max_element(weights), 2 * squares / sum), 0};
    for (const double weight : weights) pilot.arrivals += std::min(1.0, weight / pilot.whole) / pilot_candidates;
    return pilot;
}

struct Chunk {
    std::vector<CellExit> unscattered, single;
    std::uint64_t candidates = 0;
};

// A ray inside, in double; its weight is a part of what entered.
struct Beam {
    Vec3f position;
    Vec3 direction;
    double weight = 0;
};

class Walk {
public:
    Walk(const MeshBody& body, const Medium& medium, int channel, bool scatters, Chunk& chunk, SplitMix64 random)
        : body_(body),
          sigma_t_(medium.sigmaT()[channel]),
          albedo_(medium.sigma_s[channel] / sigma_t_),
          g_(medium.g[channel]),
          eta_(medium.eta),
          scatters_(scatters),
          reach_(4 * body.rays().extent()),
          chunk_(chunk),
          random_(random) {}

    void follow(const Entry& entry) {
        entered_ = static_cast<double>(entry.weight);
        follow({entry.position, normalize(toDouble(entry.direction)), entered_}, true);
    }

private:
    // To the surface and on by reflection, until nothing is left.
    void follow(Beam beam, bool is_first) {
        while (goesOn(beam)) {
            const Ray flight{beam.position, toFloat(beam.direction), 0, reach_};
            Crossing crossing;
            body_.cross({&flight, 1}, {&crossing, 1});
            if (crossing.what != Crossing::What::surface) return;
            const double leg = length(toDouble(crossing.position) - toDouble(beam.position));
            const double passed = std::exp(-sigma_t_ * leg);
            if (is_first && scatters_) scatter(beam, passed);
            beam.weight *= passed;
            const double cosine = std::min(1.0, dot(beam.direction, crossing.normal));
            if (!(cosine > 0)) return;  // grazing, by rounding
            const double mirrored = eta_ == 1 ? 0 : internalReflectance(eta_, cosine);
            if (mirrored < 1)
                (is_first ? chunk_.unscattered : chunk_.single)
                    .push_back({crossing.cell, static_cast<float>((1 - mirrored) * beam.weight)});
            beam.weight *= mirrored;
            beam.position = crossing.inside;
            beam.direction = normalize(beam.direction - 2 * cosine * crossing.normal);
        }
    }

    // The leg scatters 1 - `passed` of the beam; where, is drawn from the exponential cut off at its end.
    void scatter(const Beam& beam, double passed) {
        const double distance = -std::log1p(-random_.uniform() * (1 - passed)) / sigma_t_;
        Beam next{toFloat(toDouble(beam.position) + distance * beam.direction), {}, 0};
        next.direction = scatteredDirection(beam.direction, g_, random_);
        next.weight = albedo_ * (1 - passed) * beam.weight;
        follow(next, false);
    }

    bool goesOn(Beam& beam) {
        const double least = least_part * entered_;
        if (beam.weight >= least) return true;
        if (random_.uniform() * least >= beam.weight) return false;
        beam.weight = least;
        return true;
    }

    const MeshBody& body_;
    double sigma_t_, albedo_, g_, eta_;
    bool scatters_;
    float reach_;
    Chunk& chunk_;
    SplitMix64 random_;
    double entered_ = 0;
};

// Sums of weights per cell to exitance. What one walk leaves twice in a cell counts as independent.
void addUp(std::span<const CellExit> exits, std::vector<double>& sums, std::vector<double>& squares) {
    for (const CellExit& exit : exits) {
        const double weight = exit.weight;
        sums[exit.cell] += weight;
        squares[exit.cell] += weight * weight;
    }
}

}  // namespace

FirstOrders walkFirstOrders(const MeshBody& body, const Medium& medium, int channel, const Illumination& light,
                            const BodyOptions& options, Observer& observer, bool single) {
    checkMedium(medium);
    if (options.walks == 0) throw inputError("a reference needs at least one walk");
    if (!medium.scatters(channel)) throw inputError("the medium does not scatter in this channel");
    EntryOptions entry{channel, medium.eta};
    const Pilot pilot = pilotOf(body, light, entry, options.seed);
    entry.whole = pilot.whole;
    const auto tried = static_cast<std::uint64_t>(
        std::ceil(static_cast<double>(options.walks) / pilot.arrivals / static_cast<double>(chunk_count)));
    std::vector<Chunk> chunks(chunk_count);
    std::atomic<std::uint64_t> done = 0;
    parallelFor(chunk_count, options.threads, [&](std::size_t i) {
        if (observer.cancelled()) return;
        // Streams of their own: neither another channel's nor those of walkBody().
        SplitMix64 seeds = streamOf(~options.seed, 4 * i + static_cast<std::uint64_t>(channel));
        EntrySource<MeshBody> source(body, light, entry, tried, SplitMix64(seeds.next()));
        Walk walk(body, medium, channel, single, chunks[i], SplitMix64(seeds.next()));
        for (Entry next; source.next(next);) walk.follow(next);
        chunks[i].candidates = source.tried();
        observer.progress("single scattering", ++done, chunk_count, "chunks");
    });
    if (observer.cancelled()) throw interruptedError();
    const std::size_t cells = body.cellCount();
    FirstOrders result{std::vector<double>(cells, 0.0), std::vector<double>(cells, 0.0),
                       std::vector<double>(cells, 0.0), std::vector<double>(cells, 0.0)};
    double candidates = 0;
    for (const Chunk& chunk : chunks) {
        addUp(chunk.unscattered, result.unscattered, result.unscattered_error);
        addUp(chunk.single, result.single, result.single_error);
        candidates += static_cast<double>(chunk.candidates);
    }
    const auto finish = [&](std::vector<double>& sums, std::vector<double>& squares) {
        for (std::size_t cell = 0; cell < cells; ++cell) {
            const double area = body.cellArea(cell), scale = area > 0 ? pilot.whole / (candidates * area) : 0;
            squares[cell] = scale * std::sqrt(std::max(0.0, squares[cell] - sums[cell] * sums[cell] / candidates));
            sums[cell] *= scale;
        }
    };
    finish(result.unscattered, result.unscattered_error);
    finish(result.single, result.single_error);
    return result;
}

}  // namespace searchlight
