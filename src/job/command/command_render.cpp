// render: a picture of a scene by one technique.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "base/error.h"
#include "base/text.h"
#include "base/version.h"
#include "geometry/point_cache.h"
#include "io/image_file.h"
#include "job/command_table.h"
#include "job/json.h"
#include "job/picture_options.h"
#include "job/render/kept_renderer.h"
#include "job/render/render_material.h"
#include "job/render/turntable.h"
#include "job/shared_options.h"

namespace searchlight {

namespace {

std::size_t pointsOf(const std::string& text) {
    if (text == "auto") return 0;
    const std::optional<double> number = parseNumber(text);
    if (!number || *number != std::floor(*number) || *number < 16 || *number > 1e8)
        throw usageError(fmt::format("'{}' is no value for points", text),
                         "expected auto or a whole number from 16 to 100000000");
    return static_cast<std::size_t>(*number);
}

std::optional<CacheFolder> pointCache(const Options& options) {
    const std::string& text = options.text("cache");
    if (text == "none") return std::nullopt;
    if (text != "user") return CacheFolder{.folder = text, .ending = ".ptc"};
    try {
        return userPointCache();
    } catch (const Error&) {
        // No home, no cache; who asks for it in words hears why.
        if (options.given("cache")) throw;
        return std::nullopt;
    }
}

// So that a slip of the pen in --size is an error and not the end of the machine.
void checkMemory(const RenderSettings& settings, double max_gib) {
    // Samples, their exitance and radiance, three pictures; a point with its irradiance in a tree.
    constexpr double bytes_per_point = 160;
    // The filter's planes: positions, normals, grids and three lists of light.
    const double bytes_per_pixel = settings.technique == "separable" ? 370 : 240;
    const double points = settings.points > 0 ? static_cast<double>(settings.points) : 800'000;
    const double gib =
        (bytes_per_pixel * settings.width * settings.height + bytes_per_point * points) / (1024. * 1024 * 1024);
    if (gib > max_gib)
        throw usageError(fmt::format("this picture takes about {:.3g} GiB of memory", gib),
                         fmt::format("--max-memory allows {:.3g}; fewer pixels or points take less", max_gib));
}

ToneMap toneMapOf(const Options& options, double suited) {
    ToneMap tone_map;
    tone_map.exposure = suited;
    if (const std::string& text = options.text("exposure"); text != "auto") {
        const std::optional<double> stops = parseNumber(text);
        if (!stops || std::abs(*stops) > 64)
            throw usageError(fmt::format("'{}' is no value for exposure", text),
                             "expected auto or stops from -64 to 64");
        tone_map.exposure = *stops;
    }
    tone_map.curve = options.text("curve") == "filmic" ? ToneMap::Curve::filmic : ToneMap::Curve::srgb;
    tone_map.gamma = options.number("gamma");
    return tone_map;
}

RenderSettings settingsOf(const Job& job, const Options& options) {
    RenderSettings settings;
    const PictureSize size = parsePictureSize(options.text("size"));
    settings.width = size.width;
    settings.height = size.height;
    settings.points = pointsOf(options.text("points"));
    settings.technique = options.text("technique");
    const TechniqueEntry& entry = findTechnique(settings.technique);
    for (const TechniqueEntry& each : techniques())
        for (const Param& param : each.options) {
            if (!options.given(param.name)) continue;
            if (std::ranges::find(entry.options, param.name, &Param::name) == entry.options.end())
                throw usageError(fmt::format("{} has no option '{}'", entry.id, param.name),
                                 fmt::format("it belongs to --technique {}", each.id));
            settings.technique_options[param.name] = job.options.at(param.name);
        }
    settings.edge_samples = static_cast<int>(options.number("edge_samples"));
    settings.light_samples = static_cast<int>(options.number("light_samples"));
    settings.seed = job.seed;
    settings.threads = static_cast<int>(options.number("threads"));
    settings.gl = options.text("backend") == "gl";
    settings.points_cache = pointCache(options);
    return settings;
}

struct StageTime {
    std::string name;
    double ms = 0;
    bool gl = false;
};

// The renderer's stages, with the technique's own in place of its whole.
std::vector<StageTime> stageTimes(const RenderReport& report) {
    std::vector<StageTime> times;
    for (std::size_t i = 0; i < stage_count; ++i) {
        const auto stage = static_cast<Stage>(i);
        if (stage != Stage::exitance) {
            times.push_back({std::string(stageName(stage)), report[stage].ms, report[stage].gl});
            continue;
        }
        for (const auto& [name, ms] : report.technique.stage_ms) times.push_back({name, ms, report[stage].gl});
    }
    return times;
}

Json renderJson(const RenderReport& report, const RenderSettings& settings, const TechniqueEntry& entry) {
    Json json;
    json["technique"] = entry.id;
    json["approximates"] = report.technique.approximates;
    json["device"] = report.technique.device;
    json["width"] = settings.width;
    json["height"] = settings.height;
    json["points"] = report.points;
    json["point_spacing_mm"] = report.point_spacing_mm;
    json["receivers"] = report.receivers;
    json["interactions"] = report.technique.interactions;
    for (const Param& param : entry.options) json[param.name] = valueJson(valueOf(param, settings.technique_options));
    for (const auto& [name, value] : report.technique.numbers) json[name] = value;
    json["error_bound"] = report.technique.error_bound > 0 ? Json(report.technique.error_bound) : Json();
    if (report.technique.standard_error > 0) json["standard_error"] = report.technique.standard_error;
    json["camera"] = {{"azimuth_deg", report.camera.azimuth_deg},
                      {"elevation_deg", report.camera.elevation_deg},
                      {"distance", report.camera.distance}};
    return json;
}

// A word that is neither a built-in object nor looks like a file is a slip in the name of the former.
void checkObject(const std::string& object) {
    const std::vector<std::string> known = builtInObjects();
    if (std::ranges::find(known, object) == known.end() && object.find_first_of("./") == std::string::npos)
        throw unknownName(ErrorKind::usage, "object", object, known);
}

JobResult runRender(const Job& job, Engine& engine, Observer& observer) {
    if (Options(job).number("turntable") > 0) return renderTurntable(job, engine, observer);
    KeptRenderer kept;
    return renderPicture(job, engine, kept, observer);
}

std::vector<Param> renderOptions() {
    std::vector<std::string> ids;
    for (const TechniqueEntry& entry : techniques()) ids.emplace_back(entry.id);
    std::vector<Param> options{
        {.name = "size",
         .type = ParamType::text,
         .value = std::string("1280x720"),
         .doc = "of the picture: WIDTHxHEIGHT in pixels"},
        {.name = "technique",
         .type = ParamType::choice,
         .value = ids.front(),
         .choices = ids,
         .doc = "how the light in the object is summed"},
    };
    std::set<std::string> known;
    for (const TechniqueEntry& entry : techniques())
        for (const Param& param : entry.options)
            if (known.insert(param.name).second) options.push_back(param);
    const Param rest[] = {
        {.name = "turntable",
         .type = ParamType::integer,
         .min = 0,
         .max = 100'000,
         .value = 0.0,
         .doc = "frames of one turn of the camera, to -o with #### for their number; 0: one picture"},
        {.name = "points",
         .type = ParamType::text,
         .value = std::string("auto"),
         .doc = "points of irradiance on a mesh; auto: from its area and the material"},
        {.name = "light_samples",
         .type = ParamType::integer,
         .min = 1,
         .max = 1e7,
         .value = 512.0,
         .doc = "directions by which an environment with --occlusion is summed"},
        {.name = "edge_samples",
         .type = ParamType::integer,
         .min = 1,
         .max = 1024,
         .value = 8.0,
         .doc = "rays through a pixel that an edge crosses"},
        {.name = "backend",
         .type = ParamType::choice,
         .value = std::string("auto"),
         .choices = {"auto", "cpu", "gl"},
         .doc = "what lights, looks and sums; auto: the CPU, and OpenGL for models that do not ship"},
        option::threads(),
        {.name = "cache",
         .type = ParamType::text,
         .value = std::string("user"),
         .doc = "where points of a mesh are kept for the next time: user, none or a folder"},
        {.name = "max_memory",
         .unit = "GiB",
         .min = 0.001,
         .max = 1e6,
         .value = 8.0,
         .doc = "refuse what would take more"},
        {.name = "exposure", .type = ParamType::text, .value = std::string("auto"), .doc = "of a .png: stops, or auto"},
        {.name = "curve",
         .type = ParamType::choice,
         .value = std::string("srgb"),
         .choices = {"srgb", "filmic"},
         .doc = "tone curve of a .png"},
        {.name = "gamma", .min = 0.1, .max = 10, .value = 1.0, .doc = "of a .png, on top of sRGB"},
    };
    options.insert(options.end(), std::begin(rest), std::end(rest));
    return options;
}

JobResult pictureOf(const Job& job, Engine& engine, KeptRenderer& kept, Observer& observer) {
    const Options options(job);
    const RenderSettings settings = settingsOf(job, options);
    checkObject(job.scene.object);
    checkPictureEnding(job.output);
    checkMemory(settings, options.number("max_memory"));
    toneMapOf(options, 0);  // so that a mistake is found before the work
    const std::string& backend = options.text("backend");
    const TechniqueEntry& entry = findTechnique(settings.technique);
    if (settings.gl && !entry.gl)
        throw usageError(fmt::format("{} has no version on OpenGL", entry.id), "use --backend cpu or auto");

    const bool needs_context = settings.gl || (job.scene.coat && !job.scene.coat->brdf.empty());
    if (!kept.renderer || kept.backend != backend || kept.has_context != needs_context) {
        kept.backend = backend;
        kept.has_context = needs_context;
        kept.renderer = std::make_unique<Renderer>(materialSource(engine, backend, &kept.subject),
                                                   needs_context ? &engine.context() : nullptr);
    }
    Renderer& renderer = *kept.renderer;
    const Subject& subject = kept.subject;
    renderer.setScene(job.scene);
    renderer.setSettings(settings);
    const auto begin = std::chrono::steady_clock::now();
    ImageFile file;
    file.image = renderer.render(observer);
    if (Image errors = renderer.standardError(); !errors.empty() && job.output.ends_with(".exr"))
        file.layers.push_back({"stderr", std::move(errors)});
    const RenderReport& report = renderer.report();
    const ToneMap tone_map = toneMapOf(options, report.exposure);

    Json document = documentJson("searchlight-render/1", job);
    document["model"] = job.scene.model.id;
    document["material"] = subjectJson(subject);
    document["backend"] = settings.gl ? "gl" : "cpu";
    const Json numbers = renderJson(report, settings, entry);
    for (const auto& [key, value] : numbers.items()) document[key] = value;
    document["exposure"] = tone_map.exposure;
    document["notes"] = report.notes;

    file.metadata = {{"version", std::string(version())},
                     {"job", jobJson(job)},
                     {"seed", fmt::format("{}", job.seed)},
                     {"model", job.scene.model.id},
                     {"material", subject.id},
                     {"technique", std::string(entry.id)},
                     {"error", document.contains("error") ? document["error"].dump() : "0"}};
    const auto written = std::chrono::steady_clock::now();
    if (!job.output.empty()) writeImage(job.output, file, tone_map);
    const auto end = std::chrono::steady_clock::now();
    const auto ms = [](auto duration) { return std::chrono::duration<double, std::milli>(duration).count(); };
    const std::vector<StageTime> times = stageTimes(report);
    for (const StageTime& stage : times) {
        document["ms"][stage.name] = stage.ms;
        document["backends"][stage.name] = stage.gl ? "gl" : "cpu";
    }
    document["ms"]["write"] = ms(end - written);
    document["ms"]["total"] = ms(end - begin);

    JobResult result;
    result.json = jsonText(document);
    result.text = fmt::format("{} in {}, {}, {}x{}\n", job.scene.object, subject.name, job.scene.model.id,
                              settings.width, settings.height);
    if (report.points > 0)
        result.text += fmt::format("{} points {:.3g} mm apart, ", report.points, report.point_spacing_mm);
    result.text += fmt::format("{} receivers", report.receivers);
    if (report.technique.error_bound > 0)
        result.text += fmt::format(", error at most {:.2g} %", 100 * report.technique.error_bound);
    if (report.technique.standard_error > 0)
        result.text += fmt::format(", standard error {:.2g} %", 100 * report.technique.standard_error);
    result.text += "\n";
    for (const StageTime& stage : times)
        if (stage.ms >= 0.05)
            result.text += fmt::format("{}{} {:.1f} ms, ", stage.name, stage.gl ? " (gl)" : "", stage.ms);
    result.text += fmt::format("total {:.1f} ms\n", ms(end - begin));
    for (const std::string& note : report.notes) result.text += note + "\n";
    for (const std::string& note : subject.notes) result.text += note + "\n";
    return result;
}

}  // namespace

RenderSettings renderSettings(const Job& job) { return settingsOf(job, Options(job)); }

JobResult renderPicture(const Job& job, Engine& engine, KeptRenderer& kept, Observer& observer) {
    try {
        return pictureOf(job, engine, kept, observer);
    } catch (const Error& error) {
        if (error.kind != ErrorKind::device || !engine.contextLost()) throw;
    }
    // A GPU that was reset works again. One that is lost in the same picture twice is worth an error.
    kept.renderer.reset();
    engine.dropContext();
    return pictureOf(job, engine, kept, observer);
}

Command renderCommand() {
    return {.name = "render",
            .summary = "Render a scene",
            .example = "searchlight render statue --material marble --scale 50 --light dir:1,1,1 -o statue.png",
            .options = renderOptions(),
            .uses_scene = true,
            .uses_seed = true,
            .output = "the picture: .exr, .hdr, .pfm or .png; with --turntable such as frame_####.png",
            .run = runRender};
}

}  // namespace searchlight
