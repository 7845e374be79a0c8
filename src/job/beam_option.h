// The cross-section of a beam as options of the commands that walk one.
#pragma once

#include "base/param.h"
#include "job/command.h"
#include "transport/walk/beam.h"

namespace searchlight {

namespace option {

Param beam();
Param beamRadius();

}  // namespace option

/// From both. Throws a usage Error when one lacks the other.
BeamShape beamOf(const Options& options);

const char* nameOf(BeamShape::Kind kind);

}  // namespace searchlight
