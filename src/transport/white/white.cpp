#include "transport/white/white.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/text.h"
#include "transport/walk/beam.h"
#include "transport/white/white_roulette.h"
#include "transport/white/white_walk.h"

namespace searchlight {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Sums of weights and of their squares over the exits of some cells. Walks are independent and leave once, so these are
// all that a standard error needs.
struct Flux {
    double sum = 0, square = 0;

    Flux& operator+=(const Flux& other) {
        sum += other.sum, square += other.square;
        return *this;
    }
    // (sum w)^2 / sum w^2: as many exits of equal weight would be as noisy.
    double effectiveExits() const { return square > 0 ? sum * sum / square : 0; }
};

// Weight of a column to second order about its centre, for weights and for their squares.
struct ColumnWeights {
    // exp(-k (1 + d)) = exp(-k) (1 - k d + k^2 d^2 / 2 - ...)
    struct Series {
        double a = 0, b = 0, c = 0;
        explicit Series(double k) {
            if (k > 700) return;  // exp underflows
            a = std::exp(-k), b = -k * a, c = 0.5 * k * k * a;
        }
        double operator()(double s0, double s1, double s2) const { return a * s0 + b * s1 + c * s2; }
    };
    Series weight, square;
};

// `rate` per unit of path or per collision. Sums hold W once; a square holds it twice, and W = exp(roulette n), which
// along a path stands for exp(roulette L): they differ by 1 % where either is far from 1.
std::vector<ColumnWeights> columnWeights(const WhiteAxes& axes, WhiteView view, double rate) {
    std::vector<ColumnWeights> weights;
    for (std::size_t j = 0; j < axes.columns(view); ++j) {
        const double centre = axes.centre(view, j);
        weights.push_back(
            {ColumnWeights::Series(rate * centre), ColumnWeights::Series((2 * rate - kWhiteRoulette) * centre)});
    }
    return weights;
}

std::vector<Flux> weigh(const WhiteHistogram& histogram, const std::vector<ColumnWeights>& weights) {
    // Columns whose weight is 0 need no look.
    const std::size_t end = static_cast<std::size_t>(
        std::ranges::find_if(weights, [](const ColumnWeights& w) { return w.weight.a == 0; }) - weights.begin());
    std::vector<Flux> rows(histogram.rows.size());
    const auto& [s0, s1, s2] = histogram.moments;
    std::size_t at = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto [first, count] = histogram.rows[i];
        const std::size_t seen = first < end ? std::min<std::size_t>(count, end - first) : 0;
        Flux flux;
        for (std::size_t j = 0; j < seen; ++j) {
            const ColumnWeights& w = weights[first + j];
            const double m0 = s0[at + j], m1 = s1[at + j], m2 = s2[at + j];
            flux.sum += w.weight(m0, m1, m2);
            flux.square += w.square(m0, m1, m2);
        }
        rows[i] = flux;
        at += count;
    }
    return rows;
}

// Which share of each radial slot lies inside a radius. Flux inside is interpolated over log r by a cubic through four
// edges; it is linear in the slots, so a standard error follows.
struct Cut {
    std::ptrdiff_t slot = 0;
    double below = 1, at = 0, above = 0;  // of the slots around `slot`; all of the lower ones, none of the higher ones

    double share(std::ptrdiff_t s) const {
        if (s > slot + 1) return 0;
        return s == slot + 1 ? above : s == slot ? at : s == slot - 1 ? below : 1;
    }
};

Cut cutAt(const WhiteAxes& axes, double r) {
    const auto last = static_cast<std::ptrdiff_t>(axes.radialSlots()) - 1;
    if (r >= axes.largestRadius()) return {last + 2};
    const auto slot = static_cast<std::ptrdiff_t>(axes.radialSlot(r));
    if (slot == 0) return {0, 1, std::ldexp(r, 14), 0};  // R_d ~ 1 / r: flux grows linearly
    const double position = (std::log2(r) + 14) * axes.radii_per_octave;
    const double t = std::clamp(position - static_cast<double>(slot - 1), 0.0, 1.0);
    if (slot == 1 || slot == last - 1) return {slot, 1, t, 0};
    const double before = -t * (t - 1) * (t - 2) / 6, end = -t * (t + 1) * (t - 2) / 2,
                 after = t * (t + 1) * (t - 1) / 6;
    return {slot, 1 - before, end + after, after};
}

// One tier in both views for one medium.
class Reading {
public:
    Reading(const WhiteTier& tier, double sigma_a, double sigma_s, std::span<const double> edges_mm) : tier_(tier) {
        const double sigma_t = sigma_a + sigma_s;
        const double rates[] = {sigma_a / sigma_s,
                                std::log1p(sigma_a / sigma_s)};  // albedo^n = exp(-n log(1 / albedo))
        const double scales[] = {sigma_s, sigma_t};
        for (const WhiteView view : {WhiteView::path, WhiteView::collisions}) {
            const auto v = static_cast<std::size_t>(view);
            const std::vector<ColumnWeights> weights = columnWeights(tier.axes, view, rates[v]);
            for (const std::size_t order : {0, 1}) rows_[v][order] = weigh(tier.exits[v][order], weights);
            rows_[v][2] = rows_[v][0];
            for (std::size_t i = 0; i < rows_[v][2].size(); ++i) rows_[v][2][i] += rows_[v][1][i];
            cuts_[v].push_back({-2});
            for (const double edge : edges_mm) cuts_[v].push_back(cutAt(tier.axes, edge * scales[v]));
            cuts_[v].push_back(cutAt(tier.axes, infinity));
        }
    }

    // Between two cuts: 0 is the entry point, i + 1 is edge i, the last is infinity. Orders as in WhiteTier, 2: all.
    Flux between(WhiteView view, std::size_t order, std::size_t inner, std::size_t outer) const {
        const auto v = static_cast<std::size_t>(view);
        const Cut &a = cuts_[v][inner], &b = cuts_[v][outer];
        const std::vector<Flux>& rows = rows_[v][order];
        const auto end = std::min<std::ptrdiff_t>(b.slot + 2, static_cast<std::ptrdiff_t>(rows.size()));
        Flux flux;
        for (std::ptrdiff_t s = std::max<std::ptrdiff_t>(a.slot - 1, 0); s < end; ++s) {
            const double share = b.share(s) - a.share(s);
            const Flux& row = rows[static_cast<std::size_t>(s)];
            flux += {share * row.sum, share * share * row.square};
        }
        return flux;
    }

    double walks() const { return static_cast<double>(tier_.walks); }

private:
    const WhiteTier& tier_;
    std::array<std::array<std::vector<Flux>, 3>, kWhiteViews> rows_;
    std::array<std::vector<Cut>, kWhiteViews> cuts_;
};

class Evaluation {
public:
    Evaluation(const WhiteTable& table, double sigma_a, double sigma_s, std::span<const double> edges_mm)
        : table_(table),
          sigma_a_(sigma_a),
          sigma_s_(sigma_s),
          edges_(edges_mm),
          fine_(table.fine, sigma_a, sigma_s, edges_mm),
          pilot_(table.pilot, sigma_a, sigma_s, edges_mm),
          transmitted_(1 - enteringBeam(table.key.eta, table.key.angle_deg).specular) {}

    HalfSpaceTally tally(std::size_t order) const {
        const std::size_t bins = edges_.size() - 1, end = edges_.size() + 1;
        HalfSpaceTally tally;
        tally.total = flux(order, 0, end);
        for (std::size_t i = 0; i < bins; ++i) {
            const double area = std::numbers::pi * (edges_[i + 1] - edges_[i]) * (edges_[i + 1] + edges_[i]);
            const Estimate bin = flux(order, i + 1, i + 2);
            tally.Rd.push_back(bin.mean / area);
            tally.standard_error.push_back(bin.standard_error / area);
        }
        tally.beyond = {flux(order, 0, 1).mean + flux(order, end - 1, end).mean};
        const double mfp = 1 / (sigma_a_ + sigma_s_);
        tally.mean_x_mm = moment(order, 1, mfp);
        tally.mean_r2_mm2 = moment(order, 3, mfp * mfp);
        return tally;
    }

private:
    // Per unit incident flux.
    Estimate flux(std::size_t order, std::size_t inner, std::size_t outer) const {
        const auto seen = [&](WhiteView view) { return pilot_.between(view, order, inner, outer).effectiveExits(); };
        const WhiteView view =
            seen(WhiteView::path) > seen(WhiteView::collisions) ? WhiteView::path : WhiteView::collisions;
        const Flux found = fine_.between(view, order, inner, outer);
        const double n = fine_.walks(), mean = found.sum / n;
        double error = std::sqrt(std::max(0.0, found.square / n - mean * mean) / n);
        if (found.square == 0) {  // empty: one exit of the largest weight is the least that can be said
            const double r = inner == 0 || inner > edges_.size() ? 0 : edges_[inner - 1];
            error = std::min(sigma_s_ / (sigma_a_ + sigma_s_), std::exp(-sigma_a_ * r)) / n;
        }
        return {transmitted_ * mean, transmitted_ * error, table_.key.walks};
    }

    // Mean of what left, by collisions; `quantity` as in WhiteShift, followed by its square.
    Estimate moment(std::size_t order, std::size_t quantity, double unit) const {
        const WhiteAxes& axes = table_.fine.axes;
        const double rate = std::log1p(sigma_a_ / sigma_s_);
        const std::vector<ColumnWeights> weights = columnWeights(axes, WhiteView::collisions, rate);
        double w = 0, wq = 0, ww = 0, wwq = 0, wwqq = 0;
        for (std::size_t o = order == 1 ? 1 : 0; o < (order == 0 ? 1u : 2u); ++o)
            for (std::size_t j = 0; j < weights.size(); ++j) {
                const WhiteShift& shift = table_.shift[o][j];
                const auto sum = [&](const ColumnWeights::Series& series, std::size_t i) {
                    return series(shift[i][0], shift[i][1], shift[i][2]);
                };
                w += sum(weights[j].weight, 0), wq += sum(weights[j].weight, quantity);
                ww += sum(weights[j].square, 0), wwq += sum(weights[j].square, quantity);
                wwqq += sum(weights[j].square, quantity + 1);
            }
        if (w == 0) return {0, infinity, table_.key.walks};
        // Sum of w^2 (q - mean)^2, [Cochran1977] section 2.11.
        const double mean = wq / w, residuals = wwqq - 2 * mean * wwq + mean * mean * ww;
        return {unit * mean, unit * std::sqrt(std::max(0.0, residuals)) / w, table_.key.walks};
    }

    const WhiteTable& table_;
    double sigma_a_, sigma_s_;
    std::span<const double> edges_;
    Reading fine_, pilot_;
    double transmitted_;
};

HalfSpaceTally nothing(std::size_t bins) {
    HalfSpaceTally tally;
    tally.Rd.assign(bins, 0.0);
    tally.standard_error.assign(bins, 0.0);
    tally.beyond = {0.0};
    return tally;
}

// Written so that NaN is rejected.
void check(const WhiteTable& table, double sigma_a, double sigma_s, std::span<const double> edges) {
    constexpr double largest = 1e9;
    for (const double sigma : {sigma_a, sigma_s})
        if (!(sigma >= 0 && sigma <= largest))
            throw inputError("a coefficient is " + numberText(sigma), "0 to 1e9 1/mm");
    const double sigma_t = sigma_a + sigma_s, albedo = sigma_s / sigma_t;
    if (sigma_s > 0 && !(albedo <= kWhiteLargestAlbedo + 1e-12))
        throw inputError("the albedo " + numberText(albedo) + " is too near 1 for white Monte Carlo",
                         "up to " + numberText(kWhiteLargestAlbedo) + "; above it, walk");
    if (edges.size() < 2) throw inputError("radial bins need at least 2 edges");
    if (!(edges.front() >= 0)) throw inputError("the first edge is " + numberText(edges.front()), "0 mm or more");
    for (std::size_t i = 1; i < edges.size(); ++i)
        if (!(edges[i] > edges[i - 1])) throw inputError("an edge is " + numberText(edges[i]), "edges ascend");
    const double reach = table.fine.axes.largestRadius() / sigma_t;
    if (!(edges.back() <= reach))
        throw inputError("an edge is " + numberText(edges.back()) + " mm",
                         "for this medium the white table ends at " + prettyNumber(reach) + " mm; beyond it, walk");
}

}  // namespace

std::size_t WhiteAxes::radialSlot(double r) const {
    const double position = (std::log2(r) + 14) * radii_per_octave;
    if (!(position >= 0)) return 0;
    return std::min(static_cast<std::size_t>(position) + 1, radialSlots() - 1);
}

double WhiteAxes::largestRadius() const { return std::ldexp(1.0, octaves - 14); }

std::size_t WhiteAxes::columns(WhiteView view) const {
    constexpr int largest = 20;  // octaves above 1; the roulette leaves e^-52 of the walks there
    const int exact = 2 * columns_per_octave, first = std::countr_zero(static_cast<unsigned>(exact));
    return static_cast<std::size_t>(view == WhiteView::path ? columns_per_octave * (largest + 14)
                                                            : exact + columns_per_octave * (largest - first));
}

std::size_t WhiteAxes::column(WhiteView view, double amount) const {
    const int exact = 2 * columns_per_octave;
    double position = columns_per_octave * (std::log2(amount) + 14);
    if (view == WhiteView::collisions)
        position = amount <= exact ? amount - 1 : exact + columns_per_octave * std::log2(amount / exact);
    const double last = static_cast<double>(columns(view) - 1);
    return static_cast<std::size_t>(std::clamp(position, 0.0, last));
}

double WhiteAxes::centre(WhiteView view, std::size_t column) const {
    const std::size_t exact = 2 * static_cast<std::size_t>(columns_per_octave);
    if (view == WhiteView::collisions && column < exact) return static_cast<double>(column + 1);
    const double octaves_up = view == WhiteView::path
                                  ? (static_cast<double>(column) + 0.5) / columns_per_octave - 14
                                  : (static_cast<double>(column - exact) + 0.5) / columns_per_octave;
    return (view == WhiteView::path ? 1.0 : static_cast<double>(exact)) * std::exp2(octaves_up);
}

std::size_t WhiteTable::bytes() const {
    std::size_t bytes = 0;
    for (const WhiteTier* tier : {&fine, &pilot})
        for (const auto& view : tier->exits)
            for (const WhiteHistogram& histogram : view)
                bytes += histogram.rows.size() * sizeof(WhiteHistogram::Row) +
                         3 * histogram.moments[0].size() * sizeof(float);
    for (const auto& columns : shift) bytes += columns.size() * sizeof(WhiteShift);
    return bytes;
}

HalfSpaceResult evaluateWhite(const WhiteTable& table, double sigma_a, double sigma_s,
                              std::span<const double> edges_mm) {
    const auto begin = std::chrono::steady_clock::now();
    check(table, sigma_a, sigma_s, edges_mm);
    HalfSpaceResult result;
    result.specular = enteringBeam(table.key.eta, table.key.angle_deg).specular;
    result.threads = 1;
    result.instruction_set = whiteInstructionSet();
    if (sigma_s == 0 || result.specular == 1) {
        result.all = result.single = result.multiple = nothing(edges_mm.size() - 1);
        return result;
    }
    const Evaluation evaluation(table, sigma_a, sigma_s, edges_mm);
    result.single = evaluation.tally(0);
    result.multiple = evaluation.tally(1);
    result.all = evaluation.tally(2);
    result.walks = table.key.walks;
    result.collisions = table.collisions;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return result;
}

}  // namespace searchlight
