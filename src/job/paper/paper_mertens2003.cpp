// [Mertens2003], by the numbers of its slides: light gathered from what the eye sees.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "job/paper/paper.h"
#include "job/paper/paper_studio.h"
#include "job/render/render_material.h"
#include "job/unit_progress.h"
#include "model/plane.h"
#include "render/screen/tangent_samples.h"

namespace searchlight {

namespace {

ParamValues seenAlone(double samples) { return {{"samples", samples}, {"global_points", 0.0}}; }

void chooseScene(PaperPlate& plate, const PaperRun& run, const std::string& more) {
    plate.choices.push_back("in place of the head of the slides: " + studioText(run));
    plate.choices.push_back(more);
}

double errorOf(const Image& image, const Image& truth) {
    return compareImages(image, truth, {.perceptual = false}).relative_rmse;
}

// Large and dense: the head of the slides is as large as a head.
void makeLarge(PaperStudio& studio) {
    studio.scene.material.id = "skin1";
    studio.scene.scale = 100;
}

PaperPlate slide8(const PaperRun& run) {
    PaperPlate plate;
    chooseScene(plate, run, "skin1, 100 mm; diffuse: the same medium, a thousand times as dense; 256 samples");
    UnitProgress progress(run.observer, "pictures", 2);
    PaperStudio studio(run, progress);
    makeLarge(studio);
    const PaperPicture scattered = studio.take("local", seenAlone(256));
    progress.finish();
    studio.scene.material.scale = 1e-3;
    const PaperPicture diffuse = studio.take("local", seenAlone(256));
    progress.finish();
    ContactSheet sheet = paperSheet(studio, "Local subsurface scattering, slides 8 and 21",
                                    "Difference: orange where scattering adds light, blue where it takes some; ends "
                                    "at half the mean.");
    sheet.columns = {"Local subsurface scattering", "Diffuse", "Difference"};
    sheet.rows = {""};
    sheet.cells = {shownCell(scattered.image, scattered.exposure), shownCell(diffuse.image, scattered.exposure),
                   differenceCell(scattered.image, diffuse.image, 0.5, "")};
    plate.sheet = std::move(sheet);
    // Where it was dark: lit by less than a hundredth of the mean, and seen.
    double mean = 0, covered = 0;
    Rgb bled{}, lit{};
    for (const Rgba& pixel : diffuse.image.pixels) {
        mean += static_cast<double>(pixel.r) + pixel.g + pixel.b;
        covered += pixel.a;
    }
    mean /= 3 * covered;
    std::size_t shadowed = 0;
    for (std::size_t i = 0; i < diffuse.image.pixels.size(); ++i) {
        const Rgba &before = diffuse.image.pixels[i], &after = scattered.image.pixels[i];
        if (before.a < 1) continue;
        const bool dark = static_cast<double>(before.r) + before.g + before.b < 0.03 * mean;
        shadowed += dark;
        Rgb& sum = dark ? bled : lit;
        sum = sum + Rgb{after.r, after.g, after.b};
    }
    plate.values = {{"shadowed_pixels", shadowed},
                    {"red_over_blue_in_shadow", bled.r / bled.b},
                    {"red_over_blue_in_light", lit.r / lit.b}};
    plate.statements.push_back(
        {.says = "colour bleeds into shadows, and smooths their borders",
         .found =
             fmt::format("in the {} pixels that are dark without scattering, red is {:.1f} times blue, where light "
                         "falls {:.1f} times",
                         shadowed, bled.r / bled.b, lit.r / lit.b),
         .holds = bled.r / bled.b > 1.5 * lit.r / lit.b});
    return plate;
}

PaperPlate slide9(const PaperRun& run) {
    PaperPlate plate;
    chooseScene(plate, run, "skin1; the lamp before and behind the object; 256 samples");
    UnitProgress progress(run.observer, "pictures", 4 * 3);
    PaperStudio studio(run, progress);
    studio.scene.material.id = "skin1";
    ContactSheet sheet = paperSheet(studio, "Local and full response, slides 9 and 26",
                                    "Below: relative RMSE against the sum over all points. Differences end at the "
                                    "picture's mean.");
    sheet.rows = {"Local", "Local, and points for what is not seen", "Full: all points", "Local − full"};
    sheet.cells.resize(16);
    std::array<double, 4> errors{}, mended{};
    for (std::size_t k = 0; k < 4; ++k) {
        const bool behind = k % 2 == 1;
        const double size = k < 2 ? 100 : 10;
        studio.scene.material.scale = 10 / size;
        studio.scene.camera.azimuth_deg = behind ? 200 : 30;
        sheet.columns.push_back(fmt::format("{:.0f} mm, lit from {}", size, behind ? "behind" : "before"));
        const PaperPicture full = studio.truth();
        progress.finish();
        const PaperPicture local = studio.take("local", seenAlone(256));
        progress.finish();
        const PaperPicture more = studio.take("local", {{"samples", 256.0}});
        progress.finish();
        errors[k] = errorOf(local.image, full.image);
        mended[k] = errorOf(more.image, full.image);
        sheet.cells[k] = shownCell(local.image, full.exposure, percentOf(errors[k]));
        sheet.cells[4 + k] = shownCell(more.image, full.exposure, percentOf(mended[k]));
        sheet.cells[8 + k] = shownCell(full.image, full.exposure);
        sheet.cells[12 + k] = differenceCell(local.image, full.image, 1, "");
        plate.values["pictures"].push_back(
            {{"size_mm", size}, {"behind", behind}, {"local", errors[k]}, {"local_and_points", mended[k]}});
    }
    plate.sheet = std::move(sheet);
    plate.choices.emplace_back("10 and 100 mm by the scale of the medium; the object stays as it is");
    plate.statements.push_back(
        {.says = "on a large scale, lit from before, sampling what is seen is enough",
         .found = fmt::format("error {} at 100 mm, {} at 10 mm", percentOf(errors[0]), percentOf(errors[2])),
         .holds = errors[0] < 0.1});
    plate.statements.push_back(
        {.says = "there are no global effects, as in ears lit from behind, and edges of depth show ghosts",
         .found = fmt::format("from behind the error is {} at 100 mm and {} at 10 mm; with points for what is not seen "
                              "{} and {}",
                              percentOf(errors[1]), percentOf(errors[3]), percentOf(mended[1]), percentOf(mended[3])),
         .holds = errors[3] > 5 * errors[2] || errors[3] > 0.5});
    return plate;
}

// Samples of two kinds, at the receivers of a picture that was taken.
class Receivers {
public:
    Receivers(const PaperRun& run, PaperStudio& studio, Observer& observer)
        : run_(run), observer_(observer), width_(studio.width), height_(studio.height) {
        const PaperPicture picture = studio.take("local", seenAlone(1));
        const RenderStages stages = studio.stages("local");
        visible_ = *stages.visible;
        patches_ = screenPatches(makeView(picture.camera, *stages.object, width_, height_), visible_, run.threads);
        setLight(visible_, stages.irradiance->transmitted, patches_);
        const RenderMaterial material = materialSource(run.engine, "cpu")(studio.scene);
        profile_ = tabulate(*material.evaluator, material.model, material.medium).profile;
    }

    /// Exitance as a picture.
    Image take(int tangent, int facing, std::uint64_t seed) const {
        std::vector<Rgbf> exitance(visible_.positions.size());
        TangentSampler(profile_, tangent, facing, seed).gather(patches_, run_.threads, observer_, exitance);
        Image image(width_, height_);
        for (std::size_t i = 0; i < exitance.size(); ++i) {
            const float part = visible_.coverage[i];
            Rgba& pixel = image.pixels[visible_.pixels[i]];
            const Rgbf& m = exitance[i];
            pixel = {pixel.r + part * m.r, pixel.g + part * m.g, pixel.b + part * m.b, pixel.a + part};
        }
        return image;
    }

private:
    const PaperRun& run_;
    Observer& observer_;
    int width_, height_;
    VisibleSurface visible_;
    ScreenPatches patches_;
    Profile profile_;
};

// What that part of the pixels' errors does not exceed, relative to the mean.
double quantileOf(const Image& image, const Image& truth, double part) {
    std::vector<double> errors;
    double mean = 0;
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
        const Rgba &a = image.pixels[i], &b = truth.pixels[i];
        if (b.a <= 0) continue;
        mean += (static_cast<double>(b.r) + b.g + b.b) / 3;
        errors.push_back(std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)}));
    }
    mean /= static_cast<double>(errors.size());
    const auto place = errors.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(errors.size()));
    std::ranges::nth_element(errors, place);
    return *place / mean;
}

// "2.7 %", "22 times"
std::string ofMean(double error) { return error < 10 ? percentOf(error) : fmt::format("{:.0f} times", error); }

PaperPlate slide18(const PaperRun& run) {
    PaperPlate plate;
    chooseScene(plate, run, "skin1, 100 mm; the truth is the mean of 8,192 samples, of the same light that is seen");
    plate.choices.emplace_back(
        "combined: 3/4 by importance in the tangent plane, 1/8 by importance and 1/8 evenly in the plane that faces "
        "the "
        "eye, weighed by multiple importance sampling; each receiver's own turn is blue noise, not an interleaved "
        "tile");
    const std::array<int, 4> counts{16, 64, 256, 1024};
    UnitProgress progress(run.observer, "pictures", 2 * counts.size() + 1);
    PaperStudio studio(run, progress);
    makeLarge(studio);
    const Receivers receivers(run, studio, progress);
    const Image truth = receivers.take(6144, 2048, run.seed + 1000);
    progress.finish();
    double mean = 0, covered = 0;
    for (const Rgba& pixel : truth.pixels)
        mean += (static_cast<double>(pixel.r) + pixel.g + pixel.b) / 3, covered += pixel.a;
    const double exposure = std::log2(0.35 * covered / mean);
    ContactSheet sheet = paperSheet(studio, "Importance alone, and combined with even samples, slide 18",
                                    "Exitance by light that is seen. Differences end at the mean. Below: what one "
                                    "pixel in ten and one in a thousand exceed.");
    sheet.column_title = "Samples";
    sheet.rows = {"Importance alone", "Combined", "Importance alone, difference", "Combined, difference"};
    sheet.cells.resize(4 * counts.size());
    plate.figure.title = "Error over samples, slide 18";
    plate.figure.caption =
        "Of the exitance by light that is seen; solid: what one pixel in ten exceeds; dashed: "
        "one in a thousand.";
    plate.figure.x = {.label = "Samples", .scale = AxisScale::logarithmic};
    plate.figure.y = {.label = "Error over the mean", .unit = "%", .scale = AxisScale::logarithmic};
    std::array<std::array<double, 4>, 2> errors{}, worst{}, rms{};
    for (std::size_t k = 0; k < 2; ++k) {
        Series most_pixels{.label = k == 0 ? "importance alone" : "combined", .color = static_cast<int>(k)};
        Series most{.label = most_pixels.label + ", one in a thousand", .color = static_cast<int>(k), .dashed = true};
        for (std::size_t i = 0; i < counts.size(); ++i) {
            const int facing = k == 0 ? 0 : counts[i] / 4;
            const Image image = receivers.take(counts[i] - facing, facing, run.seed);
            errors[k][i] = quantileOf(image, truth, 0.9);
            worst[k][i] = quantileOf(image, truth, 0.999);
            rms[k][i] = errorOf(image, truth);
            if (k == 0) sheet.columns.push_back(fmt::format("{}", counts[i]));
            sheet.cells[k * counts.size() + i] =
                shownCell(image, exposure, fmt::format("{}, {}", ofMean(errors[k][i]), ofMean(worst[k][i])));
            sheet.cells[(2 + k) * counts.size() + i] = differenceCell(image, truth, 1, "");
            for (Series* series : {&most_pixels, &most}) series->x.push_back(counts[i]);
            most_pixels.y.push_back(100 * errors[k][i]);
            most.y.push_back(100 * worst[k][i]);
            progress.finish();
        }
        plate.values[k == 0 ? "importance_alone" : "combined"] = {
            {"samples", counts}, {"relative_rmse", rms[k]}, {"one_in_ten", errors[k]}, {"one_in_a_thousand", worst[k]}};
        plate.figure.series.push_back(std::move(most_pixels));
        plate.figure.series.push_back(std::move(most));
    }
    plate.sheet = std::move(sheet);
    plate.statements.push_back(
        {.says = "samples by importance alone fail at discontinuities; combined with even ones they do not",
         .found =
             fmt::format("64 samples: one pixel in ten is off by more than {} of the mean alone, {} combined; one in a "
                         "thousand by {} and {}. Alone more samples do not help these: an edge that importance "
                         "knows nothing of has no finite variance",
                         ofMean(errors[0][1]), ofMean(errors[1][1]), ofMean(worst[0][1]), ofMean(worst[1][1])),
         .holds = worst[0][1] > 1.5 * worst[1][1]});
    return plate;
}

PaperPlate slide20(const PaperRun& run) {
    PaperPlate plate;
    const int side = run.size > 0 ? run.size : 500;
    plate.choices.push_back(fmt::format(
        "{} in skin1, 100 mm, {} x {} pixels; processor time of all threads, the least of three; the slides "
        "do not say how many samples their pictures took",
        run.object, side, side));
    const std::array<double, 5> counts{8, 16, 32, 64, 128};
    UnitProgress progress(run.observer, "numbers of samples", counts.size());
    PaperStudio studio(run, progress);
    studio.width = studio.height = side;
    makeLarge(studio);
    plate.table =
        fmt::format("{:<10}{:>16}{:>16}{:>24}\n", "samples", "light, ms", "samples, ms", "frames/s of one core");
    plate.figure.title = "Cost of a frame over samples, slide 20";
    plate.figure.x = {.label = "Samples"};
    plate.figure.y = {.label = "CPU time of a frame", .unit = "ms"};
    Series frame{.label = "new light and sum", .color = 0}, sum{.label = "sum", .color = 1};
    double of_sixteen = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (i == 0) studio.take("local", seenAlone(counts[i]));
        double prepare = INFINITY, step = INFINITY;
        for (int repeat = 0; repeat < 3; ++repeat) {
            std::get<PointLight>(studio.scene.lights[0]).position.x += 1e-4;
            const PaperPicture picture = studio.take("local", seenAlone(counts[i]));
            prepare = std::min(prepare, picture.prepare_cpu_ms);
            step = std::min(step, picture.sum_cpu_ms);
        }
        const double rate = 1000 / (prepare + step);
        if (counts[i] == 16) of_sixteen = rate;
        plate.table += fmt::format("{:<10}{:>16.1f}{:>16.1f}{:>24.1f}\n", counts[i], prepare, step, rate);
        plate.values["samples"].push_back(counts[i]);
        plate.values["light_cpu_ms"].push_back(prepare);
        plate.values["sum_cpu_ms"].push_back(step);
        frame.x.push_back(counts[i]), frame.y.push_back(prepare + step);
        sum.x.push_back(counts[i]), sum.y.push_back(step);
        progress.finish();
    }
    plate.figure.series = {std::move(frame), std::move(sum)};
    plate.statements.push_back(
        {.says = "500 x 500 pixels take 4 to 5 frames per second on a Radeon 9700 Pro",
         .found = fmt::format("{:.1f} frames per second of one core with 16 samples", of_sixteen),
         .holds = of_sixteen > 4});
    return plate;
}

}  // namespace

Paper mertens2003Paper() {
    return {.id = "mertens2003",
            .citation =
                "Mertens, Kautz, Bekaert, Van Reeth, Seidel: Efficient Rendering of Local Subsurface "
                "Scattering. Pacific Graphics, 2003 (slides)",
            .figures = {{"8", "local subsurface scattering beside diffuse reflection", slide8},
                        {"9", "local and full response, from before and behind", slide9},
                        {"18", "samples by importance alone, and combined", slide18}},
            .tables = {{"20", "frames per second", slide20}}};
}

}  // namespace searchlight
