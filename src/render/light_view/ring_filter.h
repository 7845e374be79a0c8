// The filter of a translucent shadow map: rings of samples around each receiver in the view of a light.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/observer.h"
#include "base/vec.h"
#include "model/profile.h"
#include "render/exitance_sum.h"
#include "render/light_view/light_map.h"
#include "render/view.h"

namespace searchlight {

/// Samples of a view as vectors read them.
struct RingReceivers {
    RingReceivers() = default;
    explicit RingReceivers(const VisibleSurface& visible);

    std::size_t count = 0;
    std::array<std::vector<float>, 3> position, normal;  ///< mm; of the triangles. Padded to whole vectors
    std::vector<std::uint32_t> turn;                     ///< which of the blue noise's ranks turns its rings
};

/// L rings of C samples and one in the middle [Chang2007, Fig. 3.9]. They are laid out in the receiver's tangent plane,
/// or, every fourth, in the plane that faces the light, and projected onto what the light sees; both kinds are weighed
/// by the balance heuristic. With the surface's cosine, which Eqs 3.7 and 3.8 lack, and for parallel light without
/// their d^2: docs/hybrid.md.
class RingFilter {
public:
    /// At most `samples` of them, at least 1: rings are as many as spokes, or fewer. Radii follow the mean of the
    /// channels' |R_d| within `reach_mm`, and a quarter a broader distribution, for receivers in shadow, whose distance
    /// is depth. Channels without R_d are left out. Requires one that has some.
    RingFilter(const Profile& profile, int samples, double reach_mm, std::uint64_t seed);

    int rings() const { return rings_; }
    int spokes() const { return spokes_; }

    /// Adds the light of one map to the exitance of each receiver. Does not depend on `threads`. Throws
    /// interruptedError() when cancelled.
    void gather(const LightMap& map, const RingReceivers& receivers, int threads, const Observer& observer,
                std::span<Rgbf> exitance) const;

    struct Draws {
        std::vector<float> u, cosine, sine;  ///< per sample: the part of the distribution, and a unit vector
    };

    /// What the lanes read.
    struct Tables {
        RadialTable Rd, density;    ///< density: of samples, per mm^2, in every channel
        std::vector<float> annuli;  ///< equalAnnuli(density)
        Draws tangent, facing;
        std::vector<float> shift, angle;  ///< tiles of blue noise
    };

private:
    int rings_ = 0, spokes_ = 0;
    Tables tables_;
};

}  // namespace searchlight
