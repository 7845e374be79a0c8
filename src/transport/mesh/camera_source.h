// Walks that start where a camera looks: light traced backwards.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "transport/mesh/entry.h"

namespace searchlight {

/// The rays of a pinhole camera: through the point (x, y) in pixels along corner + x right + y down, not normalised.
struct CameraRays {
    int width = 1, height = 1;
    Vec3 eye;
    Vec3 corner, right, down;

    std::uint64_t pixels() const { return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height); }
};

/// Camera rays numbered from `first`, which go round the pixels, each through a random point of its own. Those that
/// meet the body enter it by refraction, with T12 as their weight, and are tagged with the pixel. Where they leave,
/// they collect what comes from there: of lights with an extent, unless the body hides them; of UniformLight 1.
template <class Body>
class CameraSource : public WalkSource {
public:
    /// `light` outlives its use and is no PencilLight.
    CameraSource(const Body& body, const CameraRays& rays, const Illumination& light, int channel, double eta,
                 std::uint64_t first, std::uint64_t count, SplitMix64 random);

    bool next(Entry& entry) override;
    void leave(std::uint32_t tag, float weight, Vec3 direction, const Crossing& crossing,
               std::vector<CellExit>& exits) override;

protected:
    /// What comes, over the weight of the walk, from where a walk that crosses the surface in this direction goes.
    double radianceBeyond(Vec3 direction, const Crossing& crossing, bool wide_only) const;

private:
    const Body& body_;
    const CameraRays& rays_;
    const Illumination& light_;
    int channel_;
    double eta_;
    std::uint64_t next_, end_;
    SplitMix64 random_;
};

}  // namespace searchlight
