#include "job/paper/paper_studio.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <ctime>
#include <optional>

#include "base/error.h"
#include "geometry/point_cache.h"
#include "job/render/render_material.h"

namespace searchlight {

namespace {

constexpr std::size_t truth_points = 200'000;
constexpr double truth_error = 0.001;

// Of the distance from which an object fills 70 % of the height: sheets are small.
constexpr double nearer = 0.75;

// Radiance behind an object that is shown, after exposure.
constexpr float ground = 0.02F;

// Processor time of all threads.
double cpuMs() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

std::optional<CacheFolder> shapeCache() {
    try {
        return userPointCache();
    } catch (const Error&) {
        return std::nullopt;
    }
}

PaperStudio::PaperStudio(const PaperRun& run, Observer& observer) : run_(run), observer_(observer) {
    if (run.size > 0) width = std::max(1, run.size * 4 / 5), height = run.size;
    scene.object = run.object;
    scene.lights = {PointLight{.position = {0.9, 1.1, 1.1}}};
}

PaperPicture PaperStudio::prepare(const std::string& technique, const ParamValues& options, std::uint64_t seed) {
    std::unique_ptr<Renderer>& renderer = renderers_[technique];
    if (!renderer) renderer = std::make_unique<Renderer>(materialSource(run_.engine, "cpu"));
    renderer->setSettings({.width = width,
                           .height = height,
                           .points = truth_points,
                           .technique = technique,
                           .technique_options = options,
                           .seed = seed,
                           .threads = run_.threads,
                           .points_cache = shapeCache()});
    if (scene.camera.distance == 0) {
        renderer->setScene(scene);
        renderer->start(observer_);
        scene.camera.distance = nearer * renderer->report().camera.distance;
    }
    renderer->setScene(scene);
    PaperPicture picture;
    const double begin = cpuMs();
    renderer->start(observer_);
    picture.prepare_cpu_ms = cpuMs() - begin;
    const RenderReport& report = renderer->report();
    picture.receivers = report.receivers;
    picture.camera = report.camera;
    return picture;
}

PaperPicture PaperStudio::take(const std::string& technique, const ParamValues& options, std::uint64_t seed) {
    PaperPicture picture = prepare(technique, options, seed);
    Renderer& renderer = *renderers_.at(technique);
    const double begin = cpuMs();
    while (!renderer.step(observer_)) {
    }
    picture.sum_cpu_ms = cpuMs() - begin;
    picture.image = renderer.image(observer_);
    picture.exposure = renderer.report().exposure;
    picture.report = renderer.report().technique;
    return picture;
}

PaperPicture PaperStudio::truth() { return take("hierarchical", {{"error", truth_error}}); }

RenderStages PaperStudio::stages(const std::string& technique) const {
    const auto renderer = renderers_.find(technique);
    assert(renderer != renderers_.end());
    return renderer->second->stages();
}

double errorOf(const PaperPicture& picture, const PaperPicture& truth) {
    return compareImages(picture.image, truth.image, {.perceptual = false}).relative_rmse;
}

double whereItFallsTo(double wanted, const std::vector<double>& x, const std::vector<double>& errors) {
    assert(x.size() >= 2 && x.size() == errors.size());
    std::size_t upper = 1;
    while (upper + 1 < x.size() && errors[upper] > wanted) ++upper;
    const double from = std::log(errors[upper - 1]), to = std::log(errors[upper]);
    const double part = (std::log(wanted) - from) / (to - from);
    return std::exp(std::log(x[upper - 1]) + part * std::log(x[upper] / x[upper - 1]));
}

SheetCell shownCell(const Image& image, double exposure, std::string note) {
    Image shown = image;
    const float behind = ground * static_cast<float>(std::exp2(-exposure));
    for (Rgba& pixel : shown.pixels) {
        const float rest = (1 - pixel.a) * behind;
        pixel = {pixel.r + rest, pixel.g + rest, pixel.b + rest, 1};
    }
    return pictureCell(shown, exposure, std::move(note));
}

std::string studioText(const PaperRun& run) {
    Observer silent;
    const PaperStudio studio(run, silent);
    return fmt::format("{}, {} x {} pixels, one point light", run.object, studio.width, studio.height);
}

std::string percentOf(double fraction) {
    const double percent = 100 * fraction;
    return fmt::format("{:.{}f} %", percent, percent < 1 ? 2 : percent < 10 ? 1 : 0);
}

ContactSheet paperSheet(const PaperStudio& studio, std::string title, std::string caption) {
    ContactSheet sheet;
    sheet.title = std::move(title);
    sheet.caption = std::move(caption);
    // Two pixels of a picture for one of the sheet.
    sheet.picture_width = std::max(60, studio.width / 2);
    sheet.picture_height = std::max(1, sheet.picture_width * studio.height / studio.width);
    return sheet;
}

}  // namespace searchlight
