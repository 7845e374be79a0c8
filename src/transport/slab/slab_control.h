// What tells how lucky analogue walks through plane layers were: numbers that are 0 on average and follow R, T and A.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "transport/slab/slab_single.h"
#include "transport/slab/slab_walk.h"

namespace searchlight {

/// In a layer with albedo c, light that dies out as exp(-kappa z) under the angular distribution psi(w) is an exact
/// solution, and so is its mirror image: what it says that a walk is worth does not change on average from flight to
/// flight, so that (optional stopping) all that a walk gains where it enters the layer it loses, on average, where it
/// leaves or is reflected. Each layer has two such controls,
///   sinh(kappa (D - z)) and sinh(kappa z) over sinh(kappa D), with psi's even part, and cosh with its odd part,
/// of which events at its two surfaces alone count. R, T and A are nearly sums of them.
struct SlabControl {
    /// Of the layers that scatter, at most kMostLayers; those that absorb so strongly that psi has a peak do without.
    explicit SlabControl(const SlabWalk& walk);

    static constexpr std::size_t kMostLayers = 8;

    struct Layer {
        std::int32_t index = 0;
        double kappa = 0;  ///< per mean free path
        /// Of q(w) = (1 + kappa w) psi(w), the mean of psi after a collision: the even part in powers of w^2, and the
        /// odd part over -kappa w. Both have as many terms.
        std::vector<double> even, odd;
        double near = 0, far = 0;              ///< kappa over tanh and over sinh of kappa D
        double entry_near = 0, entry_far = 0;  ///< what a new walk gains
    };
    std::vector<Layer> layers;
    SlabUnscattered unscattered;  ///< known, and so a control, too

    /// Sums over walks, for each layer at the top, then the bottom: psi's even part for walks that enter less that for
    /// those that leave; and its odd part over -kappa, for each that enters or leaves, twice where it is reflected.
    static constexpr std::size_t kSums = 4;

    std::size_t size() const { return 2 * layers.size() + 2; }
    /// The controls of `walks` walks from kSums sums for each layer, and how many left unscattered above and below:
    /// size() numbers, each 0 on average; those of thin layers are no larger than those of others.
    std::vector<double> controls(std::span<const double> sums, double R_unscattered, double T_unscattered,
                                 double walks) const;
};

}  // namespace searchlight
