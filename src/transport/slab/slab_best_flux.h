// From what walks through layers foresaw to the slots of a tally.
#pragma once

#include <vector>

#include "transport/slab/slab_best.h"

namespace searchlight {

/// Adds what is known of `walks` walks: what collides first, and order 1 of a pencil at normal incidence.
void addKnown(const SlabBestPlan& plan, double walks, SlabBestSums& found);

/// The shape of what these chunks found, at least one.
SlabShape shapeOf(const SlabBestPlan& plan, const std::vector<SlabBestSums>& all);

/// What `walks` walks found, in the slots of the plan's layout. better: the same from other walks that know R, T and
/// absorption in the layers better; to these the series are levelled, unless it is empty.
std::vector<double> fluxOf(const SlabBestPlan& plan, SlabBestSums found, double walks,
                           const std::vector<double>& better);

}  // namespace searchlight
