// What other choices of BestTuning are worth: the figure of merit of the walks that foresee, over that with the choice
// made, at r = 0.5, 1, 2, 5 reduced mean free paths, over media. One argument: the seconds of each row, 1 unless given.
//
// Merit here is 1 / (relative variance x collisions), with three collisions' time for the start of a walk, so that a
// busy machine does not matter; the variance is good to some 5 %.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>

#include "transport/half_space/half_space_best.h"

namespace searchlight {
namespace {

constexpr int kBins = 53;
constexpr std::array<std::size_t, 4> kRadii{5, 10, 20, 50};  // bins of 0.1

std::array<double, 4> merits(const HalfSpaceWalk& walk, const BestTuning& tuning, double seconds) {
    std::vector<double> edges;
    for (int i = 0; i <= kBins; ++i) edges.push_back(0.1 * i / (1 - walk.g * (1 - walk.absorbed)));
    const BestPlan plan(walk, edges, tuning);
    BatchRatios flux(plan.layout.slots());
    constexpr std::uint64_t chunk_walks = 4096;
    std::uint64_t walks = 0, collisions = 0;
    const std::clock_t begin = std::clock();
    const auto spent = [&] { return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC; };
    for (std::uint64_t chunk = 0; chunk < 64 || spent() < seconds; ++chunk) {
        ExitTally tally(plan.layout);
        collisions += walkForeseeingChunk(plan, streamOf(1, chunk), chunk_walks, tally);
        walks += chunk_walks;
        flux.add(tally.sums(ExitTally::multiple).flux, chunk_walks);
    }
    std::array<double, 4> result{};
    for (std::size_t k = 0; k < kRadii.size(); ++k) {
        double variance = 0;
        for (std::size_t bin = kRadii[k] - 2; bin <= kRadii[k] + 2; ++bin) {
            const Estimate e = flux.estimate(2 + bin, walks);
            variance += std::pow(e.standard_error / e.mean, 2);
        }
        result[k] = 1 / (variance * static_cast<double>(collisions + 3 * walks));
    }
    return result;
}

void row(const HalfSpaceWalk& walk, double seconds) {
    const BestTuning chosen = tuningFor(walk);
    const std::array<double, 4> base = merits(walk, chosen, seconds);
    struct Choice {
        const char* name;
        double BestTuning::*member;
        double value;
    };
    for (const Choice& choice :
         {Choice{"roulette .3", &BestTuning::roulette, 0.3}, Choice{"roulette 1", &BestTuning::roulette, 1.0},
          Choice{"far 0", &BestTuning::far, 0.0}, Choice{"far .8", &BestTuning::far, 0.8},
          Choice{"total .005", &BestTuning::total, 0.005}, Choice{"total .08", &BestTuning::total, 0.08},
          Choice{"depth .1", &BestTuning::depth, 0.1}, Choice{"depth .6", &BestTuning::depth, 0.6},
          Choice{"stretched 0", &BestTuning::stretched, 0.0}, Choice{"stretched .5", &BestTuning::stretched, 0.5}}) {
        BestTuning other = chosen;
        if (other.*choice.member == choice.value) continue;
        other.*choice.member = choice.value;
        const std::array<double, 4> merit = merits(walk, other, seconds);
        double logs = 0;
        std::string cells;
        for (std::size_t k = 0; k < merit.size(); ++k) {
            cells += fmt::format(" {:5.2f}", merit[k] / base[k]);
            logs += std::log(merit[k] / base[k]) / 4;
        }
        fmt::print("1 - albedo {:<6} g {:<3} eta {:<3} {:12} {} mean {:5.2f}\n", walk.absorbed, walk.g, walk.eta,
                   choice.name, cells, std::exp(logs));
    }
}

}  // namespace
}  // namespace searchlight

int main(int count, char** arguments) {
    const double seconds = count > 1 ? std::atof(arguments[1]) : 1;
    for (const double absorbed : {0.98, 0.7, 0.3, 0.1, 0.01, 0.001, 0.0001})
        for (const double g : {0.0, 0.5, 0.9})
            for (const double eta : {1.0, 1.3, 1.5})
                // Above g = .7 other walks serve, unless much is absorbed.
                if (g < 0.7 || absorbed > 0.3) searchlight::row({.absorbed = absorbed, .g = g, .eta = eta}, seconds);
}
