#include "validate/model_rank.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "base/text.h"

namespace searchlight {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Of an annulus: light that leaves per unit incident flux.
struct Annulus {
    double area = 0, light = 0, noise = 0;  // mm^2, reference, its standard error
    bool near = false;
};

std::vector<Annulus> annuliOf(const RankReference& reference) {
    std::vector<Annulus> annuli;
    for (std::size_t i = 0; i < reference.Rd.size(); ++i) {
        const double inner = reference.edges_mm[i], outer = reference.edges_mm[i + 1];
        const double area = std::numbers::pi * (outer - inner) * (outer + inner);
        annuli.push_back({area, reference.Rd[i][reference.channel] * area,
                          reference.standard_error[i][reference.channel] * area,
                          (inner + outer) / 2 < reference.split_mm});
    }
    return annuli;
}

double lightOf(std::span<const Annulus> annuli) {
    return std::accumulate(annuli.begin(), annuli.end(), 0.0, [](double s, const Annulus& a) { return s + a.light; });
}

// The sign of an error that is known to a standard error: the mean of sign(off + normal). 0 where noise hides it.
double softSign(double off, double noise) {
    if (noise > 0) return std::erf(off / (noise * std::numbers::sqrt2));
    return off > 0 ? 1 : off < 0 ? -1 : 0;
}

// The mean of |off + normal| less |off|: what noise adds to an absolute value (folded normal distribution).
double foldedExcess(double off, double noise) {
    if (!(noise > 0)) return 0;
    const double z = std::abs(off) / noise;
    return noise * (std::sqrt(2 / std::numbers::pi) * std::exp(-z * z / 2) - z * std::erfc(z / std::numbers::sqrt2));
}

std::vector<double> offsetsOf(const RankReference& reference, std::span<const Annulus> annuli,
                              const RankAnswer& answer) {
    std::vector<double> off;
    for (std::size_t i = 0; i < annuli.size(); ++i)
        off.push_back(answer.bin_means[i][reference.channel] * annuli[i].area - annuli[i].light);
    return off;
}

ErrorPlace placeOf(const RankReference& reference, std::span<const Annulus> annuli, std::span<const double> off) {
    double size[2] = {}, signed_size[2] = {};  // far, near
    for (std::size_t i = 0; i < off.size(); ++i) {
        size[annuli[i].near] += std::abs(off[i]);
        signed_size[annuli[i].near] += off[i];
    }
    const double all = size[0] + size[1];
    ErrorPlace place;
    if (!(all > 0)) return place;
    place.near_share = size[1] / all;
    place.near_sign = size[1] > 0 ? signed_size[1] / size[1] : 0;
    place.far_sign = size[0] > 0 ? signed_size[0] / size[0] : 0;
    double before = 0;
    for (std::size_t i = 0; i < off.size(); ++i) {
        const double here = std::abs(off[i]);
        if (before + here >= all / 2) {
            // Within an annulus the error is spread evenly over its area.
            const double inner = reference.edges_mm[i], outer = reference.edges_mm[i + 1];
            const double part = (all / 2 - before) / here;
            place.half_mm = std::sqrt(inner * inner + part * (outer * outer - inner * inner));
            break;
        }
        before += here;
    }
    return place;
}

Estimate relativeError(double value, const Estimate& truth) {
    const double ratio = value / truth.mean;
    return {ratio - 1, std::abs(ratio) * truth.standard_error / std::abs(truth.mean)};
}

// Fills oblique, shape and oblique_noise.
void comparePlanes(const RankReference& reference, const RankAnswer& answer, RankScore& score) {
    const auto sumOf = [](const std::vector<double>& values) {
        return std::accumulate(values.begin(), values.end(), 0.0);
    };
    score.oblique = score.shape = score.oblique_noise = nan;
    if (reference.plane.empty() || answer.plane.empty()) return;
    const double light = sumOf(reference.plane), scale = light / sumOf(answer.plane);
    double off = 0, off_scaled = 0;
    for (std::size_t i = 0; i < reference.plane.size(); ++i) {
        off += std::abs(answer.plane[i] - reference.plane[i]);
        off_scaled += std::abs(scale * answer.plane[i] - reference.plane[i]);
    }
    score.oblique = off / light;
    score.shape = off_scaled / light;
    score.oblique_noise = std::sqrt(2 / std::numbers::pi) * sumOf(reference.plane_error) / light;
}

// The mean of what is known.
struct KnownMean {
    double sum = 0;
    int count = 0;
    void add(double value) {
        if (std::isnan(value)) return;
        sum += value;
        ++count;
    }
    double value() const { return count > 0 ? sum / count : nan; }
};

std::string percent(double part) { return fmt::format("{:.0f} %", 100 * part); }

// Below this an error has both signs: a quarter of it to one side, three quarters to the other.
constexpr double clear_sign = 0.5;
// A field that holds this part of the error is where the model fails.
constexpr double main_share = 0.6;
// A field with less is not worth a word.
constexpr double worth_a_word = 0.2;

std::string_view signText(double sign) {
    return sign > clear_sign ? "too high" : sign < -clear_sign ? "too low" : "off to both sides";
}

std::string profileText(const RankReference& reference, const RankScore& score) {
    const ErrorPlace& place = score.place;
    const std::string split = prettyNumber(reference.split_mm, 2);
    const double far_share = 1 - place.near_share;
    if (score.curve.weighted <= 2 * score.curve.noise) return "no error beyond the noise of the reference";
    if (place.near_share >= main_share)
        return fmt::format("{} near the beam: {} of its error lies within {} mm", signText(place.near_sign),
                           percent(place.near_share), split);
    const bool opposite = std::abs(place.near_sign) > clear_sign && std::abs(place.far_sign) > clear_sign &&
                          place.near_sign * place.far_sign < 0 && place.near_share >= worth_a_word;
    if (opposite)
        return fmt::format("{} near the beam and {} away from it: {} and {} of its error, on either side of {} mm",
                           signText(place.near_sign), signText(place.far_sign), percent(place.near_share),
                           percent(far_share), split);
    if (far_share >= main_share)
        return fmt::format("{} away from the beam: {} of its error lies beyond {} mm", signText(place.far_sign),
                           percent(far_share), split);
    const double sign = place.near_share * place.near_sign + far_share * place.far_sign;
    return fmt::format("{} at all distances: half of its error lies within {} mm", signText(sign),
                       prettyNumber(place.half_mm, 2));
}

// Errors below are said by the table.
constexpr double worth_saying = 0.1;

}  // namespace

RankScore rankScore(const RankReference& reference, const RankAnswer& answer) {
    const std::vector<Annulus> annuli = annuliOf(reference);
    const double light = lightOf(annuli);
    const std::vector<double> off = offsetsOf(reference, annuli, answer);
    RankScore score;
    score.curve = curveError(answer.bin_means, reference.Rd, reference.standard_error, reference.edges_mm,
                             reference.channel, reference.split_mm);
    double field[2] = {}, variance = 0, field_variance[2] = {};  // far, near
    for (const Annulus& annulus : annuli) field[annulus.near] += annulus.light;
    for (std::size_t i = 0; i < annuli.size(); ++i) {
        const auto& [area, here, noise, near] = annuli[i];
        // d(error) / d(light here): the difference grows or shrinks with the light, and the denominator grows.
        const auto slope = [&, sign = softSign(off[i], noise)](double error, double over) {
            return -(sign + error) / over;
        };
        variance += std::pow(slope(score.curve.weighted, light) * noise, 2);
        field_variance[near] += std::pow(slope(near ? score.curve.near : score.curve.far, field[near]) * noise, 2);
        score.inflation += foldedExcess(off[i], noise) / light;
    }
    score.near_weight = field[1] / light;
    score.standard_error = std::sqrt(variance);
    score.near_error = std::sqrt(field_variance[1]);
    score.far_error = std::sqrt(field_variance[0]);
    score.total = relativeError(answer.total, reference.total);
    const Estimate& shift = reference.mean_x_mm;
    // A shift within three standard errors of 0 is none that an error could be relative to.
    score.shift =
        std::abs(shift.mean) > 3 * shift.standard_error ? relativeError(answer.mean_x_mm, shift) : Estimate{nan, nan};
    comparePlanes(reference, answer, score);
    score.place = placeOf(reference, annuli, off);
    return score;
}

RankGap rankGap(const RankReference& reference, const RankAnswer& a, const RankAnswer& b) {
    const std::vector<Annulus> annuli = annuliOf(reference);
    const double light = lightOf(annuli);
    const std::vector<double> off_a = offsetsOf(reference, annuli, a), off_b = offsetsOf(reference, annuli, b);
    RankGap found;
    for (std::size_t i = 0; i < annuli.size(); ++i) found.gap += (std::abs(off_a[i]) - std::abs(off_b[i])) / light;
    double variance = 0, inflation = 0;
    for (std::size_t i = 0; i < annuli.size(); ++i) {
        const double noise = annuli[i].noise;
        const double slope = (softSign(off_b[i], noise) - softSign(off_a[i], noise) - found.gap) / light;
        variance += slope * slope * noise * noise;
        inflation += (foldedExcess(off_a[i], noise) - foldedExcess(off_b[i], noise)) / light;
    }
    found.noise = 2 * std::sqrt(variance) + std::abs(inflation);
    return found;
}

std::string failureText(const RankReference& reference, const RankScore& score, double angle_deg) {
    if (!std::isfinite(score.curve.weighted)) return "not finite on this medium";
    std::string text = profileText(reference, score);
    if (std::abs(score.total.mean) > std::max(worth_saying, 2 * score.total.standard_error))
        text += fmt::format("; total {:+.0f} %", 100 * score.total.mean);
    if (score.shift.mean == -1)
        text += fmt::format("; does not shift light that comes at {}°", prettyNumber(angle_deg));
    else if (std::abs(score.shift.mean) > std::max(worth_saying, 2 * score.shift.standard_error))
        text += fmt::format("; shift at {}° {:+.0f} %", prettyNumber(angle_deg), 100 * score.shift.mean);
    return text;
}

std::vector<RankedModel> rankModels(std::span<const RankReference> references,
                                    std::span<const std::vector<RankAnswer>> answers) {
    const double count = static_cast<double>(references.size());
    std::vector<RankedModel> ranked;
    for (std::size_t m = 0; m < answers.size(); ++m) {
        RankedModel model{.model = m};
        KnownMean shift, oblique, shape;
        for (std::size_t i = 0; i < references.size(); ++i) {
            const RankScore score = rankScore(references[i], answers[m][i]);
            model.profile += score.curve.weighted / count;
            model.near += score.curve.near / count;
            model.far += score.curve.far / count;
            model.total += std::abs(score.total.mean) / count;
            shift.add(std::abs(score.shift.mean));
            oblique.add(score.oblique);
            shape.add(score.shape);
            model.standard_error = std::hypot(model.standard_error, score.standard_error / count);
            model.near_error = std::hypot(model.near_error, score.near_error / count);
            model.far_error = std::hypot(model.far_error, score.far_error / count);
            if (i > 0 && score.curve.weighted > model.channels[model.worst_channel].curve.weighted)
                model.worst_channel = i;
            model.channels.push_back(score);
        }
        model.shift = shift.value();
        model.oblique = oblique.value();
        model.shape = shape.value();
        ranked.push_back(std::move(model));
    }
    const auto known = [](const RankedModel& model) { return std::isfinite(model.profile); };
    std::stable_sort(ranked.begin(), ranked.end(), [&](const RankedModel& a, const RankedModel& b) {
        return known(a) != known(b) ? known(a) : known(a) && a.profile < b.profile;
    });
    for (RankedModel& model : ranked)
        for (const RankedModel& other : ranked) {
            if (&model == &other) continue;
            if (!known(model) || !known(other)) {
                model.rank += known(other);
                continue;
            }
            double gap = 0, variance = 0;
            for (std::size_t i = 0; i < references.size(); ++i) {
                const RankGap found = rankGap(references[i], answers[model.model][i], answers[other.model][i]);
                gap += found.gap / count;
                variance += std::pow(found.noise / count, 2);
            }
            if (std::abs(gap) <= std::sqrt(variance))
                model.ties.push_back(other.model);
            else
                model.rank += gap > 0;
        }
    return ranked;
}

}  // namespace searchlight
