// How a beam gets through the clear layers on top of a slab.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/random.h"

namespace searchlight {

struct SlabProblem;

/// How far an oblique beam moves along x on its way, of light that enters: what does not is the specular part.
class EntryShift {
public:
    struct Surface {
        double reflectance = 0;
        double shift_mm = 0;  ///< across the clear layer below it, each time
    };

    /// A beam that moves nowhere.
    EntryShift() = default;
    /// `surfaces` from the top to where the beam enters; some of it does.
    explicit EntryShift(std::span<const Surface> surfaces);

    bool moves() const { return surfaces_.size() > 1; }
    /// Drawn reflection by reflection.
    double draw(SplitMix64& random) const;

private:
    struct Conditioned {
        double passes = 1;   ///< probability for light from above, given that it enters in the end
        double returns = 1;  ///< that light from below is reflected, given the same
        double shift_mm = 0;
    };
    std::vector<Conditioned> surfaces_;
};

/// The beam down to its first layer that is not clear (to below the slab when all are).
struct SlabEntry {
    double specular = 0;  ///< exactly 1 under total reflection
    EntryShift shift;
    std::size_t first = 0;
    double sine = 0;  ///< in that layer
};

SlabEntry slabEntry(const SlabProblem& problem);

}  // namespace searchlight
