// The file itself: readable, compiling, portable, and the same on both backends.
#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "model/physics.h"
#include "model/sum_model.h"
#include "validate/check_bench.h"

namespace searchlight {

Finding checkFormat(CheckBench& bench) {
    const BssrdfFile& file = bench.file();
    const std::string found = fmt::format("{}: {}", file.title, join(file.attributes, " "));
    if (const std::string twice = countedTwice(bench.model()); !twice.empty())
        return reported(fmt::format("{}. {}", found, twice));
    return passed(found);
}

Finding checkCompiles(CheckBench& bench) {
    if (bench.model().measured) return skipped("a measured profile has no GLSL");
    if (!bench.gl()) return skipped(bench.noGl());
    bench.gl()->set(checkMedia().front(), bench.parameters());
    // Compiled when first called.
    if (hasDiffuseReflectance(bench.model())) bench.gl()->diffuseReflectance({0.5, 0.5, 0.5});
    return passed(bench.gl()->backend());
}

Finding checkPortable(CheckBench& bench) {
    if (bench.model().measured) return skipped("a measured profile has no GLSL");
    const Model& model = bench.model();
    for (const Model& part : model.parts.empty() ? std::vector{model} : model.parts)
        if (!part.measured)
            if (const auto reason = portabilityError(part.file))
                return reported(fmt::format("runs on OpenGL only: {}", reason->what()));
    return passed("inside the subset");
}

Finding checkBackendsAgree(CheckBench& bench) {
    if (!bench.isNative() || bench.model().measured) return skipped("it has one backend");
    if (!bench.gl()) return skipped(bench.noGl());
    // At the lowest albedo 30 mean free paths are an exponent of 70, and three roundings of it (distance, decay
    // constant, product) of 6e-8 each are 1.3e-5 of the value; the models subtract nothing that would lose more.
    constexpr double tolerance = 2e-5;
    // Nearer to grazing, refract() of the same float direction has an error of 6e-8 / cosine^2 at IOR 1.
    const Probe probe = makeProbe({.least_cosine = 0.2});
    Difference worst;
    for (const Medium& medium : checkMedia()) {
        const std::vector<Rgb> native = bench.values(medium, probe);
        std::vector<Rgb> gl(native.size());
        bench.gl()->set(medium, bench.parameters());
        bench.gl()->evaluate(probe.queries, gl);
        worst.see(CheckBench::difference(medium, probe, native, gl));
    }
    if (worst.relative > tolerance)
        return failed(fmt::format("they differ by {} at {}", prettyNumber(worst.relative, 2), worst.where));
    return passed(fmt::format("{} and {} differ by {} at most", bench.evaluator().backend(), bench.gl()->backend(),
                              prettyNumber(worst.relative, 2)));
}

}  // namespace searchlight
