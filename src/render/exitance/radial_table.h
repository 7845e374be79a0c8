// The inside of a RadialTable, and the distances at which it may be expanded.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/exitance/radial_kernel.h"
#include "render/exitance_sum.h"

namespace searchlight {

/// Of one bin of w = r^2 + c^2: per channel R_d at the bin's centre and its first three derivatives by w, so that a
/// cache line answers for all channels.
struct alignas(64) RadialEntry {
    static constexpr int stride = 4;  ///< floats per channel
    std::array<float, 16> value{};
};

struct RadialTable::Impl {
    /// The exponent and so many bits of the mantissa of w are the index.
    static constexpr int mantissa_bits = 5;
    static constexpr int shift = 23 - mantissa_bits;

    Impl(const Profile& profile, double cell_area_mm2);

    float offset;                      ///< c^2
    std::uint32_t base;                ///< bits of c^2 >> shift: what bin 0 has
    std::vector<RadialEntry> entries;  ///< the last one is 0 and stands for all that lies beyond
    std::vector<double> radii;         ///< of the bins' centres, mm
    std::vector<Rgb> values;           ///< |R_d| there
    /// Largest third derivative of R_d(|x|) in any direction of space, 1/mm^5: third[k][i] over bins i to i + 2^k - 1.
    std::vector<std::vector<Rgb>> third;
    Rgb total, mean_square_radius;
    std::uint64_t fingerprint;

    std::uint32_t bin(float w) const;

    /// Of the bins from that of r0 (0 where negative) to that of r1.
    double largestThird(double r0, double r1, int channel) const;
};

/// When a pair of nodes is done by expansions: when the sum of the radii times max(1, crowding x
/// PointTree::Impl::weight) is at most the distance that stands in the bin of their distance.
struct Opening {
    std::vector<float> distances;  ///< per bin, mm; empty: never
    float crowding = 0;            ///< 1/mm^(2/3)
};

/// Expansions of second order whose remainder is at most opening (R_d(r) / 10 + mean R_d) per unit flux in every
/// channel with an `opening` above 0. The mean is the total over S = min(area, pi <r^2>): what one unit of flux gives
/// its surroundings on average. A node with more flux than S holds under even light is allowed no more than that one.
Opening openingOf(const RadialTable::Impl& table, Rgb opening, double area_mm2, int threads = 0);

}  // namespace searchlight
