// Which of a value's channels a plot shows.
#pragma once

#include <string_view>

#include "base/vec.h"

namespace searchlight {

enum class PlotChannel { red, green, blue, luminance };

/// "red", "luminance".
std::string_view channelName(PlotChannel channel);

double pick(const Rgb& value, PlotChannel channel);

/// Channels are walked independently, so that their standard errors add in quadrature.
double pickError(const Rgb& error, PlotChannel channel);

}  // namespace searchlight
