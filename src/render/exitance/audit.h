// How wrong a sum turned out to be, found after it was taken: what spares the pilot while things move.
#pragma once

#include <array>
#include <vector>

#include "render/exitance/judge.h"
#include "render/exitance/pilot.h"

namespace searchlight {

/// Rules for a table by their parameters, which it takes half a millisecond to find.
class OpeningCache {
public:
    /// Stays until three others were asked for.
    const Opening& of(const PilotInput& input, Rgb opening);

private:
    struct Entry {
        std::uint64_t table = 0;
        double area = 0;
        Rgb parameter;
        Opening opening;
    };
    std::array<Entry, 4> entries_;
    std::size_t next_ = 0;
};

/// Keeps its memory from one sum to the next.
class Audit {
public:
    /// Draws leaves of receivers by the exitance that a sum found for them, and sums these with a rule that is
    /// reference_fineness times as fine as `opening`.
    void draw(const PilotInput& input, const DualTreeResult& sums, Rgb opening, OpeningCache& openings);

    /// What the sample says of a sum of the same receivers taken with `opening`, which is at least half of that at the
    /// last draw(); `bounds` by channel.
    SumCalibration judged(const PilotInput& input, const DualTreeResult& sums, Rgb opening, Rgb& bounds) const;

private:
    void drawLeaves(const PilotInput& input, const DualTreeResult& sums);

    std::vector<Visit> visits_;
    std::vector<std::uint32_t> leaves_;
    std::vector<double> shares_;
    std::vector<DrawnLeaf> sample_;
    Rgb peak_, reference_opening_;
    DualTreeResult reference_;
};

}  // namespace searchlight
