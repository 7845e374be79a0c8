#include "job/beam_option.h"

#include <algorithm>

#include "base/error.h"
#include "job/shared_options.h"

namespace searchlight {

namespace {

constexpr const char* kNames[] = {"pencil", "gaussian", "flat"};

}  // namespace

namespace option {

Param beam() {
    return {.name = "beam",
            .type = ParamType::choice,
            .value = std::string(kNames[0]),
            .choices = {std::begin(kNames), std::end(kNames)},
            .doc = "cross-section of the beam, across its direction"};
}
Param beamRadius() {
    return {.name = "beam_radius",
            .unit = "mm",
            .min = 0,
            .max = unlimited,
            .value = 0.0,
            .doc = "where a flat beam ends, and a gaussian one has fallen to 1/e^2"};
}

}  // namespace option

BeamShape beamOf(const Options& options) {
    const auto name = std::ranges::find(kNames, options.text("beam"));
    const BeamShape shape{static_cast<BeamShape::Kind>(name - std::begin(kNames)), options.number("beam_radius")};
    if ((shape.kind != BeamShape::pencil) != (shape.radius > 0))
        throw usageError("--beam and --beam-radius go together", "such as --beam flat --beam-radius 1");
    return shape;
}

const char* nameOf(BeamShape::Kind kind) { return kNames[kind]; }

}  // namespace searchlight
