// Figures of [Freude2014]: singular values, pictures' differences, crosses and bands.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "job/paper/freude2014.h"
#include "kernel/judge.h"
#include "kernel/methods.h"
#include "kernel/singular.h"
#include "plot/kernel_plots.h"

namespace searchlight::freude2014 {

namespace {

std::vector<KernelCurve> curvesOf(const KernelTruth& truth, const Judge& judge,
                                  const std::vector<MethodOptions>& list) {
    std::vector<KernelCurve> curves;
    for (const MethodOptions& options : list) {
        MadeKernel made = makeKernel(truth.truth, judge.cells(), options);
        curves.push_back({made.name, made.kernel ? *made.kernel : kernelOfTaps(made.taps), made.taps});
    }
    return curves;
}

// Fourth and eighth harmonics of the angle, over the mean, of luminance in an annulus about the middle: 0 for a radial
// kernel. Single taps, and grain, have little part in it.
double crossOf(const Image& image, double radius_pixels) {
    const int n = image.width;
    double mean = 0;
    std::array<double, 4> wave{};
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const double dx = x + 0.5 - 0.5 * n, dy = y + 0.5 - 0.5 * n, r = std::hypot(dx, dy);
            if (r < 0.6 * radius_pixels || r > 1.2 * radius_pixels) continue;
            const Rgba& pixel = image.at(x, y);
            const double value = luminance({pixel.r, pixel.g, pixel.b}), angle = std::atan2(dy, dx);
            mean += value;
            for (std::size_t k = 0; k < 2; ++k) {
                wave[2 * k] += 2 * value * std::cos(4.0 * static_cast<double>(k + 1) * angle);
                wave[2 * k + 1] += 2 * value * std::sin(4.0 * static_cast<double>(k + 1) * angle);
            }
        }
    double square = 0;
    for (const double part : wave) square += part * part;
    return std::sqrt(square) / mean;
}

// Root of the mean square difference of slopes along the middle row, over the steepest slope of the truth.
double bandingOf(const Image& image, const Image& exact) {
    const int n = image.width, row = n / 2;
    double sum = 0, steepest = 0;
    for (int x = 0; x + 1 < n; ++x) {
        const double slope = image.at(x + 1, row).r - image.at(x, row).r;
        const double truth = exact.at(x + 1, row).r - exact.at(x, row).r;
        sum += (slope - truth) * (slope - truth);
        steepest = std::max(steepest, std::abs(truth));
    }
    return std::sqrt(sum / n) / steepest;
}

}  // namespace

PaperPlate figure51(const PaperRun& run) {
    PaperPlate plate;
    plate.choices = {ground_truth, "the thesis' grid; the first 30 singular values over the first"};
    Figure& figure = plate.figure;
    figure.title = "Singular values of the kernels, Fig. 5.1";
    figure.columns = 3;
    int color = 0;
    double slowest = 0;
    for (int c = 0; c < Rgb::channels; ++c) {
        Figure panel{.title = std::string(1, "RGB"[c])};
        panel.x = {.label = "Number", .min = 1, .max = 30};
        panel.y = {.label = "Singular value over the first",
                   .unit = "",
                   .scale = AxisScale::logarithmic,
                   .min = 1e-4,
                   .max = 1};
        figure.panels.push_back(std::move(panel));
    }
    for (const char* material : material_ids) {
        const KernelTruth truth = truthOf(material, run, true);
        const CellKernel cells = cellKernel(truth.truth, thesisGrid(truth.shortest_mfp_mm, truth.longest_mfp_mm));
        const SingularKernel kernel = singularKernel(cells, 30);
        for (std::size_t c = 0; c < Rgb::channels; ++c) {
            Series series{.label = material, .color = color, .in_legend = c == 0};
            for (std::size_t k = 0; k < 30; ++k) {
                series.x.push_back(static_cast<double>(k + 1));
                series.y.push_back(std::abs(kernel.eigenvalues[c][k] / kernel.eigenvalues[c][0]));
            }
            slowest = std::max(slowest, series.y[5]);
            figure.panels[c].series.push_back(std::move(series));
        }
        ++color;
    }
    plate.statements.push_back({.says = "singular values decay rapidly for all materials",
                                .found = fmt::format("the sixth is at most {:.3f} of the first", slowest),
                                .holds = slowest < 0.1});
    return plate;
}

PaperPlate figure66(const PaperRun& run) {
    PaperPlate plate;
    plate.choices = {ground_truth, "17 taps instead of 200: what a shader has", "differences instead of pictures"};
    const KernelTruth truth = truthOf("skin1", run, false);
    const Judge judge(truth.truth);
    const std::vector<KernelCurve> curves = curvesOf(truth, judge,
                                                     {{.method = "svd"},
                                                      {},
                                                      {.method = "guided"},
                                                      {.method = "manual", .preset = "skin1"},
                                                      {.method = "optimised"},
                                                      {.method = "gaussians", .count = 2},
                                                      {.method = "svd", .rank = 2},
                                                      {.method = "optimised", .rank = 2}});
    const std::size_t squares = signalNamed("squares");
    plate.figure = kernelDifferenceFigure(judge, curves, squares, "A circle and two squares on Skin1, Fig. 6.6");
    std::string found;
    double best = 0, worst = 0;
    for (const KernelCurve& curve : curves) {
        const double error = Judge::overall({judge.imageRms(curve.taps)[squares]});
        plate.values[curve.label] = error;
        found += fmt::format("{}{} {:.4f}", found.empty() ? "RMS: " : ", ", curve.label, error);
        if (curve.label == "preintegrated") best = error;
        if (curve.label == "svd 1") worst = error;
    }
    plate.statements.push_back({.says = "SVD rank 1 is of low quality, pre-integration close to the ground truth",
                                .found = found,
                                .holds = best < 0.5 * worst});
    return plate;
}

PaperPlate figure626(const PaperRun& run) {
    PaperPlate plate;
    plate.choices = {
        ground_truth,
        "a small disc of light, and an upright edge, seen so near that the kernel fills the picture: 8 "
        "half-energy radii of the green channel on 192 pixels, 17 taps",
        "cross: fourth and eighth harmonic of the angle, over the mean, between 0.6 and 1.2 red half-energy radii "
        "around the disc; banding: RMS difference of slopes of the edge, red, over the steepest slope of the truth",
        "pictures: RMS error over the seven signals; frames are pictures with other turns of the axes, averaged"};
    const KernelTruth truth = truthOf("skin1", run, false);
    const double side = 8 * truth.truth.radiusOf(0.5, 1);
    const Judge judge(truth.truth, {.size = 192, .side_mm = side});
    Image disc(192, 192, {0, 0, 0, 1});
    for (int y = 0; y < 192; ++y)
        for (int x = 0; x < 192; ++x)
            if (std::hypot(x - 95.5, y - 95.5) < 5) disc.at(x, y) = {1, 1, 1, 1};
    const double ring = std::min(0.4 * side, truth.truth.radiusOf(0.5, 0)) / judge.pixel();
    struct Row {
        std::string name;
        MethodOptions options;
        int frames = 0;  // 0: axes at rest
    };
    const std::vector<Row> rows{{"pre-integrated", {}},
                                {"pre-integrated, turned, 1 frame", {}, 1},
                                {"pre-integrated, turned, 8 frames", {}, 8},
                                {"optimised 1", {.method = "optimised"}},
                                {"turned, 1 frame", {.method = "turned"}, 1},
                                {"turned, 8 frames", {.method = "turned"}, 8},
                                {"turned, 64 frames", {.method = "turned"}, 64},
                                {"SVD 2", {.method = "svd", .rank = 2}},
                                {"2 Gaussians", {.method = "gaussians", .count = 2}},
                                {"optimised 2", {.method = "optimised", .rank = 2}}};
    const Image exact = exactFilter(disc, judge.spectrum(), judge.pixel());
    const Judge pictures(truth.truth);
    plate.table = fmt::format("{:<34} {:>6} {:>8} {:>9} {:>9}\n", "kernel", "passes", "cross", "banding", "pictures");
    Figure& figure = plate.figure;
    figure.title = "A disc of light, near: cross and grain, Fig. 6.26";
    figure.caption = "Luminance of a disc of light of 0.15 mm radius, after the passes; all on one logarithmic scale.";
    figure.columns = 4;
    double end = 0;
    const auto panel = [&](const std::string& name, const Image& image) {
        Figure made{.title = name, .x = {.label = "x", .unit = "mm"}, .y = {.label = "y", .unit = "mm"}};
        FalseColor map;
        for (int i = 0; i <= image.width; ++i) map.x_edges.push_back(i * judge.pixel());
        map.y_edges = map.x_edges;
        for (int y = image.height - 1; y >= 0; --y)
            for (int x = 0; x < image.width; ++x) {
                const Rgba& pixel = image.at(x, y);
                map.values.push_back(std::max(1e-6, luminance({pixel.r, pixel.g, pixel.b})));
            }
        if (end == 0) end = *std::ranges::max_element(map.values);
        for (double& value : map.values) value = std::clamp(value, 1e-3 * end, end);
        made.map = std::move(map);
        figure.panels.push_back(std::move(made));
    };
    panel("ground truth", exact);
    const double of_truth = crossOf(exact, ring);
    plate.table += fmt::format("{:<34} {:>6} {:>8.3f} {:>9.4f} {:>9.4f}\n", "ground truth", "", of_truth, 0.0, 0.0);
    struct Measured {
        double cross, banding, pictures;
    };
    std::map<std::string, Measured> found;
    for (const Row& row : rows) {
        MadeKernel made = makeKernel(truth.truth, judge.cells(), row.options);
        made.taps.turned = row.frames > 0;
        const Image image = judge.filter(disc, made.taps, row.frames);
        panel(row.name, image);
        const Measured here{
            crossOf(image, ring),
            bandingOf(judge.filter(judge.inputs().front(), made.taps, row.frames), judge.exact().front()),
            Judge::overall(pictures.imageRms(made.taps, row.frames))};
        found[row.name] = here;
        plate.table += fmt::format("{:<34} {:>6} {:>8.3f} {:>9.4f} {:>9.4f}\n", row.name, 2 * made.rank(), here.cross,
                                   here.banding, here.pictures);
        plate.values[row.name] = {{"cross", here.cross}, {"banding", here.banding}, {"pictures", here.pictures}};
    }
    figure.color = {.label = "Luminance", .scale = AxisScale::logarithmic, .min = 1e-3 * end, .max = end};
    const auto says = [&](const char* name) {
        const Measured& m = found[name];
        return fmt::format("{:.2f}, {:.2f} and {:.4f}", m.cross, m.banding, m.pictures);
    };
    plate.statements.push_back(
        {.says = "a pre-integrated kernel shows a cross around small features, and bands at 17 taps",
         .found = fmt::format("cross {:.2f} ({:.3f} of the ground truth itself), banding {:.2f}",
                              found["pre-integrated"].cross, of_truth, found["pre-integrated"].banding),
         .holds = found["pre-integrated"].cross > 10 * of_truth});
    plate.statements.push_back(
        {.says = "at equal passes both can be taken away: here, by axes that turn and taps made for them",
         .found = fmt::format(
             "cross, banding and error of pictures: pre-integrated {}; turned taps {} in one frame, {} "
             "over 8 and {} over 64",
             says("pre-integrated"), says("turned, 1 frame"), says("turned, 8 frames"), says("turned, 64 frames")),
         .holds = found["turned, 8 frames"].cross < 0.2 * found["pre-integrated"].cross &&
                  found["turned, 64 frames"].banding < found["pre-integrated"].banding});
    return plate;
}

}  // namespace searchlight::freude2014
