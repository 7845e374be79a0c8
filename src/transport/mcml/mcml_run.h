// Runs of MCML's files, walked here.
#pragma once

#include "transport/mcml/mcml_file.h"
#include "transport/slab/slab.h"

namespace searchlight {

/// The slab of a run, in mm.
SlabProblem slabProblem(const McmlRun& run);

/// The walks and tallies of a run, maps included.
SlabOptions slabOptions(const McmlRun& run);

/// What MCML would have written: its units; reflected and transmitted light that never scattered counts as diffuse, in
/// the innermost cells; what lies beyond the grid counts in the last cells; cells of the angle have MCML's measures,
/// sin(middle) d(angle), 11 % from the solid angle for a single cell. `result` is that of walkSlab(slabProblem(run),
/// slabOptions(run)), with whatever number of walks.
McmlOutput mcmlOutput(const McmlRun& run, const SlabResult& result);

}  // namespace searchlight
