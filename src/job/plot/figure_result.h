// A figure as what a job gives back.
#pragma once

#include "base/figure.h"
#include "job/json.h"
#include "plot/channel.h"

namespace searchlight {

/// The numbers of a figure: labels, units, series; panels and maps where it has them.
Json figureJson(const Figure& figure);

/// Draws into the job's output, or hands the numbers out as CSV. `values`: further keys of the JSON document.
JobResult figureResult(Figure figure, const Job& job, Observer& observer, const Json& values = {});

/// "lin", "log", "sqrt".
AxisScale scaleNamed(const std::string& name);

/// "R", "G", "B", "luminance".
PlotChannel channelNamed(const std::string& name);

}  // namespace searchlight
