// The rows of conventions.cpp, each made in a file of its own family, and what those files share.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "model/convention/convention.h"

namespace searchlight::convention {

Convention physical();
Convention albedoAndMeanFreePath();
Convention reflectance();
Convention burley();
Convention chiang();
Convention cycles();
Convention cyclesLegacy();
Convention cyclesSkin();
Convention cyclesBurley();
Convention openPbr();
Convention standardSurface();
Convention unreal();
Convention unity();
Convention pbrt();
Convention renderMan();

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double unlimited = 1e300;

/// Keys that conventions share.
ConventionKey color(std::string name, std::string meaning);
ConventionKey lengths(std::string name, std::string unit, std::string meaning);
ConventionKey number(std::string name, double value, double min, double max, std::string meaning,
                     std::string unit = {});
ConventionKey eta(std::string name = "eta");

/// A key's one number, or its number of a channel.
double one(const ConventionValues& values, std::string_view key);
double at(const ConventionValues& values, std::string_view key, int channel);

/// 1 when every key holds one number.
int channelsOf(const ConventionValues& values);

/// A grey or RGB medium from what `fill(channel)` returns.
struct Coefficients {
    double sigma_a, sigma_s;
};
template <class Fill>
Medium mediumFrom(const ConventionValues& values, double g, double index, const Fill& fill) {
    Medium medium;
    medium.channels = channelsOf(values);
    medium.eta = index;
    medium.g = {g, g, g};
    for (int c = 0; c < Rgb::channels; ++c) {
        const Coefficients found = fill(c);
        medium.sigma_a[c] = found.sigma_a;
        medium.sigma_s[c] = found.sigma_s;
    }
    return medium;
}

/// One number per channel of the medium; NaN for a channel that does not scatter.
template <class Value>
std::vector<double> perChannel(const Medium& medium, const Value& value) {
    std::vector<double> list;
    for (int c = 0; c < medium.channels; ++c) list.push_back(medium.scatters(c) ? value(c) : nan);
    return list;
}

/// The medium with one g for all channels: as it is, or reduced (sigma_s', g 0) with a note where channels differ or g
/// is outside [min, max].
Medium withOneG(const Medium& medium, double min, double max, std::vector<std::string>& notes);

/// The medium with g = 0 and sigma_s' in place of sigma_s.
Medium reducedMedium(const Medium& medium);

/// Lengths as (factor, scale) with the largest factor 1: what "radius" times "scale" is split into.
double largest(const std::vector<double>& list);
std::vector<double> over(const std::vector<double>& list, double divisor);

/// Notes every channel whose number is NaN although it scatters.
void noteMissing(const Medium& medium, const std::vector<double>& list, std::string_view reason,
                 std::vector<std::string>& notes);

}  // namespace searchlight::convention
