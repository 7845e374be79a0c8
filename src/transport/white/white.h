// White Monte Carlo: walks traced once without absorption answer for every sigma_a and sigma_s of a half-space.
//
// The geometry of an unabsorbed walk, in mean free paths, can be read in two ways, and both are unbiased:
//   path:        one mean free path is 1 / sigma_s; a path of length L weighs exp(-sigma_a L);
//   collisions:  one mean free path is 1 / sigma_t; n collisions weigh albedo^n.
// Far out at low albedo the second is the better one by orders of magnitude. For each bin the one is taken that a
// pilot, walks of its own, saw more exits in.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/observer.h"
#include "transport/half_space/half_space.h"

namespace searchlight {

/// What a table depends on, and nothing else.
struct WhiteKey {
    double g = 0;
    double eta = 1;        ///< inside over outside
    double angle_deg = 0;  ///< of incidence
    std::uint64_t walks = 1'000'000;
    std::uint64_t seed = 1;

    bool operator==(const WhiteKey&) const = default;
};

/// Tables answer up to this albedo, not reduced: walks meet a roulette that an albedo nearer to 1 would feel.
inline constexpr double kWhiteLargestAlbedo = 0.9999;

enum class WhiteView { path, collisions };
inline constexpr std::size_t kWhiteViews = 2;

/// Bins of radius and of path, in mean free paths. Logarithmic: a bin is a fixed fraction of an octave.
struct WhiteAxes {
    int radii_per_octave = 0;
    int columns_per_octave = 0;  ///< of length or of collisions; the first 2 * columns_per_octave collisions are exact
    int octaves = 0;             ///< of radius, from 2^-14

    /// 0: nearer than the first edge; radialSlots() - 1: beyond the last.
    std::size_t radialSlot(double r) const;
    std::size_t radialSlots() const { return static_cast<std::size_t>(radii_per_octave * octaves) + 2; }
    double largestRadius() const;
    std::size_t column(WhiteView view, double amount) const;
    std::size_t columns(WhiteView view) const;
    double centre(WhiteView view, std::size_t column) const;
};

/// Exits by radius and column: sums of W, W d and W d^2, where W undoes the roulette and d = amount / centre - 1.
/// Rows are stored from their first to their last column with exits.
struct WhiteHistogram {
    struct Row {
        std::uint32_t first = 0, count = 0;
    };
    std::vector<Row> rows;
    std::array<std::vector<float>, 3> moments;
};

/// Exits by collisions alone: of W q, W q d, W q d^2 for q = 1, x, x^2, r^2, r^4, in mean free paths.
using WhiteShift = std::array<std::array<double, 3>, 5>;

/// One set of walks at one resolution. Orders: 0 single, 1 multiple scattering.
struct WhiteTier {
    WhiteAxes axes;
    std::uint64_t walks = 0;
    std::array<std::array<WhiteHistogram, 2>, kWhiteViews> exits;  ///< [view][order]
};

struct WhiteTable {
    WhiteKey key;
    WhiteTier fine, pilot;
    std::array<std::vector<WhiteShift>, 2> shift;  ///< [order][column of collisions]
    std::uint64_t collisions = 0;
    double build_seconds = 0;  ///< wall time of walking

    std::size_t bytes() const;
};

/// The empty table of a key: its axes follow from g.
WhiteTable emptyWhiteTable(const WhiteKey& key);

/// Walks. The result does not depend on threads (0: all). Throws an input Error for a key that makes no sense,
/// interruptedError() when the observer cancels.
WhiteTable buildWhiteTable(const WhiteKey& key, int threads, Observer& observer);

/// The tallies that walkHalfSpace would estimate, without its grid; no walk is made. Each number has the standard error
/// of this medium; numbers of different media from one table are correlated. edges_mm as in HalfSpaceOptions. Throws an
/// input Error when the albedo is above kWhiteLargestAlbedo or an edge lies beyond the table.
HalfSpaceResult evaluateWhite(const WhiteTable& table, double sigma_a, double sigma_s,
                              std::span<const double> edges_mm);

}  // namespace searchlight
