// Errors of a contest's pictures, and who wins by them.
#pragma once

#include <string>
#include <vector>

#include "job/contest/contest_cell.h"
#include "job/contest/contest_reference.h"
#include "job/contest/standings.h"
#include "validate/image_error.h"

namespace searchlight {

/// An error with the reference's noise taken out.
struct JudgedError {
    double raw = 0;    ///< relative RMSE as measured
    double error = 0;  ///< sqrt(raw^2 - noise^2), or 0
    double lower = 0, upper = 0;
    bool resolved = false;  ///< false: not told from 0, and below `upper`
};

/// `noise`: relative, that of the reference (and of what else is in `raw` but not in question). It is known to 13 %, as
/// the scatter of 32 steps tells it, so its square to 26 %.
JudgedError judged(double raw, double noise);

struct CellScore {
    ImageError against_direct;  ///< whose SSIM and FLIP are at the contest's exposure
    JudgedError direct, walked;
    double walked_mean = 0;  ///< signed, relative
};

struct ContestScore {
    std::vector<std::vector<CellScore>> cells;  ///< [contestant][cell]; shorter where cells were left out
    double exposure = 0;                        ///< stops that suit the picture
    JudgedError model;      ///< of the model itself: direct against walks, the noise of both taken out
    double model_mean = 0;  ///< signed, relative
};

/// `runs`: [contestant][cell]. Throws as compareImages.
ContestScore scoreContest(const std::vector<std::vector<CellRun>>& runs, const ReferencePicture& direct,
                          const ReferencePicture& walked, int threads);

/// Who wins on one backend.
struct BackendStandings {
    bool gl = false;
    std::vector<std::string> labels;  ///< of the curves
    std::vector<ErrorCurve> curves;
    std::vector<TimeReign> by_time;
    std::vector<ErrorReign> by_error;
    double model_from_ms = 0;  ///< from then on the nearest technique's error is below the model's own; 0: unknown
};

/// Without backends on which nobody takes part. `cpu_time`: by that instead of by wall time.
std::vector<BackendStandings> standingsOf(const ContestPlan& plan, const std::vector<std::vector<CellRun>>& runs,
                                          const ContestScore& score, const ReferencePicture& direct, bool cpu_time);

/// Who wins where, in a sentence.
std::string winnersText(const ContestPlan& plan, const std::vector<BackendStandings>& standings,
                        const ContestScore& score, const ReferencePicture& direct, const ReferencePicture& walked);

}  // namespace searchlight
