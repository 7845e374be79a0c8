// Which model is nearest to the reference, whether the reference's noise lets one say so, and where each model fails.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/estimate.h"
#include "base/vec.h"
#include "validate/curve_error.h"

namespace searchlight {

/// The truth about one channel of a medium, per unit incident flux.
struct RankReference {
    int channel = 0;                      ///< the component of the values below that is read
    std::vector<double> edges_mm;         ///< of n annuli; split_mm is one of them
    std::vector<Rgb> Rd, standard_error;  ///< mean over each annulus under a normal beam, 1/mm^2
    Estimate total;                       ///< diffuse reflectance under a normal beam
    double split_mm = 0;                  ///< divides near from far: one transport mean free path, 1 / sigma_t'
    Estimate mean_x_mm;                   ///< mean exit point of an oblique beam, which leans towards +x
    /// R_d(x, y) of the same beam, means over square cells: rows of `cells` from -x to +x, cells / 2 rows from the
    /// plane of incidence outwards; both sides of it are one. Empty: not known.
    int cells = 0;
    double cell_mm = 0;
    std::vector<double> plane, plane_error;
};

/// What a model says about the same.
struct RankAnswer {
    std::vector<Rgb> bin_means;
    double total = 0;
    double mean_x_mm = 0;
    std::vector<double> plane;  ///< as the reference's; or empty
};

/// Where the error of a model lies; parts of the integral of |model - reference| 2 pi r dr.
struct ErrorPlace {
    double near_share = 0;  ///< within the split radius, 0 to 1
    double near_sign = 0;   ///< error with its sign over error without, within the split radius: -1 too low, 1 too high
    double far_sign = 0;    ///< and beyond
    double half_mm = 0;     ///< half of the error lies within this radius
};

/// One model on one channel.
struct RankScore {
    CurveError curve;        ///< profile, near and far; each relative to the light that leaves there
    double near_weight = 0;  ///< light of the near field; weighted = near_weight near + (1 - near_weight) far
    /// Of curve.weighted, curve.near and curve.far, from that of the reference.
    double standard_error = 0, near_error = 0, far_error = 0;
    /// What noise adds to curve.weighted on average, since errors of either sign count: all of it for a perfect model,
    /// nothing where the model is off by several standard errors.
    double inflation = 0;
    Estimate total;  ///< relative error of the total, with its sign
    Estimate shift;  ///< relative error of mean x, with its sign: -1 for no shift; NaN: the shift is lost in noise
    /// Integral of |model - reference| over the plane of the oblique beam over that of the reference; `shape`: after
    /// the model was scaled to the reference's light there. NaN: not known.
    double oblique = 0, shape = 0;
    double oblique_noise = 0;  ///< what a perfect model would show
    ErrorPlace place;
};

RankScore rankScore(const RankReference& reference, const RankAnswer& answer);

/// How much farther from the reference model a is than model b, and how much of that the reference's noise may be: two
/// standard errors, and the difference of what it adds. Where both are off to the same side, noise does not tell
/// between them. Annuli are taken as independent.
struct RankGap {
    double gap = 0;
    double noise = 0;
};
RankGap rankGap(const RankReference& reference, const RankAnswer& a, const RankAnswer& b);

/// One sentence, without a full stop, about a score: "too low near the beam: 78 % of its error lies within 0.42 mm".
/// `angle_deg` is that of the shift.
std::string failureText(const RankReference& reference, const RankScore& score, double angle_deg);

/// One model on all channels.
struct RankedModel {
    std::size_t model = 0;  ///< index into the answers
    int rank = 1;           ///< 1 + the number of models that are nearer to the reference beyond its noise
    /// Means over the channels of the absolute errors; a channel where the shift or the plane is
    /// not known is left out of those.
    double profile = 0, near = 0, far = 0, total = 0, shift = 0, oblique = 0, shape = 0;
    double standard_error = 0, near_error = 0, far_error = 0;  ///< of profile, near and far
    std::vector<RankScore> channels;
    std::vector<std::size_t> ties;  ///< models (indices into the answers) that noise does not tell from this one
    std::size_t worst_channel = 0;  ///< index into channels: the largest error of the profile
};

/// Sorted by the error of the profile; models that are not finite come last. answers[model][i] belongs to
/// references[i]. Channels must be walked independently.
std::vector<RankedModel> rankModels(std::span<const RankReference> references,
                                    std::span<const std::vector<RankAnswer>> answers);

}  // namespace searchlight
