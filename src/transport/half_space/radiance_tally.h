// Whither walks leave a half-space: the exits within a sector about one point of the surface, by direction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace searchlight {

/// A sector of an annulus about the entry point, and the cells of the hemisphere outside: equal steps of the polar
/// angle times equal steps of the azimuth, which is counted from +x, the side that the refracted beam leans to.
struct RadianceLayout {
    double r0 = 0, r1 = 1;              ///< the walk's unit of length
    double azimuth = 0;                 ///< of the sector's middle, radians
    double half_width = 0;              ///< of the sector, radians, up to pi
    double eta = 1;                     ///< inside over outside
    std::size_t polar = 9, turns = 24;  ///< cells

    /// [sector, cells: polar * turns + turn...]
    std::size_t slots() const { return 1 + polar * turns; }
};

/// The exits of one chunk. The plane of incidence is a mirror: an exit counts half where it is, half where its mirror
/// image is, which halves the variance at no cost.
class RadianceTally {
public:
    explicit RadianceTally(const RadianceLayout& layout) : layout_(&layout), flux_(layout.slots(), 0.0) {}

    /// Exits at (x, y) with the direction inside (u, v, .) after so many collisions; spans of one length.
    void add(std::span<const float> x, std::span<const float> y, std::span<const float> u, std::span<const float> v,
             std::span<const std::int32_t> collisions);

    const std::vector<double>& flux() const { return flux_; }

    /// All sums as one list, and back.
    std::vector<double> pack() const { return flux_; }
    void unpack(std::span<const double> values) { flux_.assign(values.begin(), values.end()); }

private:
    const RadianceLayout* layout_;
    std::vector<double> flux_;  ///< weight per slot
};

}  // namespace searchlight
