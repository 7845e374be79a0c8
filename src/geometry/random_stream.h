// Random numbers of one point, whatever thread asks for them.
#pragma once

#include <cstdint>

namespace searchlight {

/// SplitMix64 [Steele2014], started from both numbers mixed.
class RandomStream {
public:
    RandomStream(std::uint64_t seed, std::uint64_t index) : state_(mix(seed + golden) ^ mix(~index)) {}

    std::uint64_t next() { return mix(state_ += golden); }

    /// (0, 1), 53 bits.
    double uniform() { return (static_cast<double>(next() >> 11) + 0.5) * 0x1p-53; }

private:
    static constexpr std::uint64_t golden = 0x9E3779B97F4A7C15u;
    static std::uint64_t mix(std::uint64_t z) {
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        return z ^ (z >> 31);
    }

    std::uint64_t state_;
};

}  // namespace searchlight
