#include "job/contest/contest_cell.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <limits>

#include "base/files.h"
#include "base/version.h"
#include "io/image_file.h"
#include "job/render/kept_renderer.h"
#include "job/render/render_material.h"

namespace searchlight {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Short pictures are drawn again until that has passed, for clocks and caches; at most so often.
constexpr double enough_ms = 500;
constexpr int most_frames = 6;

double milliseconds(Clock::time_point since) {
    return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

double cpuMilliseconds(std::clock_t since) {
    return 1000.0 * static_cast<double>(std::clock() - since) / CLOCKS_PER_SEC;
}

// The same light twice as strong: all that depends on light is computed anew, and takes as long.
Scene brighter(Scene scene) {
    for (Light& light : scene.lights)
        std::visit(
            [](auto& each) {
                if constexpr (requires { each.irradiance; })
                    each.irradiance = 2 * each.irradiance;
                else
                    each.intensity = 2 * each.intensity;
            },
            light);
    return scene;
}

// Stages that a change of light leaves valid.
constexpr Stage kept_stages[] = {Stage::object, Stage::rays, Stage::material, Stage::points, Stage::visible};

fs::path cellPath(const fs::path& folder, const ContestCell& cell, std::string_view ending) {
    return folder / "cells" / fmt::format("{}{}", cell.stem, ending);
}

Json jobOf(const ContestCell& cell) { return Json::parse(jobJson(cell.job)); }

}  // namespace

struct ContestRenderer::Impl {
    Renderer renderer;
    Scene scene;
    bool first = true;

    struct Frame {
        double wall_ms = 0, cpu_ms = 0;
        std::map<std::string, double> stage_ms;
    };

    Frame frame(const Scene& shown, Observer& observer) {
        renderer.setScene(shown);
        const auto begin = Clock::now();
        const std::clock_t cpu_begin = std::clock();
        renderer.start(observer);
        while (!renderer.step(observer)) {
        }
        Frame timed{.wall_ms = milliseconds(begin), .cpu_ms = cpuMilliseconds(cpu_begin)};
        const RenderReport& report = renderer.report();
        if (report[Stage::irradiance].ms > 0) timed.stage_ms["irradiance"] = report[Stage::irradiance].ms;
        for (const auto& [name, ms] : report.technique.stage_ms)
            if (ms > 0) timed.stage_ms[name] = ms;
        return timed;
    }
};

ContestRenderer::ContestRenderer(const Contestant& contestant, Engine& engine)
    : impl_(new Impl{.renderer = Renderer(materialSource(engine, contestant.gl ? "gl" : "auto"),
                                          contestant.gl ? &engine.context() : nullptr),
                     .scene = contestant.cells.front().job.scene}) {}

ContestRenderer::~ContestRenderer() = default;

CellRun ContestRenderer::render(const ContestCell& cell, Observer& observer) {
    const Scene other = brighter(impl_->scene);
    impl_->renderer.setSettings(renderSettings(cell.job));
    CellRun run;
    const Impl::Frame cold = impl_->frame(other, observer);
    for (const Stage stage : kept_stages)
        if (const double ms = impl_->renderer.report()[stage].ms; ms > 0)
            run.shared_ms[std::string(stageName(stage))] = ms;
    run.wall_ms = run.cpu_ms = std::numeric_limits<double>::infinity();
    double spent = 0;
    const auto time = [&](const Scene& scene) {
        Impl::Frame frame = impl_->frame(scene, observer);
        spent += frame.wall_ms;
        ++run.frames;
        run.cpu_ms = std::min(run.cpu_ms, frame.cpu_ms);
        if (frame.wall_ms >= run.wall_ms) return;
        run.wall_ms = frame.wall_ms;
        run.stage_ms = std::move(frame.stage_ms);
    };
    time(impl_->scene);
    run.image = impl_->renderer.image(observer);
    run.notes = impl_->renderer.report().notes;
    for (int i = 0; spent < enough_ms && run.frames < most_frames; ++i) time(i % 2 == 0 ? other : impl_->scene);
    // What the technique itself made once, such as an atlas.
    for (const auto& [name, ms] : cold.stage_ms)
        if (!run.stage_ms.contains(name)) run.shared_ms[name] = ms;
    return run;
}

void writeCell(const fs::path& folder, const ContestCell& cell, const CellRun& run) {
    makeFolder(folder / "cells");
    writeImage(cellPath(folder, cell, ".exr").string(), {run.image, {}, {{"job", jobJson(cell.job)}}});
    const Json json{{"format", "searchlight-contest-cell/1"},
                    {"version", version()},
                    {"job", jobOf(cell)},
                    {"wall_ms", run.wall_ms},
                    {"cpu_ms", run.cpu_ms},
                    {"frames", run.frames},
                    {"stage_ms", run.stage_ms},
                    {"shared_ms", run.shared_ms},
                    {"notes", run.notes}};
    writeFile(cellPath(folder, cell, ".json"), jsonText(json) + "\n");
}

std::optional<CellRun> readCell(const fs::path& folder, const ContestCell& cell) {
    const fs::path numbers = cellPath(folder, cell, ".json"), picture = cellPath(folder, cell, ".exr");
    if (std::error_code error; !fs::exists(numbers, error) || !fs::exists(picture, error)) return std::nullopt;
    const Json json = Json::parse(readFile(numbers), nullptr, false);
    if (!json.is_object() || json.value("version", Json()) != Json(version()) ||
        json.value("job", Json()) != jobOf(cell))
        return std::nullopt;
    CellRun run{.image = readImage(picture.string()).image, .found = true};
    try {
        run.wall_ms = json.at("wall_ms").get<double>();
        run.cpu_ms = json.at("cpu_ms").get<double>();
        run.frames = json.at("frames").get<int>();
        run.stage_ms = json.at("stage_ms").get<std::map<std::string, double>>();
        run.shared_ms = json.at("shared_ms").get<std::map<std::string, double>>();
        run.notes = json.at("notes").get<std::vector<std::string>>();
    } catch (const Json::exception&) {
        return std::nullopt;  // not written by this program: it is drawn anew
    }
    if (run.image.width <= 0) return std::nullopt;
    return run;
}

void ContestProgress::say() const {
    const auto now = Clock::now();
    const double spent = std::chrono::duration<double>(now - start_).count();
    const double in_this = std::chrono::duration<double>(now - last_).count();
    // A thousandth is always left, however long a picture takes beyond what was expected.
    const double left = std::max(left_ - in_this, 0.001 * (spent + 1));
    const double part = spent / (spent + left);
    observer_.progress("contest", static_cast<std::uint64_t>(1e6 * part), 1'000'000, "ppm");
}

}  // namespace searchlight
