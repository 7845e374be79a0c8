// What the searchlight plot shows: a section of the workspace.
#pragma once

#include <QString>
#include <vector>

#include "base/param.h"
#include "gui/state/state.h"
#include "job/live/live_plot.h"

namespace searchlight::gui {

/// View, channel, scales, angle, reference.
std::vector<Param> plotOptions();

/// What is to be drawn of that state: its visible models; of the solo one alone where there is one.
LiveRequest plotRequest(const State& state);

/// The slots that plotRequest(state).models stand for, as indices into state.models.
std::vector<int> plottedSlots(const State& state);

/// The `plot` command that draws the same, for the clipboard.
QString plotCommandLine(const State& state);

}  // namespace searchlight::gui
