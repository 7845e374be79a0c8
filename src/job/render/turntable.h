// A render job once around its object: frames of a film.
#pragma once

#include <string>

#include "job/engine.h"
#include "job/job.h"

namespace searchlight {

/// The path with its run of '#' replaced by the number, padded with zeros to the run's length: "a_####.png", 7 is
/// "a_0007.png". Throws a usage Error for a path without '#', and one with two runs.
std::string framePath(const std::string& pattern, int frame);

/// Renders the frames of a job whose option `turntable` says how many: the camera goes once around, from the scene's
/// azimuth towards larger ones, and the last frame stands a step before the first. All frames share the distance from
/// which the object fits into each of them and the exposure that suits the first.
JobResult renderTurntable(const Job& job, Engine& engine, Observer& observer);

}  // namespace searchlight
