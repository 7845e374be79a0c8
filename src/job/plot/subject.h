// The material a job is about.
#pragma once

#include <string>
#include <vector>

#include "job/engine.h"
#include "job/job.h"

namespace searchlight {

struct Subject {
    std::string name;    ///< for titles: "Skin1", or "sigma_a 0.0041, sigma_s 2.62 ..."
    std::string id;      ///< "skin1", or "custom"
    std::string source;  ///< table, or "given"
    Medium medium;
    std::vector<std::string> notes;  ///< what a reader must know: reduced coefficients, unreachable targets...
    bool comparable = true;          ///< false: its table states no unit
};

/// Resolves scene.material: by name, by coefficients, or from (Rdr, ld) through a model's inversion. Throws Error.
Subject subjectOf(const Job& job, Engine& engine);

/// The same, and refuses a material whose unit is unknown.
Subject comparableSubjectOf(const Job& job, Engine& engine);

/// "R", "G", "B", or "" for a medium of a single channel.
std::string channelName(const Medium& medium, int channel);

}  // namespace searchlight
