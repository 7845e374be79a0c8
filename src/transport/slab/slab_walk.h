// One chunk of walks through plane layers, in the widest instruction set of this machine.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "transport/slab/slab_entry.h"
#include "transport/slab/slab_tally.h"
#include "transport/walk/beam.h"
#include "transport/walk/phase_function.h"

namespace searchlight {

struct SlabControl;
struct SlabDepths;

/// What a walk knows of its slab. Lengths are in mm.
struct SlabWalk {
    struct Layer {
        double mfp_mm = 1;              ///< 1 / sigma_t; a huge number where nothing happens
        double absorbed = 0;            ///< 1 - albedo
        double counted = 0;             ///< part of the collisions that the tally counts, at least `absorbed`
        double g = 0;                   ///< of Henyey-Greenstein, unless there is a table
        double thickness_mm = 1;        ///< infinity: the last layer has no lower surface
        double eta_up = 1;              ///< refractive index of this layer over that above
        double eta_down = 1;            ///< over that below
        PhaseTables::Range phase = {};  ///< in `tables`, in place of g
    };
    std::vector<Layer> layers;
    PhaseTables tables;
    EntryShift entry;  ///< through the clear layers above `first`
    std::int32_t first = 0;
    double sin_beam = 0, cos_beam = 1;  ///< in that layer; leans towards +x
    BeamShape shape = {};
    double cos_incidence = 1;  ///< outside
};

/// Starts `walks` walks of the stream (seed, chunk), finishes them all and adds every end to the tally. Returns the
/// number of collisions.
std::uint64_t walkSlabChunk(const SlabWalk& walk, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                            SlabTally& tally);

/// walkSlabChunk, and the control's sums of its walks; the tally is the same.
std::uint64_t walkSlabChunk(const SlabWalk& walk, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                            SlabTally& tally, const SlabControl& control, std::span<double> sums);

/// The same without places on the surfaces, in less time: walks that know their depth alone, all of whose collisions
/// count. The tally's layout has one annulus. crossings: null, or to this is added how often walks met an interface.
std::uint64_t walkSlabDepthsChunk(const SlabWalk& walk, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                                  SlabTally& tally, const SlabControl& control, std::span<double> sums,
                                  const SlabDepths& depths, std::uint64_t* crossings = nullptr);

/// The instruction set that walkSlabChunk uses: "AVX3", "AVX2", "SSE4"...
const char* slabInstructionSet();

}  // namespace searchlight
