// A ranking in words, in JSON, and as a page.
#pragma once

#include <span>
#include <string>

#include "draw/report.h"
#include "job/json.h"
#include "job/ranking.h"

namespace searchlight {

/// The table and a sentence per model.
std::string rankingText(const Ranking& ranking, const std::vector<RankEntry>& entries);

/// "material", "models" in order of rank, "reference" with its own errors; docs/ranking.md describes it.
Json rankingJson(const Ranking& ranking, const std::vector<RankEntry>& entries);

/// With figures: the errors, and every model's curve and relative error for each channel.
Report rankingReport(const Ranking& ranking, std::vector<RankEntry>& entries);

/// Many materials: one row each, one column per model.
std::string matrixText(std::span<const Ranking> rankings, const std::vector<RankEntry>& entries);
Json matrixJson(std::span<const Ranking> rankings, const std::vector<RankEntry>& entries);
Report matrixReport(std::span<const Ranking> rankings, const std::vector<RankEntry>& entries);

}  // namespace searchlight
