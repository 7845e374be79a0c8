// One picture of a contest, with its time; and the time that is left for all.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "base/image.h"
#include "base/observer.h"
#include "job/contest/contest_plan.h"
#include "job/engine.h"
#include "job/json.h"

namespace searchlight {

/// A picture that is done, and what it cost.
struct CellRun {
    Image image;
    double wall_ms = 0;  ///< of a frame with new light; the least of some
    double cpu_ms = 0;   ///< of all threads, of the frame that took least of it
    int frames = 0;
    std::map<std::string, double> stage_ms;   ///< of the frame with the least wall time
    std::map<std::string, double> shared_ms;  ///< of the first frame: what stays when the light changes
    bool found = false;                       ///< was there from an earlier run
    std::vector<std::string> notes;
};

/// Renders the cells of one contestant by one renderer, so that all but the first are warm.
class ContestRenderer {
public:
    /// `engine` outlives this.
    ContestRenderer(const Contestant& contestant, Engine& engine);
    ~ContestRenderer();

    /// Draws until some frames are timed: first one under twice the light, which leaves everything that does not depend
    /// on it, then that asked for.
    CellRun render(const ContestCell& cell, Observer& observer);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// FOLDER/cells/STEM.exr and .json, the numbers last. Throws an input Error.
void writeCell(const std::filesystem::path& folder, const ContestCell& cell, const CellRun& run);

/// What is there from the same job by this version; nothing otherwise.
std::optional<CellRun> readCell(const std::filesystem::path& folder, const ContestCell& cell);

/// Time that is left, from what pictures of the same technique took. What they say about themselves is not passed on.
class ContestProgress : public Observer {
public:
    explicit ContestProgress(Observer& observer) : observer_(observer), start_(std::chrono::steady_clock::now()) {}

    /// Seconds that are still to come, as far as one knows.
    void expect(double seconds) {
        left_ = seconds;
        last_ = std::chrono::steady_clock::now();
        say();
    }

    void progress(std::string_view, std::uint64_t, std::uint64_t, std::string_view) override { say(); }
    void log(LogLevel level, std::string_view message) override { observer_.log(level, message); }
    bool cancelled() const override { return observer_.cancelled(); }

private:
    void say() const;

    Observer& observer_;
    const std::chrono::steady_clock::time_point start_;
    std::chrono::steady_clock::time_point last_ = start_;
    double left_ = 0;
};

}  // namespace searchlight
