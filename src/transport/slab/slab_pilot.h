// What a few analogue walks tell before the others start: how slots follow the controls, and how much they vary.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "transport/slab/slab_control.h"
#include "transport/slab/slab_depths.h"
#include "transport/slab/slab_tally.h"

namespace searchlight {

/// Its walks have random numbers of their own, the same for every seed: what it corrects stays unbiased.
struct SlabPilot {
    /// tallied: the layout of the walks to come; here it is without its annuli and maps.
    SlabPilot(const SlabWalk& walk, const SlabControl& control, const SlabDepths& depths, const SlabLayout& tallied);

    SlabLayout layout;
    std::vector<std::vector<double>> slopes;  ///< per slot, by each control; empty where it follows none
    std::vector<double> mean, variance;       ///< per slot and walk; of what is corrected
    std::vector<double> analogue_variance;    ///< without that
    /// Of R, T and A, per walk; of what is corrected.
    std::array<std::array<double, 3>, 3> covariance{};
    std::array<bool, 3> often{};      ///< whether R, T and A were met often enough to learn from
    double steps = 0, crossings = 0;  ///< collisions and meetings with interfaces, per walk

    /// Takes from slots of `flux`, which `walks` walks with the layout `of` and these sums found, what their controls
    /// say.
    void correct(const SlabControl& control, std::span<const double> sums, double walks, const SlabLayout& of,
                 std::span<double> flux) const;
    /// Adds to `flux` of `walks` walks, corrected, that of others which tell no controls, each by what it knows.
    void join(const SlabControl& control, double walks, std::vector<double> others, double other_walks,
              const SlabLayout& of, std::span<double> flux) const;
    /// A flux with the pilot's layout, in that of walks to come.
    std::vector<double> spread(std::span<const double> flux, const SlabLayout& to) const;
};

}  // namespace searchlight
