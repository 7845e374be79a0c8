#include "job/kernel/kernel_export.h"

#include "base/error.h"
#include "base/text.h"
#include "kernel/kernel_text.h"

namespace searchlight {

std::vector<std::string> kernelExports() {
    std::vector<std::string> names;
    for (const TapsFormat& known : tapsFormats()) names.emplace_back(known.name);
    for (const std::string_view engine : engineProfiles()) names.emplace_back(engine);
    return names;
}

std::string exportedKernel(const std::string& format, const JudgedKernel& judged, const Subject& subject,
                           const KernelTruth& truth) {
    const KernelLabel label{
        .material = subject.name, .truth = truth.label, .method = judged.made.name, .errors = errorLines(judged)};
    for (const TapsFormat& known : tapsFormats())
        if (known.name == format) return known.write(judged.made.taps, label);
    for (const std::string_view engine : engineProfiles())
        if (engine == format) return engineProfile(engine, truth.truth, label, subject.medium.eta);
    throw unknownName(ErrorKind::usage, "export", format, kernelExports());
}

}  // namespace searchlight
