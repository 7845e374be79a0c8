// A ranking in words, in JSON, and as a page.
#pragma once

#include <span>
#include <string>

#include "draw/report.h"
#include "job/json.h"
#include "job/rank/ranking.h"

namespace searchlight {

/// "12.3 %", ">1000 %", or a dash for what is not finite.
std::string percentText(double part);
/// "66 ns"
std::string evaluationText(double ns);

/// How well the reference is known, relative, mean over the channels; the shift and R_d(x, y) of the oblique
/// beam over those where they are known at all.
struct RankingNoise {
    double profile = 0, total = 0, shift = 0, plane = 0;
};
RankingNoise rankingNoise(const Ranking& ranking);

/// What the columns mean, for a caption.
std::string rankingMeaning(const Ranking& ranking);

/// The table and a sentence per model.
std::string rankingText(const Ranking& ranking, const std::vector<RankEntry>& entries);

/// "material", "models" in order of rank, "reference" with its own errors; docs/ranking.md describes it.
Json rankingJson(const Ranking& ranking, const std::vector<RankEntry>& entries);

/// With figures: the errors, and every model's curve and relative error for each channel.
Report rankingReport(const Ranking& ranking, std::vector<RankEntry>& entries);

// Many materials (ranking_matrix.cpp): one row each, one column per model.
std::string matrixText(std::span<const Ranking> rankings, const std::vector<RankEntry>& entries);
Json matrixJson(std::span<const Ranking> rankings, const std::vector<RankEntry>& entries);
Report matrixReport(std::span<const Ranking> rankings, const std::vector<RankEntry>& entries);

}  // namespace searchlight
