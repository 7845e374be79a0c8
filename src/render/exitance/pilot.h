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

/// The rule by which nodes are opened, for parameters that calibrate() found.
Opening openingFor(const PilotInput& input, Rgb opening);

/// The largest parameters of openingFor() that keep the error by an upper confidence limit; the search starts at
/// `first`, where above 0. Parameters of 0 in all channels mean that the sum has to be taken point by point. `key`
/// stays 0.
SumCalibration calibrate(const PilotInput& input, Rgb first);

}  // namespace searchlight
