#include "job/kernel/kernel_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "plot/kernel_plots.h"

namespace searchlight {

namespace {

std::vector<KernelCurve> curvesOf(const std::vector<JudgedKernel>& kernels, const std::vector<std::string>& names) {
    std::vector<KernelCurve> curves;
    for (const std::string& name : names)
        for (const JudgedKernel& kernel : kernels)
            if (kernel.made.name == name)
                curves.push_back({name, kernel.made.kernel ? *kernel.made.kernel : kernelOfTaps(kernel.made.taps),
                                  kernel.made.taps});
    return curves;
}

const JudgedKernel* leastOf(const std::vector<JudgedKernel>& kernels, std::size_t rank) {
    const JudgedKernel* best = nullptr;
    for (const JudgedKernel& kernel : kernels)
        if (kernel.made.rank() == rank && (!best || kernel.overall < best->overall)) best = &kernel;
    return best;
}

ReportSection errorSection(const std::vector<JudgedKernel>& kernels) {
    ReportSection section{.heading = "Errors"};
    ReportTable table{.caption =
                          "Kernel space: root of the mean square over that of the ground truth; of optimised "
                          "kernels, of the lines that their taps stand for. Pictures: root of the mean square "
                          "difference, light within [0, 1], over seven pictures and three channels. FLIP and "
                          "SSIM: means over the pictures.",
                      .header = {"kernel", "passes", "made in ms", "kernel R", "kernel G", "kernel B", "raw R", "raw G",
                                 "raw B", "pictures", "FLIP", "SSIM"}};
    ReportTable pictures{.caption = "The same of each picture, over its channels.", .header = {"kernel"}};
    for (const Signal& signal : signals()) pictures.header.emplace_back(signal.name);
    for (const JudgedKernel& kernel : kernels) {
        std::vector<std::string> row{kernel.made.name, fmt::format("{}", 2 * kernel.made.rank()),
                                     fmt::format("{:.1f}", 1e3 * kernel.seconds)};
        for (int c = 0; c < Rgb::channels; ++c) row.push_back(fmt::format("{:.3f}", kernel.kernel_rms[c]));
        for (int c = 0; c < Rgb::channels; ++c)
            row.push_back(kernel.made.raw ? fmt::format("{:.3f}", kernel.kernel_rms_raw[c]) : std::string("–"));
        row.push_back(fmt::format("{:.4f}", kernel.overall));
        row.push_back(fmt::format("{:.4f}", kernel.flip));
        row.push_back(fmt::format("{:.4f}", kernel.ssim));
        table.rows.push_back(std::move(row));
        std::vector<std::string> of_pictures{kernel.made.name};
        for (const Rgb& rms : kernel.image_rms) of_pictures.push_back(fmt::format("{:.4f}", Judge::overall({rms})));
        pictures.rows.push_back(std::move(of_pictures));
    }
    section.tables = {std::move(table), std::move(pictures)};
    return section;
}

}  // namespace

Report kernelPage(const Subject& subject, const KernelTruth& truth, const Judge& judge,
                  const std::vector<JudgedKernel>& kernels) {
    Report report{.title = fmt::format("{}: separable kernels", subject.name)};
    for (const std::size_t rank : {1, 2, 3})
        if (const JudgedKernel* best = leastOf(kernels, rank))
            report.summary += fmt::format("{}{} passes: {} is nearest in pictures, RMS {:.4f}",
                                          report.summary.empty() ? "" : "; ", 2 * rank, best->made.name, best->overall);
    report.summary += fmt::format(". Ground truth: {}; beyond its last radius lies {:.2g} of the energy.", truth.label,
                                  truth.truth.tail());
    report.sections.push_back(errorSection(kernels));

    const std::vector<KernelCurve> lines =
        curvesOf(kernels, {"preintegrated", "svd 1", "guided k=1", "manual", "optimised 1", "optimised 2"});
    ReportSection curves{.heading = "Kernels along the axis and the diagonal"};
    ReportSection edges{.heading = "An edge"};
    static constexpr const char* channels[] = {"red", "green", "blue"};
    for (int c = 0; c < Rgb::channels; ++c) {
        if (!truth.truth.scatters(c) || (c > 0 && subject.medium.channels == 1)) continue;
        curves.figures.push_back(
            kernelSliceFigure(truth.truth, lines, c, fmt::format("Kernels of {}, {}", subject.name, channels[c])));
        edges.figures.push_back(
            kernelEdgeFigure(judge, lines, c, fmt::format("Edge on {}, {}", subject.name, channels[c])));
    }
    report.sections.push_back(std::move(curves));
    report.sections.push_back(std::move(edges));

    const std::vector<KernelCurve> all = curvesOf(kernels, {"preintegrated", "svd 1", "svd 2", "guided k=1", "manual",
                                                            "gaussians 2", "optimised 1", "optimised 2"});
    ReportSection pictures{.heading = "Pictures: before, after, difference"};
    for (std::size_t i = 0; i < signals().size(); ++i) {
        if (signals()[i].name == "edge" || signals()[i].name == "tilted_edge") continue;
        std::string shows(signals()[i].shows);
        shows[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(shows[0])));
        pictures.figures.push_back(kernelPictureFigure(judge, i, shows));
        pictures.figures.push_back(kernelDifferenceFigure(judge, all, i, shows + ": differences"));
    }
    report.sections.push_back(std::move(pictures));
    return report;
}

}  // namespace searchlight
