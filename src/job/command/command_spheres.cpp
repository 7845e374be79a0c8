// spheres: a model on a lit sphere beside the walks.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/text.h"
#include "base/version.h"
#include "draw/contact_sheet.h"
#include "io/image_file.h"
#include "job/command_table.h"
#include "job/json.h"
#include "job/picture_options.h"
#include "job/render/render_material.h"
#include "job/shared_options.h"
#include "render/cell_view.h"
#include "render/sphere/sphere_error.h"
#include "render/sphere/sphere_reference.h"
#include "validate/image_error.h"

namespace searchlight {

namespace {

constexpr double kCellPixels =
    9;  // area of a cell in pixels, unless it is given: cells of that size are seen, and half as noisy as of four

struct Pictures {
    Image model, model_error, reference, reference_error;
};

Json estimateJson(const Estimate& estimate) { return {{"mean", estimate.mean}, {"stderr", estimate.standard_error}}; }

std::string percent(double value) { return fmt::format("{:+.2f} %", 100 * value); }

bool isSheet(const std::string& output) {
    return std::ranges::any_of(sheetFormats(), [&](const std::string& ending) { return output.ends_with(ending); });
}

void checkOutput(const std::string& output) {
    if (output.empty() || isSheet(output) || output.ends_with(".exr")) return;
    throw usageError(fmt::format("'{}' cannot be written", output),
                     "valid endings: " + join(sheetFormats(), ", ") + ", .exr");
}

void writeSheet(const Job& job, const Pictures& pictures, const std::string& model, const std::string& material,
                const std::string& errors, double full_scale) {
    const double exposure = suitedExposure(pictures.reference);
    const auto bytes = [&](const Image& image, double stops) {
        return imageBytes("sheet.png", {image, {}, {}}, {.exposure = stops});
    };
    ContactSheet sheet;
    sheet.title = fmt::format("Lit spheres: {} for {}", model, material);
    sheet.caption = fmt::format(
        "Diffuse exit, T21 M / (π 4 C_φ(1/η)), of both; exposure {:+.2f} stops. The difference is of luminance, "
        "model less walks: blue too dark, orange too bright, full at {:.0f} % of the walks' mean. {}",
        exposure, 100 * full_scale, errors);
    sheet.columns = {model, "Random walks", "Difference"};
    sheet.rows = {""};
    sheet.picture_width = pictures.model.width / 2;
    sheet.picture_height = pictures.model.height / 2;
    Image difference =
        differenceImage(pictures.model, pictures.reference, {.full_scale = full_scale, .is_signed = true});
    for (std::size_t i = 0; i < difference.pixels.size(); ++i) {
        Rgba& pixel = difference.pixels[i];
        const float covered = pictures.reference.pixels[i].a;
        pixel = {covered * pixel.r, covered * pixel.g, covered * pixel.b, covered};
    }
    sheet.cells = {
        {bytes(pictures.model, exposure), ""}, {bytes(pictures.reference, exposure), ""}, {bytes(difference, 0), ""}};
    sheet.metadata = {{"version", std::string(version())}, {"job", jobJson(job)}};
    drawSheet(sheet, job.output);
}

void writeLayers(const Job& job, const Pictures& pictures, const Json& document) {
    ImageFile file{pictures.model, {}, {}};
    file.layers = {{"stderr", pictures.model_error},
                   {"reference", pictures.reference},
                   {"reference_stderr", pictures.reference_error}};
    file.metadata = {{"version", std::string(version())},
                     {"job", jobJson(job)},
                     {"seed", fmt::format("{}", job.seed)},
                     {"quantity", "diffuse exit: T21 M / (pi 4 C_phi(1/eta)), M a mean over surface cells"},
                     {"errors", jsonText(document, -1)}};
    writeImage(job.output, file);
}

JobResult runSpheres(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    checkOutput(job.output);
    const PictureSize size = parsePictureSize(options.text("size"));
    const double radius = options.number("radius"), area = options.number("cell_area");
    const int threads = static_cast<int>(options.number("threads"));
    Scene scene = job.scene;
    scene.object = "sphere";
    scene.scale = 2 * radius;
    const Object object = placeObject(scene);
    const LightSampler lights(scene, object);
    if (lights.dark()) throw usageError("a lit sphere needs light", "such as --light dir:1,1,1");
    const Subject subject = comparableSubjectOf(job, engine);
    RenderMaterial material = materialSource(engine, options.text("backend"), nullptr)(scene);
    const Medium& medium = subject.medium;
    if (!medium.scatters(0) && !medium.scatters(1) && !medium.scatters(2))
        throw inputError(fmt::format("{} does not scatter in any channel", subject.name));

    const View camera = makeView(scene.camera, object, size.width, size.height);
    const double pixel = 2 * camera.tan_half / camera.height * length(camera.eye);
    const Ball ball(radius, area > 0 ? area : kCellPixels * pixel * pixel);
    const CellView view = cellView(camera, ball, medium.eta, threads);
    SphereIntegral integral(ball, lights, material.model, *material.evaluator, medium,
                            {.seed = job.seed, .threads = threads});
    integral.add(static_cast<int>(options.number("samples")), observer);
    SphereReference reference(ball, lights, medium, job.seed, threads);
    reference.walkTo(static_cast<std::uint64_t>(options.number("walks")), observer);

    const SphereExitance ours = integral.exitance(), theirs = reference.exitance();
    const Pictures pictures{
        pictureOfRadiance(view, cellValues(ours.mean)), pictureOfError(view, cellValues(ours.standard_error)),
        pictureOfRadiance(view, cellValues(theirs.mean)), pictureOfError(view, cellValues(theirs.standard_error))};
    const auto errors = sphereErrors(view, ours, theirs);
    const double exposure = suitedExposure(pictures.reference);
    const ImageError image = compareImages(pictures.model, pictures.reference, {.exposure = exposure});

    Json document = documentJson("searchlight-spheres/1", job);
    document["per"] = "incident";
    document["model"] = material.model.id;
    document["material"] = subjectJson(subject);
    document["radius_mm"] = radius;
    document["cells"] = ball.cellCount();
    document["samples_per_cell"] = integral.samples();
    document["walks"] = reference.walks();
    document["channels"] = Json::array();
    JobResult result;
    result.text = fmt::format("{} beside random walks, {} on a sphere of {} mm, {} cells\n", material.model.file.title,
                              subject.name, prettyNumber(radius), ball.cellCount());
    result.text += fmt::format("{:<4} {:>24} {:>24} {:>22} {:>9} {:>9}\n", "", "reflectance of model", "of walks",
                               "radiance differs by", "RMSE", "of noise");
    std::vector<std::string> means;
    for (int c = 0; c < Rgb::channels; ++c) {
        const auto& walked = reference.channels()[static_cast<std::size_t>(c)];
        const SphereError& error = errors[static_cast<std::size_t>(c)];
        if (!walked) {
            document["channels"].push_back(nullptr);
            result.text += fmt::format("{:<4} not applicable: this channel does not scatter\n", "RGB"[c]);
            continue;
        }
        Estimate model = integral.left()[static_cast<std::size_t>(c)];
        model.mean /= walked->incident.mean;
        model.standard_error /= walked->incident.mean;
        document["channels"].push_back({{"reflectance", estimateJson(model)},
                                        {"reference_reflectance", estimateJson(walked->reflectance)},
                                        {"mean_difference", estimateJson(error.mean_difference)},
                                        {"relative_rmse", error.rmse},
                                        {"relative_noise", error.noise},
                                        {"relative_rmse_without_noise", error.bias},
                                        {"walks", walked->arrivals},
                                        {"collisions", walked->collisions}});
        const auto text = [](const Estimate& e) { return fmt::format("{:.5f} +- {:.5f}", e.mean, e.standard_error); };
        result.text +=
            fmt::format("{:<4} {:>24} {:>24} {:>22} {:>9} {:>9}\n", "RGB"[c], text(model), text(walked->reflectance),
                        fmt::format("{:+.2f} +- {:.2f} %", 100 * error.mean_difference.mean,
                                    100 * error.mean_difference.standard_error),
                        fmt::format("{:.2f} %", 100 * error.rmse), fmt::format("{:.2f} %", 100 * error.noise));
        means.push_back(percent(error.mean_difference.mean));
    }
    document["picture"] = {{"relative_rmse", image.relative_rmse},
                           {"mean_difference", image.mean_difference},
                           {"ssim", image.ssim},
                           {"flip", image.flip}};
    result.text += fmt::format("picture: relative RMSE {:.2f} %, mean {}, SSIM {:.4f}, FLIP {:.4f}\n",
                               100 * image.relative_rmse, percent(image.mean_difference), image.ssim, image.flip);
    for (const std::string& note : subject.notes) result.text += note + "\n";
    result.json = jsonText(document);
    if (isSheet(job.output))
        writeSheet(job, pictures, material.model.file.title, subject.name,
                   "Mean difference by channel: " + join(means, ", ") + ".", options.number("full_scale"));
    else if (!job.output.empty())
        writeLayers(job, pictures, document);
    return result;
}

}  // namespace

Command spheresCommand() {
    return {.name = "spheres",
            .summary = "A lit sphere by a model and by random walks, and how far they are apart",
            .example = "searchlight spheres --model better_dipole --material skin1 -o spheres.png",
            .options = {{.name = "radius",
                         .unit = "mm",
                         .min = 0,
                         .max = option::unlimited,
                         .value = 10.0,
                         .doc = "of the sphere",
                         .exclusive = true},
                        {.name = "samples",
                         .type = ParamType::integer,
                         .min = 2,
                         .max = 1e7,
                         .value = 32.0,
                         .doc = "of the model's integral, per surface cell"},
                        option::walks(5e6),
                        {.name = "size",
                         .type = ParamType::text,
                         .value = std::string("480x480"),
                         .doc = "of each picture: WIDTHxHEIGHT in pixels"},
                        {.name = "cell_area",
                         .unit = "mm^2",
                         .min = 0,
                         .max = option::unlimited,
                         .value = 0.0,
                         .doc = "of the surface cells that exitance is averaged over; 0: of 16 pixels"},
                        {.name = "full_scale",
                         .min = 0,
                         .max = option::unlimited,
                         .value = 1.0,
                         .doc = "the end of the difference's colour scale, in multiples of the walks' mean",
                         .exclusive = true},
                        option::backend(),
                        option::threads()},
            .uses_scene = true,
            .uses_seed = true,
            .output = "both pictures and their difference on a sheet: .png, .jpg, .svg; or their numbers: .exr",
            .run = runSpheres};
}

}  // namespace searchlight
