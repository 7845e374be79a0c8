// Every model on a material beside its reference, in order of their errors: what `rank` computes.
#pragma once

#include <string>
#include <vector>

#include "job/engine.h"
#include "job/plot/subject.h"
#include "plot/pencil.h"
#include "validate/rank_walk.h"

namespace searchlight {

/// A model that takes part, loaded once for all materials.
struct RankEntry {
    std::string id;  ///< as it was named: "better_dipole:Moments=exact"
    std::string label;
    LoadedModel loaded;
};

/// One material.
struct Ranking {
    Subject subject;
    std::vector<int> channels;             ///< those that scatter
    std::vector<RankWalks> walks;          ///< one per channel
    std::vector<RankReference> reference;  ///< of those walks
    std::vector<RankedModel> ranked;       ///< sorted; `model` is an index into the entries
    std::vector<double> cost_ns;           ///< per entry: one evaluation of all channels, in a batch
    RankEffort effort;

    /// "too low near the beam: ...", about the channel where the model's error is largest, which is named where there
    /// are several.
    std::string sentence(const RankedModel& model) const;
};

/// Why "all" leaves a model out: it does not read the medium, or has lengths of its own, such as the thickness of a
/// slab; on many materials also where it takes too long. Empty: it takes part.
std::string whyNotRanked(const Model& model, bool many_materials);

/// "all": every shipped model that takes part, and where a model leaves single scattering out and one of single
/// scattering ships, their sum as well. Throws a usage Error when none is named.
std::vector<RankEntry> rankEntries(const std::vector<std::string>& names, bool many_materials, std::string_view backend,
                                   Engine& engine);

/// Throws an input Error when no channel scatters, interruptedError() when the observer cancels.
Ranking rankOn(const Subject& subject, std::vector<RankEntry>& entries, const RankEffort& effort, Observer& observer);

/// The reference of one channel and every model's curve beside it, for figures.
PencilReference rankedReference(const Ranking& ranking, std::size_t channel);
std::vector<PencilCurve> rankedCurves(const Ranking& ranking, std::size_t channel, std::vector<RankEntry>& entries);

}  // namespace searchlight
