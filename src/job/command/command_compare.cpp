// compare: how far a picture is from its reference.
#include <fmt/format.h>

#include "base/error.h"
#include "io/image_file.h"
#include "job/command_table.h"
#include "job/json.h"
#include "job/shared_options.h"
#include "validate/image_error.h"

namespace searchlight {

namespace {

JobResult runCompare(const Job& job, Engine&, Observer&) {
    const Options options(job);
    const std::string &path = options.text("image"), &reference_path = options.text("reference");
    const Image image = readImage(path).image, reference = readImage(reference_path).image;
    if (image.width != reference.width || image.height != reference.height)
        throw usageError(fmt::format("{} is {} x {} pixels, {} is {} x {}", path, image.width, image.height,
                                     reference_path, reference.width, reference.height),
                         "both have to be of one size");
    const ImageErrorOptions settings{.exposure = options.number("exposure"),
                                     .white = options.number("white"),
                                     .pixels_per_degree = options.number("pixels_per_degree"),
                                     .threads = static_cast<int>(options.number("threads"))};
    const ImageError error = compareImages(image, reference, settings);

    Json document = documentJson("searchlight-compare/1", job);
    document["rmse"] = error.rmse;
    document["relative_rmse"] = error.relative_rmse;
    document["ssim"] = error.ssim;
    document["flip"] = error.flip;
    document["mean_difference"] = error.mean_difference;
    document["largest"] = error.largest;
    document["pixels"] = error.pixels;
    JobResult result;
    result.json = jsonText(document);
    result.text = fmt::format("{} against {}, {} pixels\n", path, reference_path, error.pixels);
    const auto line = [&](std::string_view name, double value, std::string_view meaning) {
        result.text += fmt::format("  {:<16} {:>10.5g}  {}\n", name, value, meaning);
    };
    line("RMSE", error.rmse, "root mean square over R, G, B");
    line("relative RMSE", error.relative_rmse, "over the reference's mean");
    line("mean difference", error.mean_difference, "over the same; above 0: too bright");
    line("largest", error.largest, "in one channel of one pixel");
    line("SSIM", error.ssim, "of perceived luminance; 1: equal");
    line("FLIP", error.flip, "mean over pixels; 0: no difference seen");
    if (!job.output.empty()) {
        const DifferenceOptions scale{.full_scale = options.number("full_scale"),
                                      .is_signed = options.toggle("signed")};
        writeImage(job.output, {differenceImage(image, reference, scale), {}, {{"job", jobJson(job)}}});
    }
    return result;
}

}  // namespace

Command compareCommand() {
    return {.name = "compare",
            .summary = "Compare a picture with its reference: RMSE, SSIM, FLIP and a picture of the difference",
            .example = "searchlight compare image.exr reference.exr -o difference.png",
            .options = {{.name = "image", .type = ParamType::path, .doc = "a picture", .required = true},
                        {.name = "reference",
                         .type = ParamType::path,
                         .doc = "a picture of the same size; pixels that it covers (alpha > 0) count",
                         .required = true},
                        {.name = "exposure",
                         .unit = "stops",
                         .min = -30,
                         .max = 30,
                         .value = 0.0,
                         .doc = "on both pictures before SSIM and FLIP, for which 1 is the white of a display"},
                        {.name = "white",
                         .unit = "cd/m^2",
                         .min = 1,
                         .max = 10000,
                         .value = 100.0,
                         .doc = "luminance of that white, for SSIM"},
                        {.name = "pixels_per_degree",
                         .min = 1,
                         .max = 1000,
                         .value = ImageErrorOptions().pixels_per_degree,
                         .doc = "of the viewer's field of view, for FLIP"},
                        {.name = "full_scale",
                         .min = 0,
                         .max = option::unlimited,
                         .value = 1.0,
                         .doc = "the end of the difference's colour scale, in multiples of the reference's mean",
                         .exclusive = true},
                        {.name = "signed",
                         .type = ParamType::toggle,
                         .value = false,
                         .doc = "difference of luminance: blue too dark, orange too bright"},
                        option::threads()},
            .positional = "image reference",
            .output = "the difference in false colours: .png, .exr, .hdr or .pfm",
            .run = runCompare};
}

}  // namespace searchlight
