#include "job/rank/ranking_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "plot/model_errors.h"

namespace searchlight {

namespace {

std::string noisePercent(double part) { return std::isfinite(part) ? fmt::format("{:.2f} %", 100 * part) : "–"; }

std::string noiseText(const Ranking& ranking) {
    const RankingNoise noise = rankingNoise(ranking);
    std::string text = fmt::format("The reference is known to {:.2g} % of R_d, {:.2g} % of the total",
                                   100 * noise.profile, 100 * noise.total);
    if (std::isfinite(noise.shift)) text += fmt::format(", {:.2g} % of the shift", 100 * noise.shift);
    if (std::isfinite(noise.plane)) text += fmt::format(", {:.2g} % of R_d under the oblique beam", 100 * noise.plane);
    return text + ".";
}

// "1", or "1 =" where noise does not tell it from another.
std::string rankText(const RankedModel& model) {
    return fmt::format("{}{}", model.rank, model.ties.empty() ? "" : " =");
}

std::string summaryOf(const Ranking& ranking, const std::vector<RankEntry>& entries) {
    const RankedModel& best = ranking.ranked.front();
    std::string text =
        fmt::format("On {}, {} is nearest to the reference: its R_d is off by {} ± {}", ranking.subject.name,
                    entries[best.model].label, percentText(best.profile), noisePercent(best.standard_error));
    if (!best.ties.empty()) {
        std::vector<std::string> names;
        for (const std::size_t tie : best.ties) names.push_back(entries[tie].label);
        text += fmt::format(", which noise does not tell from {}", fmt::join(names, ", "));
    }
    return text + ".";
}

Json numberJson(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json scoreJson(const RankScore& score) {
    return {{"profile", numberJson(score.curve.weighted)},
            {"near", numberJson(score.curve.near)},
            {"far", numberJson(score.curve.far)},
            {"near_weight", score.near_weight},
            {"total", numberJson(score.total.mean)},
            {"shift", numberJson(score.shift.mean)},
            {"oblique", numberJson(score.oblique)},
            {"shape", numberJson(score.shape)},
            {"stderr", numberJson(score.standard_error)},
            {"near_share", score.place.near_share},
            {"half_mm", score.place.half_mm}};
}

Json estimateJson(const Estimate& estimate) {
    return {{"mean", numberJson(estimate.mean)}, {"stderr", numberJson(estimate.standard_error)}};
}

std::string estimatorName(const RankWalks& walks) {
    if (walks.exact) return "exact";
    return walks.normal.estimator == Estimator::best ? "best" : "analogue";
}

Json referenceJson(const Ranking& ranking) {
    const RankingNoise noise = rankingNoise(ranking);
    Json channels = Json::array();
    for (std::size_t i = 0; i < ranking.channels.size(); ++i) {
        const RankReference& reference = ranking.reference[i];
        channels.push_back({{"channel", channelName(ranking.subject.medium, ranking.channels[i])},
                            {"split_mm", reference.split_mm},
                            {"total", estimateJson(reference.total)},
                            {"mean_x_mm", estimateJson(reference.mean_x_mm)},
                            {"estimator", estimatorName(ranking.walks[i])},
                            {"walks", ranking.walks[i].normal.walks},
                            {"oblique_walks", ranking.walks[i].oblique.walks}});
    }
    return {{"stderr",
             {{"profile", noise.profile},
              {"total", noise.total},
              {"shift", numberJson(noise.shift)},
              {"oblique", numberJson(noise.plane)}}},
            {"angle_deg", ranking.effort.angle_deg},
            {"channels", channels}};
}

ReportTable rankingTable(const Ranking& ranking, const std::vector<RankEntry>& entries) {
    ReportTable table{.caption = rankingMeaning(ranking),
                      .header = {"rank", "model", "R_d", "±", "near", "far", "total", "shift", "oblique", "shape",
                                 "one evaluation", "where it fails"}};
    for (const RankedModel& model : ranking.ranked)
        table.rows.push_back({rankText(model), entries[model.model].label, percentText(model.profile),
                              noisePercent(model.standard_error), percentText(model.near), percentText(model.far),
                              percentText(model.total), percentText(model.shift), percentText(model.oblique),
                              percentText(model.shape), evaluationText(ranking.cost_ns[model.model]),
                              ranking.sentence(model)});
    return table;
}

ReportTable channelTable(const Ranking& ranking, const std::vector<RankEntry>& entries) {
    ReportTable table{.caption = "Errors with their sign where they have one. Split: 1/σt′.",
                      .header = {"channel", "model", "R_d", "near", "far", "total", "shift", "oblique", "shape",
                                 "split", "where it fails"}};
    for (std::size_t i = 0; i < ranking.channels.size(); ++i)
        for (const RankedModel& model : ranking.ranked) {
            const RankScore& score = model.channels[i];
            const auto with_sign = [](double part) {
                return std::isfinite(part) ? fmt::format("{:+.1f} %", 100 * part) : std::string("–");
            };
            table.rows.push_back({channelName(ranking.subject.medium, ranking.channels[i]), entries[model.model].label,
                                  percentText(score.curve.weighted), percentText(score.curve.near),
                                  percentText(score.curve.far), with_sign(score.total.mean),
                                  with_sign(score.shift.mean), percentText(score.oblique), percentText(score.shape),
                                  prettyNumber(ranking.reference[i].split_mm, 3) + " mm",
                                  failureText(ranking.reference[i], score, ranking.effort.angle_deg)});
        }
    return table;
}

Figure errorsFigure(const Ranking& ranking, const std::vector<RankEntry>& entries) {
    std::vector<ModelErrors> models(entries.size());
    for (const RankedModel& ranked : ranking.ranked) {
        ModelErrors& model = models[ranked.model];
        model.label = entries[ranked.model].label;
        const double count = static_cast<double>(ranking.channels.size());
        double total = 0, shift = 0;
        for (const RankScore& score : ranked.channels) {
            total += std::pow(score.total.standard_error / count, 2);
            if (!std::isnan(score.shift.mean)) shift += std::pow(score.shift.standard_error / count, 2);
        }
        model.errors = {{ranked.profile, ranked.standard_error},
                        {ranked.near, ranked.near_error},
                        {ranked.far, ranked.far_error},
                        {ranked.total, std::sqrt(total)},
                        {ranked.shift, std::sqrt(shift)},
                        {ranked.oblique},
                        {ranked.shape}};
    }
    Figure figure = modelErrorsFigure(models, {"R_d", "near", "far", "total", "shift", "oblique", "shape"},
                                      fmt::format("Errors on {}", ranking.subject.name));
    figure.caption += fmt::format(" Shift, oblique and shape under a beam at {}°; the others under a normal one.",
                                  prettyNumber(ranking.effort.angle_deg));
    return figure;
}

}  // namespace

std::string percentText(double part) {
    if (!std::isfinite(part)) return "–";
    // Beyond ten times the light a number tells no more than that.
    return part > 10 ? ">1000 %" : fmt::format("{:.1f} %", 100 * part);
}

std::string evaluationText(double ns) { return prettyNumber(ns, 2) + " ns"; }

RankingNoise rankingNoise(const Ranking& ranking) {
    RankingNoise noise;
    const double count = static_cast<double>(ranking.channels.size());
    int shifts = 0, planes = 0;
    for (std::size_t i = 0; i < ranking.channels.size(); ++i) {
        const RankReference& reference = ranking.reference[i];
        const RankScore& any = ranking.ranked.front().channels[i];
        noise.profile += any.curve.noise / count;
        noise.total += reference.total.standard_error / reference.total.mean / count;
        if (!std::isnan(any.shift.mean)) {
            noise.shift += reference.mean_x_mm.standard_error / std::abs(reference.mean_x_mm.mean);
            ++shifts;
        }
        if (!reference.plane.empty()) {
            noise.plane += any.oblique_noise;
            ++planes;
        }
    }
    // NaN where no channel's is known.
    noise.shift /= shifts;
    noise.plane /= planes;
    return noise;
}

std::string rankingMeaning(const Ranking& ranking) {
    return fmt::format(
        "R_d: ∫ |model − reference| 2πr dr over ∫ reference 2πr dr, under a normal beam; near and far: the same within "
        "and beyond one transport mean free path 1/σt′, each over its own light. Total: diffuse reflectance. Shift: "
        "mean "
        "x under a beam at {0}°; 100 % is no shift at all. Oblique: ∫ |model − reference| over the plane under that "
        "beam, "
        "to four mean free paths; shape: after scaling the model to the true light. {1}Rank =: the reference's noise "
        "does "
        "not tell it from another.",
        prettyNumber(ranking.effort.angle_deg),
        ranking.channels.size() > 1 ? "Means over the channels that scatter. " : "");
}

std::string rankingText(const Ranking& ranking, const std::vector<RankEntry>& entries) {
    std::string text = summaryOf(ranking, entries) + "\n" + noiseText(ranking) + "\n\n" +
                       fmt::format("{:<5} {:<36} {:>8} {:>7} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", "rank",
                                   "model", "R_d", "+-", "near", "far", "total", "shift", "oblique", "shape", "cost");
    for (const RankedModel& model : ranking.ranked)
        text += fmt::format("{:<5} {:<36} {:>8} {:>7} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}\n", rankText(model),
                            entries[model.model].id, percentText(model.profile), noisePercent(model.standard_error),
                            percentText(model.near), percentText(model.far), percentText(model.total),
                            percentText(model.shift), percentText(model.oblique), percentText(model.shape),
                            evaluationText(ranking.cost_ns[model.model]));
    text += "\n";
    for (const RankedModel& model : ranking.ranked)
        text += fmt::format("{}: {}.\n", entries[model.model].id, ranking.sentence(model));
    return text;
}

Json rankingJson(const Ranking& ranking, const std::vector<RankEntry>& entries) {
    Json models = Json::array();
    for (const RankedModel& model : ranking.ranked) {
        Json ties = Json::array(), channels = Json::array();
        for (const std::size_t tie : model.ties) ties.push_back(entries[tie].id);
        for (std::size_t i = 0; i < model.channels.size(); ++i) {
            Json channel{{"channel", channelName(ranking.subject.medium, ranking.channels[i])}};
            channel["error"] = scoreJson(model.channels[i]);
            channel["fails"] = failureText(ranking.reference[i], model.channels[i], ranking.effort.angle_deg);
            channels.push_back(std::move(channel));
        }
        models.push_back({{"id", entries[model.model].id},
                          {"label", entries[model.model].label},
                          {"rank", model.rank},
                          {"ties", ties},
                          {"error",
                           {{"profile", numberJson(model.profile)},
                            {"near", numberJson(model.near)},
                            {"far", numberJson(model.far)},
                            {"total", numberJson(model.total)},
                            {"shift", numberJson(model.shift)},
                            {"oblique", numberJson(model.oblique)},
                            {"shape", numberJson(model.shape)},
                            {"stderr", numberJson(model.standard_error)}}},
                          {"cost_ns", ranking.cost_ns[model.model]},
                          {"fails", ranking.sentence(model)},
                          {"channels", channels}});
    }
    return {{"material", subjectJson(ranking.subject)}, {"models", models}, {"reference", referenceJson(ranking)}};
}

Report rankingReport(const Ranking& ranking, std::vector<RankEntry>& entries) {
    Report report;
    report.title = fmt::format("{}: models in order of their error", ranking.subject.name);
    report.summary = summaryOf(ranking, entries);
    ReportSection order{.heading = "Order", .paragraphs = {noiseText(ranking)}};
    order.tables.push_back(rankingTable(ranking, entries));
    order.figures.push_back(errorsFigure(ranking, entries));
    ReportSection curves{.heading = "Curves"};
    for (std::size_t i = 0; i < ranking.channels.size(); ++i) {
        const std::vector<PencilCurve> models = rankedCurves(ranking, i, entries);
        const PencilReference reference = rankedReference(ranking, i);
        PencilOptions options{.channel = static_cast<PlotChannel>(ranking.channels[i]),
                              .x_scale = AxisScale::square_root,
                              .material = ranking.subject.name};
        curves.figures.push_back(pencilFigure(models, &reference, options));
        curves.figures.push_back(relativeErrorFigure(models, reference, options));
    }
    ReportSection channels{.heading = "Channels"};
    channels.tables.push_back(channelTable(ranking, entries));
    for (const std::string& note : ranking.subject.notes) channels.paragraphs.push_back(note);
    report.sections = {std::move(order), std::move(curves), std::move(channels)};
    return report;
}

}  // namespace searchlight
