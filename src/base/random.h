// Seeding of independent streams.
#pragma once

#include <cstdint>

namespace searchlight {

/// [Steele2014]: any seed, also 0, gives a good sequence. For seeding and for rare draws.
class SplitMix64 {
public:
    explicit SplitMix64(std::uint64_t seed = 0) : state_(seed) {}

    std::uint64_t next() {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        return z ^ (z >> 31);
    }

    /// (0, 1), 53 bits.
    double uniform() { return (static_cast<double>(next() >> 11) + 0.5) * 0x1p-53; }

private:
    std::uint64_t state_;
};

/// The stream of one chunk of a job: both numbers are mixed, so that neighbours share nothing.
inline SplitMix64 streamOf(std::uint64_t seed, std::uint64_t chunk) {
    return SplitMix64(SplitMix64(seed).next() ^ SplitMix64(~chunk).next());
}

}  // namespace searchlight
