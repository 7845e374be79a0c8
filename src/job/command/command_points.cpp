// points: an even point cloud on a mesh.
#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "base/text.h"
#include "geometry/content_hash.h"
#include "geometry/object.h"
#include "geometry/point_cache.h"
#include "geometry/point_start.h"
#include "io/shape_file.h"
#include "job/command_table.h"
#include "job/json.h"
#include "job/shared_options.h"

namespace searchlight {

namespace {

// In the file's own place and unit, or in mm about the centre, as render has it.
Mesh meshOf(const Job& job, const Options& options) {
    if (const double scale = options.number("scale"); scale > 0) {
        Scene scene = job.scene;
        scene.object = options.text("mesh");
        scene.scale = scale;
        return placeObject(scene).mesh;
    }
    return meshNamed(options.text("mesh"));
}

JobResult runPoints(const Job& job, Engine&, Observer& observer) {
    const Options options(job);
    const bool in_mm = options.number("scale") > 0;
    const Mesh mesh = meshOf(job, options);
    const PointOptions wanted{.count = static_cast<std::size_t>(options.number("count")),
                              .method = options.text("method") == "turk" ? PointMethod::turk : PointMethod::fast,
                              .seed = job.seed,
                              .threads = static_cast<int>(options.number("threads"))};
    CacheFolder cache{.folder = options.text("cache"), .ending = ".ptc"};
    if (cache.folder.empty()) cache = userPointCache();
    const auto start = std::chrono::steady_clock::now();
    const CachedPoints points = cachedPoints(mesh, contentHash(mesh), wanted, cache, observer);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!job.output.empty()) writePointCloud(job.output, points.cloud);

    const double area = surfaceArea(mesh), count = static_cast<double>(wanted.count), mean = area / count;
    double sum = 0, squares = 0;
    for (const float a : points.cloud.areas) sum += a, squares += (a - mean) * (a - mean);
    const double scatter = std::sqrt(squares / count) / mean;
    Json document = documentJson("searchlight-points/1", job);
    document["points"] = {{"count", wanted.count},
                          {"method", options.text("method")},
                          {"area", area},
                          {"area_error", sum / area - 1},
                          {"area_std", scatter},
                          {"spacing", std::sqrt(mean)},
                          {"cached", points.hit},
                          {"seconds", seconds},
                          {"unit", in_mm ? "mm" : "the mesh's own"}};
    const char* const length = in_mm ? " mm" : "";
    const char* const squared = in_mm ? " mm²" : "";
    std::string text = fmt::format("{} points, {}{} apart, areas sum to {}{} and scatter by {} %; {} in {:.2f} s\n",
                                   wanted.count, prettyNumber(std::sqrt(mean)), length, prettyNumber(sum, 6), squared,
                                   prettyNumber(100 * scatter, 2), points.hit ? "read" : "made", seconds);
    if (!in_mm) text += "Lengths are in the mesh's own unit; --scale makes them mm.\n";
    return {.text = std::move(text), .json = jsonText(document)};
}

}  // namespace

Command pointsCommand() {
    return {.name = "points",
            .summary = "Spread points evenly on a mesh, each with its normal and area",
            .example = "searchlight points statue -n 200000 -o statue.ptc",
            .options = {{.name = "mesh",
                         .type = ParamType::path,
                         .doc = "a file, or a built-in object: " + join(builtInObjects(), ", "),
                         .required = true},
                        {.name = "count",
                         .type = ParamType::integer,
                         .min = 1,
                         .max = 1e8,
                         .value = 200'000.0,
                         .doc = "how many points",
                         .letter = 'n'},
                        {.name = "method",
                         .type = ParamType::choice,
                         .value = std::string("fast"),
                         .choices = {"fast", "turk"},
                         .doc = "from equal strata, or from random places as Turk 1992 has it, which takes longer"},
                        {.name = "scale",
                         .unit = "mm",
                         .min = 0,
                         .max = option::unlimited,
                         .value = 0.0,
                         .doc = "longest side, about the centre; 0: as the mesh is"},
                        {.name = "cache",
                         .type = ParamType::path,
                         .value = std::string(),
                         .doc = "folder for points made before; absent: the user's cache"},
                        option::threads()},
            .positional = "mesh",
            .uses_seed = true,
            .output = "the cloud: .ptc or .ply",
            .run = runPoints};
}

}  // namespace searchlight
