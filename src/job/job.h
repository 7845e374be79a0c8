// A Job is plain data: what the command line, a job file, the window and a test all build, and run() carries out.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/observer.h"
#include "base/param.h"
#include "scene/scene.h"

namespace searchlight {

struct Job {
    std::string command;  ///< a name of commands(): "profile", "reference halfspace"
    Scene scene;          ///< material, object, camera, lights; commands read what they need of it
    ParamValues options;  ///< by the names of the command's Params; absent: default
    std::uint64_t seed = 1;
    std::string output;  ///< a file or folder; empty: only the result's text
    std::string window;  ///< a JSON object that the window keeps beside the job; it changes no result. Empty: none
};

/// `{"format": "searchlight-job/1", "command", "scene", "options", "seed", "output", "window"}`. Throws an input Error
/// with file, line and column for JSON that cannot be read, with the JSON pointer for a value that makes no sense; a
/// newer format and unknown keys are refused by name.
Job parseJob(std::string_view text, std::string_view path);

/// The text that parseJob reads back as the same job.
std::string jobJson(const Job& job);

struct JobResult {
    std::string text;          ///< for people
    std::string json;          ///< for machines; one document
    bool passed = true;        ///< false: a check failed (exit code 1)
    bool interrupted = false;  ///< stopped early, with what there was until then
    std::string failure;       ///< why a file could not be written; all else is here. Empty: none failed
};

class Engine;

/// Does the work. Where `output` cannot be written, that is said before the work. Throws Error. An engine that is kept
/// spares the next job the start of OpenGL.
JobResult run(const Job& job, Observer& observer);
JobResult run(const Job& job, Engine& engine, Observer& observer);

/// The model files that the job reads: what to watch for changes.
std::vector<std::string> modelFiles(const Job& job);

}  // namespace searchlight
