// Options that several commands have, so that one name means one thing.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/param.h"
#include "job/command.h"

namespace searchlight::option {

inline constexpr double unlimited = 1e300;

/// One model, or several; settings of the one.
Param model();
Param models();
Param set();

/// What evaluates a model.
Param backend();

/// What walks: the CPU or OpenGL.
Param walkBackend();

/// Angle of incidence, degrees.
Param angle();

/// Several angles of incidence, degrees.
Param angles(std::vector<double> value);

/// Threads of parallel work; 0: all.
Param threads();

/// How many random walks; `value` is the default.
Param walks(double value, std::string name = "walks", std::string doc = "random walks per channel", double min = 1);

/// When random walks may stop early, and the file that they are kept in (job/saved_walks.h).
Param untilError(std::string_view of_what);
Param resume();

/// Radial bins, and the radius that they end at.
Param radiiMax();
Param bins(double value);

/// The bins' edges themselves. edgesGiven() throws a usage Error where bins or their radius are given too.
Param edges();
bool edgesGiven(const Options& options);

/// Cells per side of a square tally of something, and half of its side.
Param grid(std::string_view of_what);
Param gridExtent();
/// Throws a usage Error where the one is given without the other.
void requireGridExtent(const Options& options);

/// Of a plot: channel, scale of an axis, the one model to show.
Param channel();
Param scale(std::string name, std::string value);
Param solo();

}  // namespace searchlight::option
