#include "plot/channel.h"

#include <cmath>

namespace searchlight {

std::string_view channelName(PlotChannel channel) {
    constexpr std::string_view names[] = {"red", "green", "blue", "luminance"};
    return names[static_cast<int>(channel)];
}

double pick(const Rgb& value, PlotChannel channel) {
    return channel == PlotChannel::luminance ? luminance(value) : value[static_cast<int>(channel)];
}

double pickError(const Rgb& error, PlotChannel channel) {
    return channel == PlotChannel::luminance ? std::hypot(0.2126 * error.r, 0.7152 * error.g, 0.0722 * error.b)
                                             : error[static_cast<int>(channel)];
}

}  // namespace searchlight
