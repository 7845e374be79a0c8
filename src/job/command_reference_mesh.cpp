// reference sphere, reference mesh: the exitance that light in a closed body leaves on its surface, or the radiance
// that a camera sees of it, by Monte Carlo.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/version.h"
#include "geometry/object.h"
#include "io/image_file.h"
#include "job/command_table.h"
#include "job/json.h"
#include "job/picture_options.h"
#include "job/saved_walks.h"
#include "job/shared_options.h"
#include "light/light_sampler.h"
#include "render/cell_view.h"
#include "render/view.h"
#include "transport/mesh/cell_picture.h"
#include "transport/mesh/radiance_body.h"
#include "transport/mesh/reference_body.h"

namespace searchlight {

namespace {

constexpr double kCellPixels = 4;  // area of a cell in pixels, unless it is given

struct Setup {
    Subject subject;
    Object object;
    View view;
    LightSampler lights;
    BodyOptions walk;
    double cell_area_mm2 = 0;
};

Setup setupOf(const Job& job, Engine& engine, const Options& options, const Scene& scene) {
    const PictureSize size = parsePictureSize(options.text("size"));
    Object object = placeObject(scene);
    LightSampler lights(scene, object);
    if (lights.dark()) throw usageError("a reference needs light", "such as --light dir:1,1,1");
    const View view = makeView(scene.camera, object, size.width, size.height);
    const double pixel = 2 * view.tan_half / view.height * length(view.eye);
    const double area = options.number("cell_area");
    return {comparableSubjectOf(job, engine),
            std::move(object),
            view,
            std::move(lights),
            {.walks = static_cast<std::uint64_t>(options.number("walks")),
             .seed = job.seed,
             .threads = static_cast<int>(options.number("threads"))},
            area > 0 ? area : kCellPixels * pixel * pixel};
}

using Channels = std::array<std::optional<BodyResult>, 3>;

// Channels that an interruption leaves without walks are absent.
template <class Body>
Channels walkChannels(const Body& body, const Setup& setup, SavedWalks& saved, Observer& observer) {
    Channels channels;
    bool any = false, interrupted = false;
    for (int c = 0; c < Rgb::channels; ++c) {
        if (!setup.subject.medium.scatters(c)) continue;
        any = true;
        if (interrupted) continue;
        BodyOptions options = setup.walk;
        options.control = saved.control(static_cast<std::size_t>(c));
        BodyResult result = walkBody(body, setup.subject.medium, c, &setup.lights, options, observer);
        interrupted = result.interrupted;
        if (result.candidates > 0) channels[static_cast<std::size_t>(c)] = std::move(result);
    }
    if (!any) throw inputError(fmt::format("{} does not scatter in any channel", setup.subject.name));
    return channels;
}

// One value per channel; null where nothing scatters.
template <class Value>
Json perChannel(const Channels& channels, const Value& value) {
    Json list = Json::array();
    for (const auto& channel : channels) list.push_back(channel ? Json(value(*channel)) : Json());
    return list;
}

Json estimates(const Channels& channels, Estimate BodyResult::*member) {
    return {{"mean", perChannel(channels, [&](const BodyResult& r) { return (r.*member).mean; })},
            {"stderr", perChannel(channels, [&](const BodyResult& r) { return (r.*member).standard_error; })}};
}

void addTotals(Json& document, const Channels& channels) {
    document["incident"] = estimates(channels, &BodyResult::incident);
    document["entered"] = estimates(channels, &BodyResult::entered);
    document["left"] = estimates(channels, &BodyResult::left);
    document["reflectance"] = estimates(channels, &BodyResult::reflectance);
    document["absorbed"] = estimates(channels, &BodyResult::absorbed);
    document["collisions_per_entry"] = estimates(channels, &BodyResult::collisions_per_entry);
    const auto list = [&](const char* name, auto BodyResult::*member) {
        document[name] = perChannel(channels, [&](const BodyResult& r) { return r.*member; });
    };
    list("walks", &BodyResult::arrivals);
    list("entries", &BodyResult::entries);
    list("collisions", &BodyResult::collisions);
    list("surface_tests", &BodyResult::rays);
    list("taken_back", &BodyResult::taken_back);
    list("lost", &BodyResult::lost);
    list("largest_weight", &BodyResult::largest_weight);
    list("seconds", &BodyResult::seconds);
}

CellValues valuesOf(const Channels& channels, std::vector<double> BodyResult::*member) {
    CellValues values;
    for (std::size_t c = 0; c < channels.size(); ++c)
        if (channels[c]) values[c] = *channels[c].*member;
    return values;
}

std::string textOf(const Setup& setup, const Channels& channels) {
    std::string text =
        fmt::format("{:<4} {:>22}  {:>22}  {:>10}  {:>10}\n", "", "reflectance", "absorbed", "walks", "collisions");
    double collisions = 0, seconds = 0;
    int threads = 1;
    std::uint64_t taken_back = 0, lost = 0;
    for (int c = 0; c < Rgb::channels; ++c) {
        const auto& r = channels[static_cast<std::size_t>(c)];
        if (!r) {
            text += fmt::format(
                "{:<4} {}\n", "RGB"[c],
                setup.subject.medium.scatters(c) ? "not reached" : "not applicable: this channel does not scatter");
            continue;
        }
        const auto estimate = [](const Estimate& e) {
            return fmt::format("{:.6f} +- {:.6f}", e.mean, e.standard_error);
        };
        text +=
            fmt::format("{:<4} {:>22}  {:>22}  {:>10.4g}  {:>10.4g}\n", "RGB"[c], estimate(r->reflectance),
                        estimate(r->absorbed), static_cast<double>(r->arrivals), static_cast<double>(r->collisions));
        collisions += static_cast<double>(r->collisions);
        seconds += r->seconds;
        threads = r->threads;
        taken_back += r->taken_back;
        lost += r->lost;
    }
    text += fmt::format("{:.3g} collisions/s on {}, {:.3g} s", collisions / seconds,
                        setup.walk.gl ? "OpenGL" : fmt::format("{} threads", threads), seconds);
    if (taken_back > 0) text += fmt::format("; {} walks taken back inside", taken_back);
    if (lost > 0) text += fmt::format("; {} walks lost by rounding", lost);
    text += "\n";
    for (const std::string& note : setup.subject.notes) text += note + "\n";
    return text;
}

CameraRays raysOf(const View& view) {
    const double pixel = 2 * view.tan_half / view.height;
    return {view.width, view.height, view.eye, view.direction(0, 0), pixel * view.right, (-pixel) * view.up};
}

using RadianceChannels = std::array<std::optional<BodyRadiance>, 3>;

template <class Body>
RadianceChannels walkRadianceChannels(const Body& body, const Setup& setup, SavedWalks& saved, Observer& observer) {
    const CameraRays camera = raysOf(setup.view);
    RadianceOptions options{.seed = setup.walk.seed, .threads = setup.walk.threads};
    const std::uint64_t pixels = camera.pixels();
    options.walks_per_pixel = std::max(std::uint64_t{1}, (setup.walk.walks + pixels / 2) / pixels);
    RadianceChannels channels;
    bool interrupted = false;
    for (int c = 0; c < Rgb::channels && !interrupted; ++c) {
        if (!setup.subject.medium.scatters(c)) continue;
        options.control = saved.control(static_cast<std::size_t>(c));
        if (options.control.until_error > 0)
            throw usageError("--until-error is about reflectance", "leave it out beside --radiance");
        BodyRadiance result = walkRadiance(body, setup.subject.medium, c, &setup.lights, camera, options, observer);
        interrupted = result.interrupted;
        if (result.walks > 0) channels[static_cast<std::size_t>(c)] = std::move(result);
    }
    if (std::ranges::none_of(channels, [](const auto& c) { return c.has_value(); })) {
        if (interrupted) throw interruptedError();
        throw inputError(fmt::format("{} does not scatter in any channel", setup.subject.name));
    }
    return channels;
}

// Values per pixel as a picture, with the part of each pixel that shows the body as its alpha.
Image pictureOf(const CellView& view, const RadianceChannels& channels, std::vector<double> BodyRadiance::*member) {
    Image image{view.width, view.height};
    for (const CellSample& sample : view.samples) image.pixels[sample.pixel].a += sample.coverage;
    for (std::size_t c = 0; c < channels.size(); ++c)
        for (std::size_t i = 0; channels[c] && i < image.pixels.size(); ++i) {
            Rgba& pixel = image.pixels[i];
            (c == 0 ? pixel.r : c == 1 ? pixel.g : pixel.b) = static_cast<float>(((*channels[c]).*member)[i]);
        }
    return image;
}

// Mean over the pixels of a picture that show the body, and its standard error.
Estimate brightnessOf(const BodyRadiance& r) {
    double sum = 0, square = 0;
    for (std::size_t i = 0; i < r.radiance.size(); ++i) {
        sum += r.radiance[i];
        square += r.standard_error[i] * r.standard_error[i];
    }
    const double n = static_cast<double>(r.radiance.size());
    return {sum / n, std::sqrt(square) / n, r.walks};
}

template <class Body>
JobResult finishRadiance(const Job& job, const Setup& setup, const Body& body, std::string_view geometry,
                         Observer& observer) {
    if (setup.walk.gl) throw usageError("--radiance is walked by the CPU", "leave --backend out");
    Json problem{{"scene", Json::parse(jobJson(job)).at("scene")},
                 {"material", subjectJson(setup.subject)},
                 {"radiance", {setup.view.width, setup.view.height}},
                 {"volume_mm3", body.volume()}};
    SavedWalks saved(Options(job), job, std::move(problem), Rgb::channels);
    const RadianceChannels channels = walkRadianceChannels(body, setup, saved, observer);
    saved.save();
    const bool interrupted = std::ranges::any_of(channels, [](const auto& c) { return c && c->interrupted; });
    Json document = documentJson("searchlight-reference/1", job);
    document["geometry"] = geometry;
    document["estimator"] = setup.subject.medium.eta == 1 ? "radiance, light at each collision" : "radiance, analogue";
    document["material"] = subjectJson(setup.subject);
    document["volume_mm3"] = body.volume();
    document["area_mm2"] = body.area();
    if (interrupted) document["interrupted"] = true;
    const auto list = [&](const char* name, const auto& value) {
        Json values = Json::array();
        for (const auto& channel : channels) values.push_back(channel ? Json(value(*channel)) : Json());
        document[name] = values;
    };
    list("walks", [](const BodyRadiance& r) { return r.walks; });
    list("collisions", [](const BodyRadiance& r) { return r.collisions; });
    list("surface_tests", [](const BodyRadiance& r) { return r.rays; });
    list("lost", [](const BodyRadiance& r) { return r.lost; });
    list("mean_radiance", [](const BodyRadiance& r) { return brightnessOf(r).mean; });
    list("mean_radiance_stderr", [](const BodyRadiance& r) { return brightnessOf(r).standard_error; });
    list("seconds", [](const BodyRadiance& r) { return r.seconds; });
    if (!job.output.empty()) {
        const CellView view = cellView(setup.view, body, setup.subject.medium.eta, setup.walk.threads);
        ImageFile file;
        file.image = pictureOf(view, channels, &BodyRadiance::radiance);
        file.layers = {{"stderr", pictureOf(view, channels, &BodyRadiance::standard_error)}};
        file.metadata = {{"version", std::string(version())},
                         {"job", jobJson(job)},
                         {"seed", fmt::format("{}", job.seed)},
                         {"material", setup.subject.id},
                         {"technique", "radiance reference"},
                         {"quantity", "radiance of light that has crossed the body, without what its surface mirrors"},
                         {"totals", document.dump()}};
        writeImage(job.output, file);
    }
    JobResult result;
    result.json = document.dump(1);
    result.text =
        fmt::format("{}, {} in {}, radiance from the camera\n", geometry, setup.object.name, setup.subject.name);
    for (std::size_t c = 0; c < channels.size(); ++c) {
        if (!channels[c]) continue;
        const BodyRadiance& r = *channels[c];
        const Estimate e = brightnessOf(r);
        result.text += fmt::format("{:<4} mean of the picture {:.6g} +- {:.2g}, {:.4g} walks, {:.3g} collisions/s\n",
                                   "RGB"[c], e.mean, e.standard_error, static_cast<double>(r.walks),
                                   static_cast<double>(r.collisions) / r.seconds);
    }
    for (const std::string& note : setup.subject.notes) result.text += note + "\n";
    result.interrupted = interrupted;
    if (interrupted) result.text += "interrupted\n";
    return result;
}

template <class Body>
JobResult finish(const Job& job, const Setup& setup, const Body& body, std::string_view geometry, Observer& observer) {
    if (Options(job).toggle("radiance")) return finishRadiance(job, setup, body, geometry, observer);
    Json problem{{"scene", Json::parse(jobJson(job)).at("scene")},
                 {"material", subjectJson(setup.subject)},
                 {"cells", body.cellCount()},
                 {"area_mm2", body.area()},
                 {"volume_mm3", body.volume()}};
    if (setup.walk.gl) problem["backend"] = "gl";
    SavedWalks saved(Options(job), job, std::move(problem), Rgb::channels);
    const Channels channels = walkChannels(body, setup, saved, observer);
    saved.save();
    const bool interrupted = std::ranges::any_of(channels, [](const auto& c) { return c && c->interrupted; });
    if (std::ranges::none_of(channels, [](const auto& c) { return c.has_value(); })) throw interruptedError();
    Json document = documentJson("searchlight-reference/1", job);
    document["per"] = "incident";
    document["geometry"] = geometry;
    document["estimator"] = "exitance, analogue";
    document["backend"] = setup.walk.gl ? "gl" : "cpu";
    document["material"] = subjectJson(setup.subject);
    document["volume_mm3"] = body.volume();
    document["area_mm2"] = body.area();
    document["cells"] = body.cellCount();
    if (interrupted) document["interrupted"] = true;
    addTotals(document, channels);

    if (!job.output.empty()) {
        const CellView view = cellView(setup.view, body, setup.subject.medium.eta, setup.walk.threads);
        const CellValues exitance = valuesOf(channels, &BodyResult::exitance);
        ImageFile file;
        file.image = pictureOfRadiance(view, exitance);
        file.layers = {{"stderr", pictureOfError(view, valuesOf(channels, &BodyResult::standard_error))},
                       {"exitance", pictureOfExitance(view, exitance)},
                       {"cell", pictureOfCells(view)}};
        file.metadata = {{"version", std::string(version())},
                         {"job", jobJson(job)},
                         {"seed", fmt::format("{}", job.seed)},
                         {"material", setup.subject.id},
                         {"technique", "exitance reference"},
                         {"quantity",
                          "diffuse exit: T21 M / (pi 4 C_phi(1/eta)), "
                          "M a mean over surface cells"},
                         {"totals", document.dump()}};
        writeImage(job.output, file);
    }
    JobResult result;
    result.json = document.dump(1);
    result.text = fmt::format("{}, {} in {}, {} cells, per unit incident flux\n", geometry, setup.object.name,
                              setup.subject.name, body.cellCount()) +
                  textOf(setup, channels);
    result.interrupted = interrupted;
    if (interrupted) result.text += "interrupted\n";
    return result;
}

JobResult runReferenceSphere(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    checkPictureEnding(job.output);
    Scene scene = job.scene;
    scene.object = "sphere";
    scene.scale = 2 * options.number("radius");
    Setup setup = setupOf(job, engine, options, scene);
    if (options.text("backend") == "gl") setup.walk.gl = &engine.context();
    return finish(job, setup, Ball(options.number("radius"), setup.cell_area_mm2), "sphere", observer);
}

JobResult runReferenceMesh(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    checkPictureEnding(job.output);
    const Setup setup = setupOf(job, engine, options, job.scene);
    const Rgb sigma_t = setup.subject.medium.sigmaT();
    const MeshBody body(setup.object.mesh, {.cell_area_mm2 = setup.cell_area_mm2,
                                            .shortest_mfp = 1 / std::max({sigma_t.r, sigma_t.g, sigma_t.b}),
                                            .regions = !options.toggle("plain"),
                                            .threads = setup.walk.threads});
    return finish(job, setup, body, "mesh", observer);
}

std::vector<Param> sharedOptions() {
    return {
        option::walks(1e6),
        {.name = "size",
         .type = ParamType::text,
         .value = std::string("512x512"),
         .doc = "of the picture: WIDTHxHEIGHT in pixels"},
        {.name = "cell_area",
         .unit = "mm^2",
         .min = 0,
         .max = option::unlimited,
         .value = 0.0,
         .doc = "of the surface cells that exitance is averaged over; 0: of "
                "four pixels"},
        {.name = "radiance",
         .type = ParamType::toggle,
         .value = false,
         .doc = "the radiance that the camera sees, by walks from there: of environments and discs (--sun-angle), at "
                "eta 1 of any light"},
        option::threads(),
        option::untilError("the reflectance of a channel"),
        option::resume()};
}

constexpr std::string_view kOutput =
    "picture of the diffuse exit: .exr with "
    "standard error and exitance as layers, "
    ".png, .hdr, .pfm";

}  // namespace

Command referenceSphereCommand() {
    std::vector<Param> options = sharedOptions();
    options.insert(options.begin(), {.name = "radius",
                                     .unit = "mm",
                                     .min = 0,
                                     .max = option::unlimited,
                                     .value = 10.0,
                                     .doc = "of the sphere",
                                     .exclusive = true});
    options.insert(options.end() - 3, option::walkBackend());
    return {.name = "reference sphere",
            .summary = "Walk light through a sphere by unbiased Monte Carlo",
            .example =
                "searchlight reference sphere --material marble --radius "
                "10 --walks 1e6 -o sphere.exr",
            .options = options,
            .uses_scene = true,
            .uses_seed = true,
            .shares_walks = true,
            .output = kOutput,
            .run = runReferenceSphere};
}

Command referenceMeshCommand() {
    std::vector<Param> options = sharedOptions();
    options.push_back({.name = "plain",
                       .type = ParamType::toggle,
                       .value = false,
                       .doc = "a ray for every flight, without safe regions: "
                              "slow, to check with"});
    return {.name = "reference mesh",
            .summary = "Walk light through a closed mesh by unbiased Monte Carlo",
            .example =
                "searchlight reference mesh statue --scale 50 --material "
                "marble --walks 1e6 -o statue.exr",
            .options = options,
            .uses_scene = true,
            .uses_seed = true,
            .shares_walks = true,
            .output = kOutput,
            .run = runReferenceMesh};
}

}  // namespace searchlight
