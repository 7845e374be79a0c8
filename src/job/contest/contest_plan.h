// What a contest renders: one scene by techniques at budgets.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "job/job.h"
#include "render/technique.h"

namespace searchlight {

/// One picture.
struct ContestCell {
    std::size_t contestant = 0;
    double budget = 0;        ///< value of the option that buys accuracy; 0 where there is none
    std::string budget_text;  ///< "1600 samples"; empty where there is none
    std::string stem;         ///< of its files
    Job job;                  ///< of `render`, without output
};

/// A technique on a backend, with options that are the same at all budgets.
struct Contestant {
    std::string label;  ///< "direct, sampling area"
    const TechniqueEntry* entry = nullptr;
    bool gl = false;
    std::size_t color = 0;           ///< the same on both backends
    std::vector<ContestCell> cells;  ///< from cheap to dear
};

struct ContestPlan {
    Scene scene;  ///< without what is the same for all: coat, ground, and black behind
    int width = 0, height = 0;
    std::vector<Contestant> contestants;
    std::vector<std::pair<std::string, std::string>> left_out;  ///< technique, why
};

/// From the options of a contest job. `radial`: the model's profile says all of it. Throws a usage Error for what no
/// technique takes, and where a technique that was asked for by name cannot take part.
ContestPlan contestPlan(const Job& job, bool radial);

/// What the command takes of the options of `render`, for all pictures.
const std::vector<Param>& contestPictureOptions();

}  // namespace searchlight
