// Single scattering for models that have none: walked through the body, as a reference walks it.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "light/light_sampler.h"
#include "render/technique.h"
#include "transport/mesh/closed_body.h"

namespace searchlight {

/// What leaves after one scattering event, on the cells of a closed body around a picture's receivers: unbiased for the
/// means over cells of about four pixels, geometric normals, refracted entry, reflections from inside.
class WalkedSingle {
public:
    /// Throws an input Error for a mesh that encloses nothing.
    explicit WalkedSingle(const RenderInput& input);

    /// Adds an independent estimate by about so many walks per channel to each receiver's exitance. Throws
    /// interruptedError().
    void addTo(std::span<Rgb> exitance, std::uint64_t walks, std::uint64_t seed, Observer& observer) const;

private:
    Medium medium_;
    int threads_;
    LightSampler lights_;
    MeshBody body_;
    std::vector<std::uint32_t> cells_;  ///< of the receivers
    bool lit_[Rgb::channels];           ///< whether there is light of a channel
};

}  // namespace searchlight
