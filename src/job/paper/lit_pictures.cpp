#include "job/paper/lit_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "validate/image_error.h"

namespace searchlight {

Subject subjectNamed(const PaperRun& run, std::string_view material) {
    Job job;
    job.scene.material.id = std::string(material);
    return subjectOf(job, run.engine);
}

Scene sceneOf(std::string object, double scale_mm, std::vector<Light> lights) {
    Scene scene;
    scene.object = std::move(object);
    scene.scale = scale_mm;
    scene.lights = std::move(lights);
    return scene;
}

LitBodyOptions bodyOptions(const PaperRun& run, int size, double cell_pixels) {
    const int side = run.size > 0 ? run.size : size;
    return {.width = side, .height = side, .cell_pixels = cell_pixels, .seed = run.seed, .threads = run.threads};
}

namespace {

// Half the difference of the halves: its mean square is that of the mean's error, without the floor of one exit that
// the standard errors of cells have.
Image halfDifference(const Image& a, const Image& b) {
    Image difference = a;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const Rgba &p = a.pixels[i], &q = b.pixels[i];
        difference.pixels[i] = {0.5f * std::abs(p.r - q.r), 0.5f * std::abs(p.g - q.g), 0.5f * std::abs(p.b - q.b),
                                p.a};
    }
    return difference;
}

}  // namespace

double ReferencePicture::ssimOfHalves(double exposure, int threads) const {
    return compareImages(halves[0], halves[1], {.exposure = exposure, .threads = threads}).ssim;
}

WalkedBody walkBodyTwice(const PaperRun& run, const LitBody& body, std::uint64_t walks) {
    const std::uint64_t half = std::max<std::uint64_t>(1, walks / 2);
    const SphereExitance a = body.walk(half, 2 * run.seed, run.observer);
    const SphereExitance b = body.walk(half, 2 * run.seed + 1, run.observer);
    WalkedBody walked{meanOf(a, b), {}};
    walked.reference.halves = {body.picture(a), body.picture(b)};
    walked.reference.picture = {body.picture(walked.exitance),
                                halfDifference(walked.reference.halves[0], walked.reference.halves[1])};
    return walked;
}

FirstExitance firstExitance(const PaperRun& run, const LitBody& body, std::uint64_t walks) {
    return body.firstOrders(walks, run.observer);
}

NoisyImage noisyImage(const LitBody& body, const SphereExitance& exitance) {
    return {body.picture(exitance), body.errorPicture(exitance)};
}

std::string partText(double value) { return fmt::format("{:.1f} %", 100 * value); }

std::string noteOf(const NoisyError& error) {
    return fmt::format("RMSE {}, SSIM {:.3f}", partText(error.bias), error.ssim);
}

std::string_view errorCsvHeader() {
    return "material,model,single_scattering,relative_rmse,relative_noise,relative_rmse_without_noise,"
           "mean_difference,ssim\n";
}

std::string errorCsvRow(std::string_view material, std::string_view model, std::string_view single,
                        const NoisyError& e) {
    return fmt::format("{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", material, model, single, e.rmse, e.noise,
                       e.bias, e.mean, e.ssim);
}

}  // namespace searchlight
