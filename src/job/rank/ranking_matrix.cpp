#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "job/rank/ranking_page.h"
#include "plot/model_errors.h"

namespace searchlight {

namespace {

// The mark of a cell: the nearest model, and those that noise does not tell from it.
std::string_view markOf(const RankedModel& model) { return model.rank > 1 ? "" : model.ties.empty() ? "*" : "="; }

const RankedModel& rankedOf(const Ranking& ranking, std::size_t entry) {
    return *std::ranges::find(ranking.ranked, entry, &RankedModel::model);
}

// Where most light has been scattered many times before it leaves: what models of diffusion are for.
constexpr double diffuse_albedo = 0.5;

double meanOver(const Ranking& ranking, const Rgb& value) {
    double sum = 0;
    for (const int c : ranking.channels) sum += value[c];
    return sum / static_cast<double>(ranking.channels.size());
}

double meanAlbedo(const Ranking& ranking) { return meanOver(ranking, ranking.subject.medium.alphaPrime()); }

bool isDiffuse(const Ranking& ranking) { return meanAlbedo(ranking) >= diffuse_albedo; }

// Materials on which an entry is nearest or not told from the nearest, and the medians of its errors on diffuse ones.
struct Tally {
    int nearest = 0, nearest_diffuse = 0;
    double profile = 0, shift = 0, oblique = 0, shape = 0;
};

double medianOf(std::vector<double> values) {
    std::erase_if(values, [](double value) { return !std::isfinite(value); });
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

Tally tallyOf(std::span<const Ranking> rankings, std::size_t entry) {
    Tally tally;
    std::vector<double> profiles, shifts, obliques, shapes;
    for (const Ranking& ranking : rankings) {
        const RankedModel& model = rankedOf(ranking, entry);
        tally.nearest += model.rank == 1;
        if (!isDiffuse(ranking)) continue;
        tally.nearest_diffuse += model.rank == 1;
        profiles.push_back(model.profile);
        shifts.push_back(model.shift);
        obliques.push_back(model.oblique);
        shapes.push_back(model.shape);
    }
    tally.profile = medianOf(std::move(profiles));
    tally.shift = medianOf(std::move(shifts));
    tally.oblique = medianOf(std::move(obliques));
    tally.shape = medianOf(std::move(shapes));
    return tally;
}

// One row per material, a percentage per model. `noise` is a member of RankingNoise.
ReportTable matrixTable(std::span<const Ranking> rankings, const std::vector<RankEntry>& entries,
                        double RankedModel::*error, double RankingNoise::*noise) {
    ReportTable table{.header = {"material", "α′", "g", "noise"}};
    for (const RankEntry& entry : entries) table.header.push_back(entry.label);
    for (const Ranking& ranking : rankings) {
        std::vector<std::string> row{ranking.subject.name, fmt::format("{:.4f}", meanAlbedo(ranking)),
                                     fmt::format("{:.2f}", meanOver(ranking, ranking.subject.medium.g)),
                                     percentText(rankingNoise(ranking).*noise)};
        for (std::size_t m = 0; m < entries.size(); ++m) {
            const RankedModel& model = rankedOf(ranking, m);
            row.push_back(percentText(model.*error));
            if (error != &RankedModel::profile) continue;
            // A space as wide as a digit keeps the numbers in line.
            const std::string_view mark = markOf(model);
            row.back() += fmt::format(" {}", mark.empty() ? "\u2007" : mark);
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

}  // namespace

std::string matrixText(std::span<const Ranking> rankings, const std::vector<RankEntry>& entries) {
    std::string text = "Error of R_d, %; * nearest to the reference, = not told from the nearest by its noise\n\n";
    std::size_t names = 8;
    for (const Ranking& ranking : rankings) names = std::max(names, ranking.subject.id.size());
    text += fmt::format("{:<{}} {:>7} {:>6}", "material", names, "albedo'", "noise");
    for (const RankEntry& entry : entries)
        text += fmt::format("  {:>{}}", entry.id, std::max<std::size_t>(7, entry.id.size()));
    text += "\n";
    for (const Ranking& ranking : rankings) {
        text += fmt::format("{:<{}} {:>7.4f} {:>6.2f}", ranking.subject.id, names, meanAlbedo(ranking),
                            100 * rankingNoise(ranking).profile);
        for (std::size_t m = 0; m < entries.size(); ++m) {
            const RankedModel& model = rankedOf(ranking, m);
            const std::string cell =
                std::isfinite(model.profile) ? fmt::format("{:.1f}{:1}", 100 * model.profile, markOf(model)) : "- ";
            text += fmt::format("  {:>{}}", cell, std::max<std::size_t>(7, entries[m].id.size()));
        }
        text += "\n";
    }
    const auto diffuse = std::ranges::count_if(rankings, isDiffuse);
    for (std::size_t m = 0; m < entries.size(); ++m) {
        const Tally tally = tallyOf(rankings, m);
        text += fmt::format("{}{}: nearest, or not told from it, on {} of {} materials", m == 0 ? "\n" : "",
                            entries[m].id, tally.nearest, rankings.size());
        text += fmt::format(", {} of {} with albedo' >= {}", tally.nearest_diffuse, diffuse, diffuse_albedo);
        text +=
            fmt::format("; median errors there: R_d {}, shift {}, oblique {}, shape {}\n", percentText(tally.profile),
                        percentText(tally.shift), percentText(tally.oblique), percentText(tally.shape));
    }
    return text;
}

Json matrixJson(std::span<const Ranking> rankings, const std::vector<RankEntry>& entries) {
    Json materials = Json::array();
    for (const Ranking& ranking : rankings) {
        Json row = rankingJson(ranking, entries);
        const RankedModel& best = ranking.ranked.front();
        row["winner"] = entries[best.model].id;
        row["ties"] = Json::array();
        for (const std::size_t tie : best.ties) row["ties"].push_back(entries[tie].id);
        materials.push_back(std::move(row));
    }
    return materials;
}

Report matrixReport(std::span<const Ranking> rankings, const std::vector<RankEntry>& entries) {
    const auto diffuse = std::ranges::count_if(rankings, isDiffuse);
    ReportTable models{
        .caption = fmt::format("Nearest: also where the reference's noise does not tell it from the nearest. {} of {} "
                               "materials have a mean α′ of at least {}; errors are medians over those.",
                               diffuse, rankings.size(), diffuse_albedo),
        .header = {"model", "nearest on", fmt::format("with α′ ≥ {}", diffuse_albedo), "R_d", "shift", "oblique",
                   "shape", "one evaluation"}};
    std::vector<ErrorsOverAlbedo> scatter;
    std::pair<int, std::string> most;
    for (std::size_t m = 0; m < entries.size(); ++m) {
        const Tally tally = tallyOf(rankings, m);
        if (tally.nearest_diffuse > most.first) most = {tally.nearest_diffuse, entries[m].label};
        models.rows.push_back({entries[m].label, std::to_string(tally.nearest), std::to_string(tally.nearest_diffuse),
                               percentText(tally.profile), percentText(tally.shift), percentText(tally.oblique),
                               percentText(tally.shape), evaluationText(rankings.front().cost_ns[m])});
        ErrorsOverAlbedo errors{.label = entries[m].label};
        for (const Ranking& ranking : rankings)
            for (std::size_t i = 0; i < ranking.channels.size(); ++i) {
                const double albedo = ranking.subject.medium.alphaPrime()[ranking.channels[i]];
                const double error = rankedOf(ranking, m).channels[i].curve.weighted;
                if (albedo == 1 || !std::isfinite(error)) continue;
                errors.albedo.push_back(albedo);
                errors.error.push_back(error);
            }
        scatter.push_back(std::move(errors));
    }
    Report report;
    report.title = fmt::format("Models on {} materials", rankings.size());
    if (most.first > 0)
        report.summary = fmt::format(
            "{} is nearest to the reference, or not told from it, on {} of the {} materials that scatter more than "
            "they "
            "absorb.",
            most.second, most.first, diffuse);
    ReportSection first{.heading = "Models"};
    first.tables.push_back(std::move(models));
    first.figures.push_back(errorsOverAlbedoFigure(scatter, "Error of R_d over absorption"));
    ReportSection second{.heading = "Materials"};
    const auto add = [&](double RankedModel::*error, double RankingNoise::*noise, std::string caption) {
        second.tables.push_back(matrixTable(rankings, entries, error, noise));
        second.tables.back().caption = std::move(caption);
    };
    const std::string angle = prettyNumber(rankings.front().effort.angle_deg);
    add(&RankedModel::profile, &RankingNoise::profile,
        "Error of R_d. *: nearest to the reference; =: not told from the nearest by its noise. " +
            rankingMeaning(rankings.front()));
    add(&RankedModel::shift, &RankingNoise::shift,
        fmt::format("Error of the shift under a beam at {}°; –: the true shift is lost in noise.", angle));
    add(&RankedModel::oblique, &RankingNoise::plane,
        fmt::format("Error of R_d(x, y) under a beam at {}°; –: too little light leaves to know it.", angle));
    add(&RankedModel::shape, &RankingNoise::plane,
        fmt::format("The same for the shape alone: models scaled to the true light. Beam at {}°.", angle));
    report.sections = {std::move(first), std::move(second)};
    return report;
}

}  // namespace searchlight
