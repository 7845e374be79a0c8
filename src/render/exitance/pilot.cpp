#include "render/exitance/pilot.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/exitance/judge.h"

namespace searchlight {

namespace {

constexpr std::size_t draws = sampled_leaves;
// Nodes among which they are drawn, before those that hold much of the light are cut up.
constexpr std::size_t strata = 512;
constexpr double finer = reference_fineness;
constexpr int trials = 12;
// Opening for where the light is: good to some 10 %.
constexpr double rough = 20;

// A node of receivers and its share of what the draws go by.
struct Stratum {
    std::uint32_t node;
    double share;
};

class Pilot {
public:
    explicit Pilot(const PilotInput& input) : input_(input), visits_(input.receivers.nodes.size(), Visit::skip) {}

    SumCalibration run(Rgb first) {
        // Where nothing is to be seen nothing can be wrong.
        if (!matters(input_, 0) && !matters(input_, 1) && !matters(input_, 2)) return {.opening = {1, 1, 1}};
        drawLeaves();
        const Rgb most = largestOpening(input_);
        Rgb opening;
        for (int c = 0; c < Rgb::channels; ++c)
            if (matters(input_, c)) opening[c] = std::min(most[c], first[c] > 0 ? first[c] : 500 * input_.error);
        SumCalibration best;
        for (int trial = 0; trial < trials; ++trial) {
            Rgb bounds;
            const SumCalibration tried = measure(opening, bounds);
            const bool keeps = tried.error_bound <= input_.error;
            if (keeps && (best.opening == Rgb{} || tried.error_bound > best.error_bound)) best = tried;
            // Close enough: larger openings would save less than a tenth of the time.
            bool close = keeps;
            for (int c = 0; c < Rgb::channels; ++c) {
                if (!matters(input_, c)) continue;
                const double ratio = input_.error / std::max(bounds[c], 1e-30);
                close = close && (ratio < 1.3 || opening[c] >= most[c]);
                // The error is about proportional to the opening. Where another channel decides, it is not, and this
                // one is in nobody's way.
                opening[c] = std::min(most[c], opening[c] * std::clamp(0.87 * ratio, 1.0 / 64, 8.0));
            }
            if (close || (trial >= 3 && best.opening != Rgb{})) break;
        }
        return best;
    }

private:
    const ReceiverNode& node(std::size_t at) const { return input_.receivers.nodes[at]; }

    // Half of the probability goes evenly over the receivers, half to where the exitance is: with little light on a
    // large object an even sample would miss what the error is relative to.
    void drawLeaves() {
        std::vector<Stratum> level{{0, 1}};
        for (std::size_t size = 0; size != level.size() && level.size() < strata;) {
            size = level.size();
            split(level, [](const Stratum&) { return true; });
        }
        share(level);
        const auto heavy = [](const Stratum& stratum) { return stratum.share > 1.0 / draws; };
        // Six times three levels reach a leaf of the largest picture.
        for (int round = 0; round < 6 && std::any_of(level.begin(), level.end(),
                                                     [&](const Stratum& stratum) {
                                                         return heavy(stratum) && node(stratum.node).child >= 0;
                                                     });
             ++round) {
            for (int step = 0; step < 3; ++step) split(level, heavy);
            share(level);
        }
        std::fill(visits_.begin(), visits_.end(), Visit::skip);
        double passed = 0;
        std::size_t i = 0;
        for (std::uint32_t k = 0; k < draws; ++k) {
            const double wanted = (k + 0x1p-32 * scrambled(k + 1)) / draws;
            while (i + 1 < level.size() && passed + level[i].share <= wanted) passed += level[i++].share;
            draw(level[i], scrambled(k + 0x10000));
        }
        markAncestors(0);
    }

    // Replaces nodes by their children, which inherit the share for further splits.
    template <class Which>
    void split(std::vector<Stratum>& level, const Which& which) const {
        std::vector<Stratum> next;
        for (const Stratum& stratum : level) {
            const std::int32_t child = node(stratum.node).child;
            if (child < 0 || !which(stratum)) {
                next.push_back(stratum);
                continue;
            }
            next.push_back({static_cast<std::uint32_t>(child), stratum.share});
            next.push_back({static_cast<std::uint32_t>(child) + 1, stratum.share});
        }
        level = std::move(next);
    }

    // Sets the shares, by a rough sum at the centres of the nodes. They add up to 1.
    void share(std::vector<Stratum>& level) {
        std::fill(visits_.begin(), visits_.end(), Visit::skip);
        for (const Stratum& stratum : level) visits_[stratum.node] = Visit::guess;
        markAncestors(0);
        const auto opening = openingOf(input_.table, {rough, rough, rough}, input_.points.total_area, input_.threads);
        traverse({input_.points, input_.table, input_.receivers, opening, visits_}, input_.threads, tried_);
        const auto square = [&](std::uint32_t at, int c) {
            const auto value = static_cast<double>(tried_.guesses[at][static_cast<std::size_t>(c)]);
            return value * value * node(at).count;
        };
        Rgb squares;
        for (const Stratum& stratum : level)
            for (int c = 0; c < Rgb::channels; ++c) squares[c] += square(stratum.node, c);
        double sum = 0;
        for (Stratum& stratum : level) {
            stratum.share = 3.0 * node(stratum.node).count / static_cast<double>(input_.receivers.order.size());
            for (int c = 0; c < Rgb::channels; ++c)
                if (squares[c] > 0) stratum.share += square(stratum.node, c) / squares[c];
            sum += stratum.share;
        }
        for (Stratum& stratum : level) stratum.share /= sum;
        peak_ = {};
        for (const Stratum& stratum : level)
            for (int c = 0; c < Rgb::channels; ++c)
                peak_[c] = std::max(
                    peak_[c], std::abs(static_cast<double>(tried_.guesses[stratum.node][static_cast<std::size_t>(c)])));
    }

    // A leaf below the node, each with a probability proportional to its receivers.
    void draw(const Stratum& stratum, std::uint32_t random) {
        std::uint32_t at = stratum.node;
        while (node(at).child >= 0) {
            const auto child = static_cast<std::uint32_t>(node(at).child);
            random = scrambled(random + 1);
            at = 0x1p-32 * random * node(at).count < node(child).count ? child : child + 1;
        }
        visits_[at] = Visit::descend;
        sample_.push_back({node(at).first, node(at).count,
                           static_cast<double>(node(stratum.node).count) / (stratum.share * draws * node(at).count)});
    }

    bool markAncestors(std::size_t at) {
        if (visits_[at] == Visit::guess) return true;
        const std::int32_t child = node(at).child;
        if (child >= 0) {
            const bool first = markAncestors(static_cast<std::size_t>(child));
            const bool second = markAncestors(static_cast<std::size_t>(child) + 1);
            if (first || second) visits_[at] = Visit::descend;
        }
        return visits_[at] != Visit::skip;
    }

    void sumSample(Rgb opening, DualTreeResult& result) const {
        const Opening rule = openingFor(input_, opening);
        traverse({input_.points, input_.table, input_.receivers, rule, visits_}, input_.threads, result);
    }

    SumCalibration measure(Rgb opening, Rgb& bounds) {
        if (!fineEnough(opening)) {
            reference_opening_ = (1 / finer) * opening;
            sumSample(reference_opening_, reference_);
        }
        sumSample(opening, tried_);
        SumCalibration result{.opening = opening};
        for (int c = 0; c < Rgb::channels; ++c) {
            if (!matters(input_, c)) continue;
            const auto channel = static_cast<std::size_t>(c);
            bounds[c] = judge(sample_, tried_.exitance[channel], reference_.exitance[channel], peak_[c],
                              input_.receivers.order.size(), result) *
                        (1 + reference_opening_[c] / opening[c]);
            result.error_bound = std::max(result.error_bound, bounds[c]);
        }
        return result;
    }

    bool fineEnough(Rgb opening) const {
        for (int c = 0; c < Rgb::channels; ++c)
            if (matters(input_, c) && !(reference_opening_[c] > 0 && reference_opening_[c] < 3 / finer * opening[c]))
                return false;
        return true;
    }

    const PilotInput& input_;
    std::vector<Visit> visits_;
    std::vector<DrawnLeaf> sample_;
    Rgb peak_;  // of the rough exitance
    Rgb reference_opening_;
    DualTreeResult tried_, reference_;
};

}  // namespace

bool matters(const PilotInput& input, int c) {
    return input.points.lit[static_cast<std::size_t>(c)] && input.table.mean_square_radius[c] > 0;
}

Rgb largestOpening(const PilotInput& input) {
    const double leaf_area =
        input.points.total_area / static_cast<double>(input.points.order.size()) * PointTree::Impl::leaf_size;
    Rgb largest;
    for (int c = 0; c < Rgb::channels; ++c)
        largest[c] = std::min(20 * input.error, 0.1) *
                     std::min(input.points.total_area, std::numbers::pi * input.table.mean_square_radius[c]) /
                     leaf_area;
    return largest;
}

Opening openingFor(const PilotInput& input, Rgb opening) {
    return openingOf(input.table, opening, input.points.total_area, input.threads);
}

SumCalibration calibrate(const PilotInput& input, Rgb first) { return Pilot(input).run(first); }

}  // namespace searchlight
