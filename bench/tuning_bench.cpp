// What other choices of BestTuning are worth: the figure of merit of the walks that foresee, over that with the choice
// made, at r = 0.5, 1, 2, 5 reduced mean free paths, over media. Arguments: the CPU seconds of each choice, 1 unless
// given; then a word, to see only the media whose name holds it.
//
// Merit is 1 / (relative variance x CPU seconds), the variance good to some 5 %. All choices of a medium walk chunk by
// chunk in turns, so that a busy machine slows them alike.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "transport/half_space/half_space_best.h"

namespace searchlight {
namespace {

constexpr int kBins = 53;
constexpr std::array<std::size_t, 4> kRadii{5, 10, 20, 50};  // bins of 0.1

struct Choice {
    const char* name;
    double BestTuning::*member;
    double value;
};

// One choice at work.
struct Contestant {
    Contestant(const HalfSpaceWalk& walk, const std::vector<double>& edges, const BestTuning& tuning)
        : plan(walk, edges, tuning), flux(plan.layout.slots()) {}

    void walkChunk(std::uint64_t chunk) {
        constexpr std::uint64_t chunk_walks = 4096;
        const std::clock_t begin = std::clock();
        ExitTally tally(plan.layout);
        walkForeseeingChunk(plan, streamOf(1, chunk), chunk_walks, tally);
        seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
        walks += chunk_walks;
        flux.add(tally.sums(ExitTally::multiple).flux, chunk_walks);
    }

    // Over five neighbours of each bin.
    std::array<double, 4> merits() const {
        std::array<double, 4> result{};
        for (std::size_t k = 0; k < kRadii.size(); ++k) {
            double variance = 0;
            for (std::size_t bin = kRadii[k] - 2; bin <= kRadii[k] + 2; ++bin) {
                const Estimate e = flux.estimate(2 + bin, walks);
                variance += std::pow(e.standard_error / e.mean, 2) / 5;
            }
            result[k] = 1 / (variance * seconds);
        }
        return result;
    }

    BestPlan plan;
    BatchRatios flux;
    std::uint64_t walks = 0;
    double seconds = 0;
};

void table(const std::string& medium, const HalfSpaceWalk& walk, double seconds) {
    std::vector<double> edges;
    for (int i = 0; i <= kBins; ++i) edges.push_back(0.1 * i / (1 - walk.g * (1 - walk.absorbed)));
    const BestTuning chosen = tuningFor(walk);
    std::vector<Choice> choices;
    std::deque<Contestant> contestants;
    contestants.emplace_back(walk, edges, chosen);
    for (const Choice& choice :
         {Choice{"roulette .4", &BestTuning::roulette, 0.4}, Choice{"roulette .6", &BestTuning::roulette, 0.6},
          Choice{"roulette .8", &BestTuning::roulette, 0.8}, Choice{"roulette 1", &BestTuning::roulette, 1.0},
          Choice{"far 0", &BestTuning::far, 0.0}, Choice{"far .8", &BestTuning::far, 0.8},
          Choice{"total .005", &BestTuning::total, 0.005}, Choice{"total .08", &BestTuning::total, 0.08},
          Choice{"depth .1", &BestTuning::depth, 0.1}, Choice{"depth .6", &BestTuning::depth, 0.6},
          Choice{"ahead 0", &BestTuning::ahead, 0.0}, Choice{"ahead 1", &BestTuning::ahead, 1.0},
          Choice{"shallow 0", &BestTuning::shallow, 0.0}, Choice{"shallow 5", &BestTuning::shallow, 5.0},
          Choice{"shallow 25", &BestTuning::shallow, 25.0}, Choice{"shallow 80", &BestTuning::shallow, 80.0},
          Choice{"stretched 0", &BestTuning::stretched, 0.0}, Choice{"stretched .5", &BestTuning::stretched, 0.5}}) {
        BestTuning other = chosen;
        if (other.*choice.member == choice.value) continue;
        other.*choice.member = choice.value;
        choices.push_back(choice);
        contestants.emplace_back(walk, edges, other);
    }
    for (std::uint64_t chunk = 0; chunk < 64 || contestants.front().seconds < seconds; ++chunk)
        for (Contestant& contestant : contestants) contestant.walkChunk(chunk);
    const std::array<double, 4> base = contestants.front().merits();
    fmt::print("{:36} {:12} {:8.3g} {:8.3g} {:8.3g} {:8.3g}\n", medium, "chosen", base[0], base[1], base[2], base[3]);
    for (std::size_t i = 0; i < choices.size(); ++i) {
        const std::array<double, 4> merit = contestants[i + 1].merits();
        double logs = 0;
        std::string cells;
        for (std::size_t k = 0; k < merit.size(); ++k) {
            cells += fmt::format(" {:8.2f}", merit[k] / base[k]);
            logs += std::log(merit[k] / base[k]) / 4;
        }
        fmt::print("{:36} {:12}{} mean {:5.2f}\n", "", choices[i].name, cells, std::exp(logs));
    }
    std::fflush(stdout);
}

}  // namespace
}  // namespace searchlight

int main(int count, char** arguments) {
    using searchlight::HalfSpaceWalk;
    const double seconds = count > 1 ? std::atof(arguments[1]) : 1;
    const std::string only = count > 2 ? arguments[2] : "";
    std::vector<std::pair<std::string, HalfSpaceWalk>> media{
        {"marble, red", {.absorbed = 0.0021 / (0.0021 + 2.19), .g = 0, .eta = 1.5}},
        {"skin1, red", {.absorbed = 0.032 / (0.032 + 0.74), .g = 0, .eta = 1.3}},
        {"ketchup, blue", {.absorbed = 1.45 / (1.45 + 0.03), .g = 0, .eta = 1.3}},
        {"whole milk, green", {.absorbed = 0.0024 / (0.0024 + 3.21), .g = 0, .eta = 1.3}}};
    for (const double absorbed : {0.98, 0.7, 0.3, 0.1, 0.01, 0.001, 0.0001})
        for (const double g : {0.0, 0.5, 0.9})
            for (const double eta : {1.0, 1.3, 1.5})
                media.push_back({fmt::format("scan: 1 - albedo {}, g {}, eta {}", absorbed, g, eta),
                                 {.absorbed = absorbed, .g = g, .eta = eta}});
    for (const auto& [name, walk] : media)
        if (name.find(only) != std::string::npos) searchlight::table(name, walk, seconds);
}
