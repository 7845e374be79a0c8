#include "gui/kernel/live_kernels.h"

#include <algorithm>

#include "base/error.h"
#include "gui/view/shown_image.h"
#include "job/model_stamp.h"
#include "plot/kernel_plots.h"

namespace searchlight::gui {

namespace {

constexpr std::uint64_t draft_walks = 100'000, all_walks = 1'000'000;
// A row of a drag of a slider is never seen again.
constexpr std::size_t most_rows = 200;

KernelPictures picturesOf(const Judge& judge, const JudgedKernel& judged, std::size_t signal) {
    const Image& exact = judge.exact()[signal];
    const Image filtered = tapsFilter(judge.inputs()[signal], judged.made.taps, {.pixel_mm = judge.pixel()});
    return {.before = shownImage(judge.inputs()[signal], {}, "color"),
            .exact = shownImage(exact, {}, "color"),
            .filtered = shownImage(filtered, {}, "color"),
            .difference = differenceImage(filtered, exact, kKernelDifferenceScale, "luminance"),
            .rms = Judge::overall({judged.image_rms[signal]})};
}

}  // namespace

std::string LiveKernels::keyOf(const KernelWish& wish) {
    const bool uses_model = wish.of_model || wish.material.inverted();
    return wish.truthKey() + (uses_model ? modelStamp(wish.model.id) : std::string());
}

bool LiveKernels::improveTruth(const KernelWish& wish, Observer& observer) {
    const std::string key = keyOf(wish);
    const bool known = base_ && key == key_;
    if (known && (wish.of_model || walks_ == all_walks)) return false;
    Job job;
    job.scene.material = wish.material;
    job.scene.model = wish.model;
    Subject subject = comparableSubjectOf(job, engine_);
    KernelTruthOptions options{.walks = known ? all_walks : draft_walks, .seed = wish.seed};
    if (wish.of_model) {
        options.model = wish.model.id;
        for (const auto& [name, value] : wish.model.parameters)
            options.set += (options.set.empty() ? "" : ",") + name + "=" + valueText(value);
    }
    KernelTruth truth = kernelTruth(subject, options, engine_, observer);
    if (engine_.contextLost()) {
        engine_.dropContext();
        truth = kernelTruth(subject, options, engine_, observer);
    }
    Judge judge(truth.truth);
    const TwoGaussians fitted = fittedTwoGaussians(truth.truth);
    base_ =
        std::make_shared<const KernelBase>(KernelBase{std::move(subject), std::move(truth), std::move(judge), fitted});
    key_ = key;
    walks_ = options.walks;
    rows_.clear();
    return true;
}

std::shared_ptr<const JudgedKernel> LiveKernels::row(const KernelWish& wish, const NamedMethod& method,
                                                     bool perceptual) {
    if (rows_.size() > most_rows) rows_.clear();
    Row& row = rows_[wish.rowKey(method.name)];
    if (row.judged && (row.perceptual || !perceptual)) return row.judged;
    MethodOptions options = method.options;
    if (options.method == "manual") options.manual = wish.manual.value_or(base_->fitted);
    row.judged =
        std::make_shared<const JudgedKernel>(makeAndJudge(base_->truth.truth, base_->judge, options, perceptual, 0));
    row.perceptual = perceptual;
    return row.judged;
}

KernelShown LiveKernels::show(const KernelWish& wish) {
    const std::vector<NamedMethod> methods = namedMethods(wish.taps);
    const auto method = std::ranges::find(methods, wish.method, &NamedMethod::name);
    KernelShown shown{.base = base_, .judged = row(wish, *method, false)};
    const MadeKernel& made = shown.judged->made;
    const std::vector<KernelCurve> curves{{made.name, made.kernel ? *made.kernel : kernelOfTaps(made.taps), made.taps}};
    if (wish.view == "pictures")
        shown.pictures = picturesOf(base_->judge, *shown.judged, wish.signal);
    else if (wish.view == "edge")
        shown.figure = kernelEdgeFigure(base_->judge, curves, wish.channel, {});
    else if (wish.view == "curves" && base_->truth.truth.scatters(wish.channel))
        shown.figure = kernelSliceFigure(base_->truth.truth, curves, wish.channel, {});
    shown.figure.caption.clear();
    return shown;
}

}  // namespace searchlight::gui
