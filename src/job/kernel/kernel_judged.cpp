#include "job/kernel/kernel_judged.h"

#include <fmt/format.h>

#include <chrono>

#include "base/text.h"
#include "validate/image_error.h"

namespace searchlight {

JudgedKernel judgeKernel(MadeKernel made, const Judge& judge, bool perceptual, int threads) {
    JudgedKernel judged{.made = std::move(made)};
    judged.has_lines = judged.made.kernel.has_value();
    judged.kernel_rms = judge.kernelRms(judged.has_lines ? *judged.made.kernel : kernelOfTaps(judged.made.taps));
    judged.kernel_rms_raw = judged.made.raw ? judge.kernelRms(*judged.made.raw) : judged.kernel_rms;
    judged.image_rms = judge.imageRms(judged.made.taps);
    judged.overall = Judge::overall(judged.image_rms);
    if (!perceptual) return judged;
    judged.ssim = 0;
    for (std::size_t i = 0; i < judge.inputs().size(); ++i) {
        const Image image = judge.filter(judge.inputs()[i], judged.made.taps);
        const ImageError error = compareImages(image, judge.exact()[i], {.threads = threads});
        judged.flip += error.flip / static_cast<double>(judge.inputs().size());
        judged.ssim += error.ssim / static_cast<double>(judge.inputs().size());
    }
    return judged;
}

JudgedKernel makeAndJudge(const GroundTruth& truth, const Judge& judge, const MethodOptions& options, bool perceptual,
                          int threads) {
    const auto start = std::chrono::steady_clock::now();
    MadeKernel made = makeKernel(truth, judge.cells(), options);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    JudgedKernel judged = judgeKernel(std::move(made), judge, perceptual, threads);
    judged.seconds = seconds;
    return judged;
}

std::vector<MethodOptions> allMethods(int taps) {
    std::vector<MethodOptions> all;
    const auto add = [&](MethodOptions options) {
        options.taps = taps;
        all.push_back(std::move(options));
    };
    add({.method = "preintegrated"});
    for (const int rank : {1, 2, 3}) add({.method = "svd", .rank = rank});
    for (const double k : {0.0, 1.0, 2.0}) add({.method = "guided", .guided = {.k = k}});
    for (const int count : {1, 2, 3, 4, 6}) add({.method = "gaussians", .count = count});
    add({.method = "manual"});
    add({.method = "skin"});
    for (const int rank : {1, 2}) add({.method = "optimised", .rank = rank});
    add({.method = "turned"});
    return all;
}

namespace {

Json triple(Rgb value) { return {value.r, value.g, value.b}; }

}  // namespace

Json judgedJson(const JudgedKernel& judged) {
    const MadeKernel& made = judged.made;
    Json images = Json::object();
    for (std::size_t i = 0; i < judged.image_rms.size(); ++i)
        images[std::string(signals()[i].name)] = triple(judged.image_rms[i]);
    images["overall"] = judged.overall;
    Json terms = Json::array();
    for (const TapTerm& term : made.taps.terms) {
        Json weights = Json::array();
        for (const Rgb& weight : term.weights) weights.push_back(triple(weight));
        terms.push_back({{"angle_deg", term.angle_deg},
                         {"scale", triple(term.scale)},
                         {"delta", triple(term.delta)},
                         {"offsets_mm", term.offsets_mm},
                         {"weights", weights}});
    }
    Json json{{"name", made.name},
              {"turned", made.taps.turned},
              {"rank", made.rank()},
              {"seconds", judged.seconds},
              {"error",
               {{"kernel_rms", triple(judged.kernel_rms)},
                {"kernel_rms_raw", triple(judged.kernel_rms_raw)},
                {"kernel_rms_of", judged.has_lines          ? "lines"
                                  : judged.made.taps.turned ? "taps, axes at rest"
                                                            : "taps"},
                {"image_rms", images},
                {"flip", judged.flip},
                {"ssim", judged.ssim}}},
              {"norm1", triple(made.taps.mass())}};
    if (made.raw) json["norm1_raw"] = triple(made.raw->mass());
    if (made.skin)
        json["skin_model"] = {{"width", made.skin->width},
                              {"strength", triple(made.skin->strength)},
                              {"falloff", triple(made.skin->falloff)}};
    json["taps"] = terms;
    return json;
}

std::string judgedText(const std::vector<JudgedKernel>& kernels) {
    std::string text =
        fmt::format("{:<16} {:>6} {:>8} {:>24} {:>9}", "kernel", "passes", "ms", "kernel RMS R G B", "pictures");
    for (const Signal& signal : signals()) text += fmt::format(" {:>8}", signal.name.substr(0, 8));
    text += fmt::format(" {:>7} {:>7}\n", "FLIP", "SSIM");
    for (const JudgedKernel& kernel : kernels) {
        text += fmt::format("{:<16} {:>6} {:>8.1f}   {:>6.3f}  {:>6.3f}  {:>6.3f} {:>9.4f}", kernel.made.name,
                            2 * kernel.made.rank(), 1e3 * kernel.seconds, kernel.kernel_rms.r, kernel.kernel_rms.g,
                            kernel.kernel_rms.b, kernel.overall);
        for (const Rgb& rms : kernel.image_rms) text += fmt::format(" {:>8.4f}", Judge::overall({rms}));
        text += fmt::format(" {:>7.4f} {:>7.4f}\n", kernel.flip, kernel.ssim);
    }
    return text;
}

std::vector<std::string> errorLines(const JudgedKernel& judged) {
    const auto text = [](Rgb value) { return fmt::format("{:.3g} {:.3g} {:.3g}", value.r, value.g, value.b); };
    std::vector<std::string> lines{
        fmt::format("Error in kernel space, relative RMS (R G B): {}{}", text(judged.kernel_rms),
                    judged.made.raw ? "; before normalisation " + text(judged.kernel_rms_raw) : std::string())};
    std::string pictures = fmt::format("RMS error of pictures in [0, 1]: {:.3g} over all", judged.overall);
    for (std::size_t i = 0; i < judged.image_rms.size(); ++i)
        pictures += fmt::format(", {} {:.3g}", signals()[i].name, Judge::overall({judged.image_rms[i]}));
    lines.push_back(pictures);
    if (judged.made.taps.turned)
        lines.push_back(
            fmt::format("Turn the axes by a random angle of [0, 180) degrees in every pixel of both passes: {} frames "
                        "were averaged",
                        Judge::turned_frames));
    return lines;
}

}  // namespace searchlight
