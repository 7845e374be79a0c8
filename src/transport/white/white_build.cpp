// Walks into tables.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/text.h"
#include "transport/walk/beam.h"
#include "transport/white/white.h"
#include "transport/white/white_roulette.h"
#include "transport/white/white_walk.h"

namespace searchlight {

namespace {

// Walks of a chunk: 64 chunks of a job, within these bounds. Errors come from cells, not from chunks, so a small job
// may have one; the longest walks of a chunk, 4e5 collisions, are walked with most lanes empty, so that small ones are
// slow.
constexpr std::uint64_t kSmallestChunk = 16'384, kLargestChunk = 65'536, kChunks = 64;

// Written so that NaN is rejected.
void check(const WhiteKey& key) {
    const auto reject = [](const char* what, double value, const char* valid) {
        throw inputError(std::string(what) + " is " + numberText(value), valid);
    };
    if (!(key.g > -1 && key.g <= 0.999)) reject("g", key.g, "above -1 and up to 0.999 for white Monte Carlo");
    if (!(key.eta >= 0.1 && key.eta <= 10)) reject("eta", key.eta, "0.1 to 10, inside over outside");
    if (!(key.angle_deg >= 0 && key.angle_deg < 90))
        reject("the angle of incidence", key.angle_deg, "0 to below 90 degrees");
    if (key.walks == 0) throw inputError("a reference needs at least one walk");
}

// A histogram while it grows: every cell, in double.
class Growing {
public:
    Growing(std::size_t rows, std::size_t columns) : columns_(columns), cells_(rows * columns) {}

    void add(std::size_t row, std::size_t column, double weight, double d) {
        auto& [s0, s1, s2] = cells_[row * columns_ + column];
        s0 += weight, s1 += weight * d, s2 += weight * d * d;
    }

    WhiteHistogram finish() const {
        WhiteHistogram histogram;
        for (std::size_t at = 0; at < cells_.size(); at += columns_) {
            const auto begin = cells_.begin() + static_cast<std::ptrdiff_t>(at);
            const auto end = begin + static_cast<std::ptrdiff_t>(columns_);
            const auto filled = [](const Cell& cell) { return cell[0] > 0; };
            const auto first = std::find_if(begin, end, filled);
            auto last = end;
            while (last != first && !filled(*(last - 1))) --last;
            histogram.rows.push_back({first == end ? 0 : static_cast<std::uint32_t>(first - begin),
                                      static_cast<std::uint32_t>(last - first)});
            for (auto cell = first; cell != last; ++cell)
                for (std::size_t i = 0; i < 3; ++i) histogram.moments[i].push_back(static_cast<float>((*cell)[i]));
        }
        return histogram;
    }

private:
    using Cell = std::array<double, 3>;
    std::size_t columns_;
    std::vector<Cell> cells_;
};

class TierTally {
public:
    explicit TierTally(const WhiteAxes& axes) : axes_(axes) {
        for (std::size_t v = 0; v < kWhiteViews; ++v)
            views_.push_back(std::vector<Growing>(2, {axes.radialSlots(), axes.columns(static_cast<WhiteView>(v))}));
        for (auto& order : shift_) order.assign(axes.columns(WhiteView::collisions), WhiteShift{});
    }

    void add(const WhiteExits& exits) {
        for (std::size_t i = 0; i < exits.count; ++i) {
            const double x = exits.x[i], y = exits.y[i], length = exits.length[i], n = exits.collisions[i];
            const double r2 = x * x + y * y, weight = std::exp(kWhiteRoulette * n);
            const std::size_t row = axes_.radialSlot(std::sqrt(r2)), order = n > 1;
            for (const WhiteView view : {WhiteView::path, WhiteView::collisions}) {
                const double amount = view == WhiteView::path ? length : n;
                const std::size_t column = axes_.column(view, amount);
                const double d = amount / axes_.centre(view, column) - 1;
                views_[static_cast<std::size_t>(view)][order].add(row, column, weight, d);
                if (view == WhiteView::path) continue;
                const double quantities[] = {1, x, x * x, r2, r2 * r2}, powers[] = {weight, weight * d, weight * d * d};
                WhiteShift& shift = shift_[order][column];
                for (std::size_t q = 0; q < shift.size(); ++q)
                    for (std::size_t p = 0; p < 3; ++p) shift[q][p] += quantities[q] * powers[p];
            }
        }
    }

    void finish(WhiteTier& tier) const {
        for (std::size_t v = 0; v < kWhiteViews; ++v)
            for (const std::size_t order : {0, 1}) tier.exits[v][order] = views_[v][order].finish();
    }
    const std::array<std::vector<WhiteShift>, 2>& shift() const { return shift_; }

private:
    WhiteAxes axes_;
    std::vector<std::vector<Growing>> views_;  // [view][order]
    std::array<std::vector<WhiteShift>, 2> shift_;
};

class Walks {
public:
    Walks(const WhiteKey& key, int threads, Observer& observer)
        : threads_(threads > 0 ? threads : hardwareThreads()), observer_(observer) {
        const Beam beam = enteringBeam(key.eta, key.angle_deg);
        walk_ = {key.g, key.eta, beam.sine, beam.cosine, kWhiteRoulette};
        enters_ = beam.specular < 1;
    }

    // Returns the collisions. `done` of `total` walks are behind us.
    std::uint64_t into(TierTally& tally, std::uint64_t seed, std::uint64_t walks, std::uint64_t done,
                       std::uint64_t total) {
        if (!enters_) return 0;
        const std::uint64_t chunk_walks = std::clamp(walks / kChunks, kSmallestChunk, kLargestChunk);
        const std::uint64_t chunks = (walks + chunk_walks - 1) / chunk_walks;
        const auto firstWalk = [&](std::uint64_t chunk) {  // chunks differ by at most one walk
            return walks / chunks * chunk + std::min(walks % chunks, chunk);
        };
        // Blocks bound the memory; within a block threads take chunks as they come, and tables grow in chunk order.
        const auto block = static_cast<std::uint64_t>(4 * threads_);
        std::vector<WhiteExits> exits(block);
        std::vector<std::uint64_t> collisions(block);
        std::uint64_t sum = 0;
        for (std::uint64_t start = 0; start < chunks; start += block) {
            const std::uint64_t end = std::min(chunks, start + block);
            parallelFor(end - start, threads_, [&](std::size_t i) {
                if (observer_.cancelled()) throw interruptedError();
                const std::uint64_t chunk = start + i;
                collisions[i] = walkWhiteChunk(walk_, seed, chunk, firstWalk(chunk + 1) - firstWalk(chunk), exits[i]);
            });
            for (std::size_t i = 0; i < end - start; ++i) {
                tally.add(exits[i]);
                sum += collisions[i];
            }
            observer_.progress("white table", done + firstWalk(end), total, "walks");
        }
        return sum;
    }

private:
    int threads_;
    Observer& observer_;
    WhiteWalk walk_;
    bool enters_ = true;
};

}  // namespace

WhiteTable emptyWhiteTable(const WhiteKey& key) {
    check(key);
    // 1024 reduced mean free paths: seventeen diffuse ones at the largest albedo and g = 0.
    const int octaves = 14 + 10 + static_cast<int>(std::ceil(std::log2(1 / (1 - std::max(0.0, key.g)))));
    WhiteTable table;
    table.key = key;
    table.fine = {{24, 16, octaves}, key.walks};
    // The pilot only chooses: coarse bins pool its walks.
    table.pilot = {{4, 8, octaves}, std::max<std::uint64_t>(1, key.walks / 8)};
    return table;
}

WhiteTable buildWhiteTable(const WhiteKey& key, int threads, Observer& observer) {
    WhiteTable table = emptyWhiteTable(key);
    const auto begin = std::chrono::steady_clock::now();
    const std::uint64_t total = table.fine.walks + table.pilot.walks;
    Walks walks(key, threads, observer);
    TierTally fine(table.fine.axes), pilot(table.pilot.axes);
    // The pilot must know nothing of the walks that it judges: a stream of seeds apart.
    const std::uint64_t pilot_seed = ~SplitMix64(key.seed).next();
    table.collisions = walks.into(pilot, pilot_seed, table.pilot.walks, 0, total);
    table.collisions += walks.into(fine, key.seed, table.fine.walks, table.pilot.walks, total);
    pilot.finish(table.pilot);
    fine.finish(table.fine);
    table.shift = fine.shift();
    table.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return table;
}

}  // namespace searchlight
