// Which cells of an atlas samples go to: the inverse of the cumulative distribution, by prefix sums.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace searchlight {

/// Numbers in [0, 1) that a sample is made of: `along` chooses the cell, `across` and `around` the place in it.
struct SampleNumbers {
    double along = 0, across = 0, around = 0;
};

/// Sample k of n. `along` is evenly spread ((k + shift) / n, so every n-th part of the light gets one sample), the
/// other two are the additive recurrence of [Roberts2018]; the three shifts are random from the seed, so that each
/// sample by itself is uniform and sums over them are unbiased over the seeds.
SampleNumbers sampleNumbers(std::size_t k, std::size_t n, std::uint64_t seed);

struct CellChoice {
    std::uint32_t cell = 0;
    double inside = 0;       ///< what is left of SampleNumbers::along, uniform in [0, 1)
    double probability = 0;  ///< of the cell, per sample
};

/// Running sums over cells in their order along the Z curve: what the mip chain of a texture holds level by level.
class CellChooser {
public:
    /// Weights from 0 on, not all 0.
    explicit CellChooser(std::span<const double> weights);

    /// The cell in whose part of [0, 1) `along` lies; never one with weight 0.
    CellChoice choose(double along) const;
    std::vector<CellChoice> choose(std::span<const double> along) const;

    double total() const { return until_.back(); }

private:
    std::vector<double> until_;
};

}  // namespace searchlight
