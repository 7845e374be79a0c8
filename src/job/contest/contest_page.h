// A contest as a page, figures, a sheet of pictures, and tables.
#pragma once

#include <filesystem>
#include <vector>

#include "draw/report.h"
#include "job/contest/contest_score.h"

namespace searchlight {

/// All that a contest found.
struct ContestResult {
    const ContestPlan* plan = nullptr;
    const std::vector<std::vector<CellRun>>* runs = nullptr;  ///< [contestant][cell]
    const ReferencePicture* direct = nullptr;
    const ReferencePicture* walked = nullptr;
    ContestScore score;
    std::vector<BackendStandings> standings;
    bool cpu_time = false;               ///< what the figures and winners go by
    std::string title, sentence;         ///< what is drawn, and who wins where
    std::vector<std::string> not_drawn;  ///< cells that would have taken too long
};

/// Error against time: from direct; and from walks, where there are any.
std::vector<Figure> contestFigures(const ContestResult& result);

/// The references, and of each contestant its pictures and their differences from direct, the cheapest on the left.
ContactSheet contestSheet(const ContestResult& result);

/// A row per picture.
std::string contestCsv(const ContestResult& result);
Json contestJson(const ContestResult& result);
std::string contestText(const ContestResult& result);

Report contestReport(const ContestResult& result, const std::vector<Figure>& figures, const ContactSheet& sheet);

}  // namespace searchlight
