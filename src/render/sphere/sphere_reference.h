// The walks beside a SphereIntegral: all channels of a lit sphere, going on where they stopped.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "light/light_sampler.h"
#include "render/sphere/sphere_integral.h"
#include "transport/mesh/reference_body.h"

namespace searchlight {

class SphereReference {
public:
    /// `ball` and `lights` outlive this.
    SphereReference(const Ball& ball, const LightSampler& lights, const Medium& medium, std::uint64_t seed = 1,
                    int threads = 0);

    /// Goes on until each channel that scatters has about so many walks. Fewer than there are: nothing happens. When
    /// cancelled, throws interruptedError(); the walks so far stay counted. Throws what walkBody() throws.
    void walkTo(std::uint64_t walks, Observer& observer);

    /// Of the channel that has fewest: light paths that reached the surface.
    std::uint64_t walks() const;

    /// By channel; empty before the first walk, and for what does not scatter.
    const std::array<std::optional<BodyResult>, Rgb::channels>& channels() const { return channels_; }

    SphereExitance exitance() const;

private:
    const Ball& ball_;
    const LightSampler& lights_;
    Medium medium_;
    std::uint64_t seed_;
    int threads_;
    std::array<WalkState, Rgb::channels> states_;
    std::array<std::optional<BodyResult>, Rgb::channels> channels_;
};

}  // namespace searchlight
