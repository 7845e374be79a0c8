// Walks from a camera that ask the beams of facets at some of their collisions, where they would rarely or never meet
// the light.
#pragma once

#include <vector>

#include "transport/mesh/body_walk.h"
#include "transport/mesh/camera_source.h"
#include "transport/mesh/facet_beams.h"

namespace searchlight {

/// One of so many collisions of each walk is asked, for all: light that comes straight from a beam of at most
/// FacetBeams::discReach_mm() to a collision is found there alone. All else of lights with an extent is met by walks
/// that leave. Tags of walks are numbers in this source's list.
class BeamSource : public CameraSource<MeshBody> {
public:
    /// Walks and light as CameraSource has them; `beams` and `random` are for what one of `one_of` collisions asks.
    BeamSource(CameraSource<MeshBody> walks, const FacetBeams& beams, int one_of, SplitMix64 random);

    bool next(Entry& entry) override;
    void leave(std::uint32_t tag, float weight, Vec3 direction, const Crossing& crossing,
               std::vector<CellExit>& exits) override;
    int asksOneOf() const override { return one_of_; }
    void collide(std::uint32_t tag, float weight, Vec3f position, Vec3f direction) override;
    void leaveScattered(std::uint32_t tag, float weight, Vec3f start, Vec3 direction, const Crossing& crossing,
                        std::vector<CellExit>& exits) override;

    /// What each walk has collected, as one exit per walk, and the rays that it took.
    void finish(BodyChunk& chunk) const;

private:
    const FacetBeams& beams_;
    int one_of_;
    SplitMix64 random_;
    std::vector<CellExit> walks_;  // pixel, and the sum of what was collected
    std::uint64_t rays_ = 0;
};

/// Walks the source's walks through refractive facets to their ends.
BodyChunk walkBeamsChunk(const MeshBody& mesh, const BodyMedium& medium, const FacetBeams& beams,
                         CameraSource<MeshBody>& source, SplitMix64 random);

}  // namespace searchlight
