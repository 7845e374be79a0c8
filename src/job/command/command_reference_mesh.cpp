// reference sphere, reference mesh: the exitance that light in a closed body leaves on its surface, or the radiance
// that a camera sees of it, by Monte Carlo.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "job/command_table.h"
#include "job/engine.h"
#include "job/picture_options.h"
#include "job/reference/body_reference.h"
#include "job/shared_options.h"

namespace searchlight {

namespace {

constexpr double kCellPixels = 4;  // area of a cell in pixels, unless it is given

BodySetup setupOf(const Job& job, Engine& engine, const Options& options, const Scene& scene) {
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

template <class Body>
JobResult finish(const Job& job, const BodySetup& setup, const Body& body, std::string_view geometry,
                 Observer& observer) {
    return Options(job).toggle("radiance") ? radianceOf(job, setup, body, geometry, observer)
                                           : exitanceOf(job, setup, body, geometry, observer);
}

JobResult runReferenceSphere(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    checkPictureEnding(job.output);
    Scene scene = job.scene;
    if (scene.object != "sphere")
        throw usageError(fmt::format("'{}' is not the sphere that is walked", scene.object),
                         fmt::format("searchlight reference mesh {}", scene.object));
    if (scene.scale != Scene{}.scale && scene.scale != 2 * options.number("radius"))
        throw usageError("--scale is not for reference sphere", "give --radius, in mm");
    scene.scale = 2 * options.number("radius");
    BodySetup setup = setupOf(job, engine, options, scene);
    if (options.text("backend") == "gl") setup.walk.gl = &engine.context();
    return finish(job, setup, Ball(options.number("radius"), setup.cell_area_mm2), "sphere", observer);
}

JobResult runReferenceMesh(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    checkPictureEnding(job.output);
    BodySetup setup = setupOf(job, engine, options, job.scene);
    setup.walk.large_steps = !options.toggle("plain");
    const Rgb sigma_t = setup.subject.medium.sigmaT();
    const MeshBody body(setup.object.mesh, {.cell_area_mm2 = setup.cell_area_mm2,
                                            .shortest_mfp = 1 / std::max({sigma_t.r, sigma_t.g, sigma_t.b}),
                                            .regions = !options.toggle("plain"),
                                            .threads = setup.walk.threads});
    return finish(job, setup, body, "mesh", observer);
}

std::vector<Param> sharedOptions() {
    return {option::walks(1e6),
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
             .doc = "the radiance that the camera sees, by walks from there: of any light"},
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
                       .doc = "a ray for every flight, without safe regions and large steps: "
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
