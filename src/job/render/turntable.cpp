#include "job/render/turntable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "geometry/object.h"
#include "job/command.h"
#include "job/json.h"
#include "job/render/kept_renderer.h"
#include "job/unit_progress.h"
#include "render/view.h"

namespace searchlight {

namespace {

// Within what a scene file may say.
double wrapped(double azimuth_deg) { return std::remainder(azimuth_deg, 360); }

double azimuthOf(const Job& job, int frame, int frames) {
    return wrapped(job.scene.camera.azimuth_deg + 360.0 * frame / frames);
}

// The distance at which no frame is fuller than a single picture would be: one of its own for each would pump.
double commonDistance(const Job& job, int frames) {
    const RenderSettings settings = renderSettings(job);
    const Object object = placeObject(job.scene);
    double distance = 0;
    for (int frame = 0; frame < frames; ++frame) {
        Camera camera = job.scene.camera;
        camera.azimuth_deg = azimuthOf(job, frame, frames);
        distance = std::max(distance, framedCamera(camera, object, settings.width, settings.height).distance);
    }
    return distance;
}

}  // namespace

std::string framePath(const std::string& pattern, int frame) {
    const std::size_t first = pattern.find('#');
    if (first == std::string::npos)
        throw usageError(fmt::format("'{}' has no place for a frame's number", pattern), "such as frame_####.png");
    const std::size_t end = std::min(pattern.find_first_not_of('#', first), pattern.size());
    if (pattern.find('#', end) != std::string::npos)
        throw usageError(fmt::format("'{}' has two places for a frame's number", pattern), "such as frame_####.png");
    return fmt::format("{}{:0{}}{}", pattern.substr(0, first), frame, end - first, pattern.substr(end));
}

JobResult renderTurntable(const Job& job, Engine& engine, Observer& observer) {
    const int frames = static_cast<int>(Options(job).number("turntable"));
    framePath(job.output, 1);  // so that a mistake is found before the work
    Job picture = job;
    picture.options.erase("turntable");
    Json document = documentJson("searchlight-turntable/1", job);
    document["frames"] = Json::array();
    if (job.scene.camera.distance == 0) picture.scene.camera.distance = commonDistance(job, frames);
    KeptRenderer kept;
    UnitProgress progress(observer, "frames", static_cast<std::uint64_t>(frames));
    JobResult result;
    for (int frame = 0; frame < frames; ++frame) {
        picture.scene.camera.azimuth_deg = azimuthOf(job, frame, frames);
        picture.output = framePath(job.output, frame + 1);
        const JobResult rendered = renderPicture(picture, engine, kept, progress);
        Json numbers = Json::parse(rendered.json);
        if (frame == 0 && Options(job).text("exposure") == "auto")
            picture.options["exposure"] = numberText(numbers.at("exposure").get<double>());
        numbers.erase("job");
        numbers["file"] = picture.output;
        document["frames"].push_back(std::move(numbers));
        if (frame == 0) result.text = rendered.text;
        progress.finish();
    }
    result.text += fmt::format("{} frames: {} to {}\n", frames, framePath(job.output, 1), picture.output);
    result.json = jsonText(document);
    return result;
}

}  // namespace searchlight
