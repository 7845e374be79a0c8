// Well spread points of the unit square, one after another.
#pragma once

#include <array>
#include <cstdint>

namespace searchlight {

/// The (0, 2)-sequence of Sobol, its digits scrambled by a seed: each 2^k points from a multiple of 2^k on hit every
/// elementary interval of area 2^-k once, and each point alone is uniform over the seeds [KolligKeller2002].
class StratifiedSequence {
public:
    explicit StratifiedSequence(std::uint64_t seed) : scramble_(mixed(seed)) {}

    /// Point `index` of the sequence, in [0, 1)^2.
    std::array<double, 2> operator()(std::uint32_t index) const {
        const auto unit = [](std::uint32_t bits) { return bits * 0x1p-32; };
        return {unit(radicalInverse(index) ^ static_cast<std::uint32_t>(scramble_)),
                unit(secondDimension(index) ^ static_cast<std::uint32_t>(scramble_ >> 32))};
    }

private:
    // The finaliser of [Steele2014]: neighbouring seeds share nothing.
    static std::uint64_t mixed(std::uint64_t z) {
        z += 0x9E3779B97F4A7C15u;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        return z ^ (z >> 31);
    }

    static std::uint32_t radicalInverse(std::uint32_t bits) {
        bits = (bits << 16) | (bits >> 16);
        bits = ((bits & 0x00ff00ffu) << 8) | ((bits & 0xff00ff00u) >> 8);
        bits = ((bits & 0x0f0f0f0fu) << 4) | ((bits & 0xf0f0f0f0u) >> 4);
        bits = ((bits & 0x33333333u) << 2) | ((bits & 0xccccccccu) >> 2);
        return ((bits & 0x55555555u) << 1) | ((bits & 0xaaaaaaaau) >> 1);
    }

    // Direction numbers of the polynomial x + 1.
    static std::uint32_t secondDimension(std::uint32_t index) {
        std::uint32_t result = 0;
        for (std::uint32_t direction = 1u << 31; index != 0; index >>= 1, direction ^= direction >> 1)
            if (index & 1) result ^= direction;
        return result;
    }

    std::uint64_t scramble_;
};

}  // namespace searchlight
