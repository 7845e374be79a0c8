#include "job/contest/contest_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/error.h"
#include "base/files.h"
#include "base/version.h"
#include "io/image_file.h"
#include "job/json.h"
#include "job/render/kept_renderer.h"

namespace searchlight {

namespace {

namespace fs = std::filesystem;

// Passes of a picture: enough for its own scatter to tell the error, few enough to stop soon after the noise is low.
constexpr int passes_at_once = 256;

// A job's picture and its document, from an earlier run where it is the same job.
struct Kept {
    ImageFile file;
    Json document;
};

// A folder may have been moved.
Json withoutOutput(Json job) {
    if (job.is_object()) job.erase("output");
    return job;
}

std::optional<Kept> readKept(const fs::path& path, const Job& job) {
    const fs::path numbers = fs::path(path).replace_extension(".json");
    if (std::error_code error; !fs::exists(path, error) || !fs::exists(numbers, error)) return std::nullopt;
    const Json document = Json::parse(readFile(numbers), nullptr, false);
    if (!document.is_object() || document.value("version", Json()) != Json(version())) return std::nullopt;
    if (!document.contains("job") || withoutOutput(document["job"]) != withoutOutput(Json::parse(jobJson(job))))
        return std::nullopt;
    return Kept{readImage(path.string()), document};
}

// Runs the job unless it is there. Empty where it was interrupted.
Kept runKept(const Job& job, const ReferenceAims& aims, Engine& engine, KeptRenderer* renderer, Observer& observer) {
    const fs::path path = job.output;
    if (aims.resume)
        if (std::optional<Kept> kept = readKept(path, job)) return std::move(*kept);
    const JobResult result = renderer ? renderPicture(job, engine, *renderer, observer) : run(job, engine, observer);
    if (!result.failure.empty()) throw inputError(result.failure);
    if (result.interrupted) throw interruptedError();
    writeFile(fs::path(path).replace_extension(".json"), result.json + "\n");
    return {readImage(path.string()), Json::parse(result.json)};
}

const Image& layerOf(const ImageFile& file, std::string_view name) {
    return std::ranges::find(file.layers, name, &ImageLayer::name)->image;
}

double secondsSince(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

double relativeNoise(const Image& image, const Image& standard_error) {
    double squares = 0, sum = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const Rgba &p = image.pixels[i], &e = standard_error.pixels[i];
        if (p.a <= 0) continue;
        sum += static_cast<double>(p.r) + p.g + p.b;
        squares += static_cast<double>(e.r) * e.r + static_cast<double>(e.g) * e.g + static_cast<double>(e.b) * e.b;
    }
    std::size_t values = 0;
    for (const Rgba& p : image.pixels)
        if (p.a > 0) values += 3;
    const double count = static_cast<double>(values);
    return sum > 0 ? std::sqrt(squares / count) / (sum / count) : 0;
}

ReferencePicture directReference(const ContestPlan& plan, const ReferenceAims& aims, const fs::path& folder,
                                 Engine& engine, Observer& observer) {
    const auto begin = std::chrono::steady_clock::now();
    makeFolder(folder / "reference");
    Job job = plan.contestants.front().cells.front().job;
    job.options = {{"technique", std::string("direct")},
                   {"spp", static_cast<double>(passes_at_once)},
                   {"cache", std::string("none")}};
    for (const Param& param : contestPictureOptions()) {
        const auto given = plan.contestants.front().cells.front().job.options.find(param.name);
        if (param.name != "points") job.options[param.name] = given->second;
    }
    KeptRenderer kept;
    std::vector<Rgb> sums, squares;
    ReferencePicture reference;
    for (int n = 1; n * passes_at_once <= aims.most_passes; ++n) {
        // Seeds of their own: no contestant's noise is that of its judge.
        job.seed = aims.seed + 0x5eed + static_cast<std::uint64_t>(n);
        job.output = (folder / "reference" / fmt::format("direct_{:02}.exr", n)).string();
        const Kept picture = runKept(job, aims, engine, &kept, observer);
        const Image &image = picture.file.image, &error = layerOf(picture.file, "stderr");
        sums.resize(image.pixels.size());
        squares.resize(image.pixels.size());
        reference.image = Image(image.width, image.height);
        reference.standard_error = reference.image;
        for (std::size_t i = 0; i < sums.size(); ++i) {
            const Rgba &p = image.pixels[i], &e = error.pixels[i];
            sums[i] = sums[i] + Rgb{p.r, p.g, p.b};
            squares[i] = squares[i] + Rgb{e.r, e.g, e.b} * Rgb{e.r, e.g, e.b};
            const Rgb mean = (1.0 / n) * sums[i];
            const auto errorOf = [&](double sum) { return static_cast<float>(std::sqrt(sum) / n); };
            // The picture's own alpha is 1 everywhere: black stands behind the object.
            reference.image.pixels[i] = {static_cast<float>(mean.r), static_cast<float>(mean.g),
                                         static_cast<float>(mean.b), e.a};
            reference.standard_error.pixels[i] = {errorOf(squares[i].r), errorOf(squares[i].g), errorOf(squares[i].b),
                                                  e.a};
        }
        reference.effort = static_cast<std::uint64_t>(n) * passes_at_once;
        reference.noise = relativeNoise(reference.image, reference.standard_error);
        if (reference.noise <= aims.noise) break;
    }
    reference.seconds = secondsSince(begin);
    return reference;
}

ReferencePicture walkedReference(const ContestPlan& plan, const ReferenceAims& aims, const Camera& camera,
                                 const fs::path& folder, Engine& engine, Observer& observer) {
    const auto begin = std::chrono::steady_clock::now();
    ReferencePicture reference;
    if (aims.walks <= 0) {
        reference.absent = "no walks were asked for";
        return reference;
    }
    makeFolder(folder / "reference");
    Job job;
    job.command = "reference mesh";
    job.scene = plan.scene;
    job.scene.camera = camera;
    job.seed = aims.seed;
    job.output = (folder / "reference" / "walks.exr").string();
    job.options = {{"walks", aims.walks},
                   {"size", fmt::format("{}x{}", plan.width, plan.height)},
                   {"threads", static_cast<double>(aims.threads)}};
    try {
        const Kept walked = runKept(job, aims, engine, nullptr, observer);
        reference.image = walked.file.image;
        reference.standard_error = layerOf(walked.file, "stderr");
        reference.effort = static_cast<std::uint64_t>(aims.walks);
    } catch (const Error& error) {
        // Open meshes, media too dense, light that walks do not take: the contest goes on without them.
        if (error.kind != ErrorKind::input && error.kind != ErrorKind::usage) throw;
        reference.absent = error.message;
    }
    // At the border cells reach beyond what is seen.
    for (Rgba& pixel : reference.image.pixels)
        if (pixel.a < 0.999f) pixel = {0, 0, 0, 0};
    if (!reference.empty()) reference.noise = relativeNoise(reference.image, reference.standard_error);
    reference.seconds = secondsSince(begin);
    return reference;
}

}  // namespace searchlight
