// Finds how far the trees may stay closed for a wanted error, on a sample of the receivers.
#pragma once

#include "render/exitance/dual_tree.h"
#include "render/exitance_sum.h"

namespace searchlight {

/// What a pilot looks at: all of it stays alive meanwhile.
struct PilotInput {
    const PointTree::Impl& points;
    const RadialTable::Impl& table;
    const ReceiverTree::Impl& receivers;
    double error;
    int threads;
};

/// The truth of a sample is the same sum, opened this much further: its own error is as much smaller.
inline constexpr double reference_fineness = 24;

/// Whether the channel has light and the table scatters it: otherwise nothing can be wrong with it.
bool matters(const PilotInput& input, int channel);

/// A sample does not see rare large errors. So a leaf of the points, the smallest thing that is expanded, may be wrong
/// by no more than 20 times the wanted error, and a tenth, in terms of the exitance under even light.
Rgb largestOpening(const PilotInput& input);

/// The rule by which nodes are opened, for parameters that calibrate() found.
Opening openingFor(const PilotInput& input, Rgb opening);

/// The largest parameters of openingFor() that keep the error by an upper confidence limit; the search starts at
/// `first`, where above 0. Parameters of 0 in all channels mean that the sum has to be taken point by point. `key`
/// stays 0.
SumCalibration calibrate(const PilotInput& input, Rgb first);

}  // namespace searchlight
