// Slabs as the solvers by discrete directions see them.
#pragma once

#include "transport/exact/ordinate_rays.h"
#include "transport/slab/slab.h"
#include "transport/slab/slab_single.h"

namespace searchlight {

/// The layers, phase functions smoothed as far as so many cosines follow. The beam is that of addBeam().
OrdinateStack ordinateStack(const SlabProblem& problem, const StackCount& count);

/// The same as slabUnscattered() and slabSingle() see it, with whole phase functions, under the problem's beam.
SlabWalk straightWalk(const SlabProblem& problem, const OrdinateStack& stack);

/// Gives the layers of the stack their unscattered beam, which is returned.
SlabUnscattered addBeam(OrdinateStack& stack, const SlabWalk& walk);

/// The largest |g|, ratio of refractive indices, and albedo of an infinite layer that they follow.
inline constexpr double kOrdinateLargestG = 0.9, kOrdinateLargestRatio = 2, kOrdinateLargestAlbedo = 0.99999;

}  // namespace searchlight
