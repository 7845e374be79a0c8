// From arguments to a Job.
#pragma once

#include <optional>
#include <string>

#include "job/job.h"

namespace searchlight {

struct Arguments {
    std::optional<Job> job;  ///< nothing: print `text` and succeed (--help, --version)
    std::string text;
    bool json = false;       ///< the result's JSON instead of its text
    bool print_job = false;  ///< print the job instead of running it
    bool watch = false;      ///< run it again whenever one of its model files changes
};

/// Throws a usage Error for arguments that make no sense.
Arguments parseArguments(int argc, char** argv);

}  // namespace searchlight
