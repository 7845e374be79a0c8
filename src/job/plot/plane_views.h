// What the plots of oblique light and the papers' figures stand on: models and reference over the same parts of the
// plane, per unit incident flux.
#pragma once

#include <string>
#include <vector>

#include "job/plot/curves.h"
#include "model/plane_means.h"
#include "plot/oblique.h"
#include "plot/slice.h"

namespace searchlight {

/// The strip |y| < half_width about the plane of incidence.
struct Strip {
    std::vector<double> edges_mm;
    double half_width_mm = 0;

    std::vector<PlaneCell> cells() const;
};

/// `cells` (even) over [-extent, extent], narrower towards the entry point. extent 0: what of the widest channel can be
/// seen, but 12 mean free paths at most; half_width 0: 1/80 of the extent.
Strip stripOf(const Medium& medium, double extent_mm, double half_width_mm, int cells);

/// A tally's list of every channel; NaN for those that were not walked.
std::vector<Rgb> tallyValues(const ReferenceRun& run, HalfSpaceTally HalfSpaceResult::*order,
                             std::vector<double> HalfSpaceTally::*list);

/// The strip of walks that had one: everything that left.
StripReference stripReference(const ReferenceRun& run);

/// The model's means over cells, per unit incident flux; NaN for channels that do not scatter.
std::vector<Rgb> incidentCellMeans(LoadedModel& loaded, double angle_deg, const std::vector<PlaneCell>& cells);

/// Square cells of [-extent, extent]^2, rows of ascending y.
std::vector<PlaneCell> squareCells(double extent_mm, int cells);

/// Models on a square, beside the reference when its run had such a grid. A model that clamps negative values is also
/// evaluated without.
std::vector<SlicePanel> slicePanels(std::vector<LoadedModel>& models, double angle_deg, double extent_mm, int cells,
                                    const ReferenceRun* run);

/// Which channels a plot of one channel has to walk.
void walkOnly(PlotChannel channel, ReferenceOptions& options);

/// Throws an input Error when the channel of a medium does not scatter.
void requireScattering(const Subject& subject, PlotChannel channel);

/// The channel that stands for the plot's: the first for a medium of one channel.
int channelIndex(const Medium& medium, PlotChannel channel);

/// "Monte Carlo, 10^6 walks".
std::string walksLabel(const ReferenceRun& run);

}  // namespace searchlight
