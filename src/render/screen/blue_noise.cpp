#include "render/screen/blue_noise.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "base/random.h"

namespace searchlight {

namespace {

constexpr int side = blue_noise_side;
constexpr std::size_t cells = static_cast<std::size_t>(side) * side;

// How crowded each cell is: a Gaussian of 1.5 cells around each one that is set [Ulichney1993], around the torus.
class Crowd {
public:
    Crowd() : bell_(cells), density_(cells), set_(cells) {
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const int dx = std::min(x, side - x), dy = std::min(y, side - y);
                bell_[at(x, y)] = std::exp(-(dx * dx + dy * dy) / (2 * 1.5 * 1.5));
            }
    }

    bool isSet(std::size_t cell) const { return set_[cell]; }

    void change(std::size_t cell, bool set) {
        set_[cell] = set;
        const double sign = set ? 1 : -1;
        const int cx = static_cast<int>(cell % side), cy = static_cast<int>(cell / side);
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                density_[at(x, y)] += sign * bell_[at((x - cx + side) % side, (y - cy + side) % side)];
    }

    /// The most crowded cell that is set, or the emptiest that is not.
    std::size_t extreme(bool set) const {
        std::size_t best = cells;
        for (std::size_t i = 0; i < cells; ++i)
            if (set_[i] == set &&
                (best == cells || (set ? density_[i] > density_[best] : density_[i] < density_[best])))
                best = i;
        return best;
    }

private:
    static std::size_t at(int x, int y) { return static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x); }

    std::vector<double> bell_, density_;
    std::vector<bool> set_;
};

}  // namespace

std::vector<float> blueNoise(std::uint64_t seed) {
    // A tenth of the cells at random, moved from clusters into voids until that changes nothing.
    constexpr std::size_t few = cells / 10;
    Crowd crowd;
    SplitMix64 random = streamOf(seed, 0);
    for (std::size_t placed = 0; placed < few;) {
        const std::size_t cell = random.next() % cells;
        if (crowd.isSet(cell)) continue;
        crowd.change(cell, true);
        ++placed;
    }
    for (std::size_t moves = 0; moves < cells; ++moves) {
        const std::size_t from = crowd.extreme(true);
        crowd.change(from, false);
        const std::size_t to = crowd.extreme(false);
        crowd.change(to, true);
        if (from == to) break;
    }
    // The most crowded of these have the highest ranks among them; all others follow, each into the largest void.
    std::vector<float> rank(cells);
    const auto value = [](std::size_t k) {
        return static_cast<float>((static_cast<double>(k) + 0.5) / static_cast<double>(cells));
    };
    Crowd thinned = crowd;
    for (std::size_t k = few; k-- > 0;) {
        const std::size_t cell = thinned.extreme(true);
        thinned.change(cell, false);
        rank[cell] = value(k);
    }
    for (std::size_t k = few; k < cells; ++k) {
        const std::size_t cell = crowd.extreme(false);
        crowd.change(cell, true);
        rank[cell] = value(k);
    }
    return rank;
}

}  // namespace searchlight
