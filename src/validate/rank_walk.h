// The reference that models are ranked against: enough walks for the noise asked for, by the estimator that a trial of
// both finds cheaper.
#pragma once

#include "base/observer.h"
#include "transport/half_space/half_space.h"
#include "validate/model_rank.h"

namespace searchlight {

/// How well the reference is to be known, and how much work that may be.
struct RankEffort {
    double noise = 0.005;       ///< of the profile: CurveError::noise
    double shift_noise = 0.01;  ///< relative standard error of mean x
    double plane_noise = 0.03;  ///< of R_d(x, y) of the oblique beam, as CurveError::noise
    /// Of the profile, and again half of it each of the shift and of R_d(x, y), in collisions of the analogue walk,
    /// some 2 to 4 ns of one core each. What it buys stands in the standard errors.
    double collisions = 1e9;
    int bins = 48;
    double angle_deg = 45;  ///< of the oblique beam
    std::uint64_t seed = 1;
    int threads = 0;  ///< 0: all
};

struct RankWalks {
    RankReference reference;
    HalfSpaceResult normal, oblique, plane;  ///< plane: without walks where the work allowed would tell too little
    bool exact = false;                      ///< the normal beam was solved without walks
};

/// Annuli from the beam to where 0.1 % of the light has not yet left, widths growing with the radius, and one more edge
/// at 1 / sigma_t'.
std::vector<double> rankEdges(const HalfSpaceProblem& problem, int bins);

/// One channel of the medium, which scatters. The result depends on medium, channel and effort but for its threads.
/// Throws interruptedError() when the observer cancels.
RankWalks walkForRank(const Medium& medium, int channel, const RankEffort& effort, Observer& observer);

}  // namespace searchlight
