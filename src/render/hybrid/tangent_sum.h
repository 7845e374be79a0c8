// The near part of R_d from samples of each receiver's tangent plane, whose light is the atlas'.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "geometry/surface_walk.h"
#include "render/direct/probes.h"
#include "render/technique.h"
#include "render/texture/lit_texture.h"

namespace searchlight {

/// [Chang2007, sec. 3.4] wished for it and walked over the stretched texture from triangle to triangle, which led
/// astray. Here a sample of the tangent plane becomes a line along the normal, or along one of two axes across
/// [King2013]; the surface that it meets is found by rays, and its place in the atlas is that of its triangle: stretch
/// has no say. Free of bias but for the texels of the light.
class TangentSum {
public:
    explicit TangentSum(std::shared_ptr<LitTexture> texture) : texture_(std::move(texture)) {}

    /// `profile`: what is summed. `samples` per receiver. The texture is refreshed before the first step. `input` and
    /// `profile` stay alive until the next start.
    void start(const RenderInput& input, const Profile& profile, int samples);

    /// Adds the light to the exitance of the next receivers. True when there are none left.
    bool step(std::span<Rgbf> exitance, Observer& observer);

    /// Stage "probes".
    void addTo(TechniqueReport& report) const;

private:
    void gather(std::size_t begin, std::size_t end, std::span<Rgbf> exitance, const Observer& observer,
                std::uint64_t& hits) const;

    std::shared_ptr<LitTexture> texture_;
    RenderInput input_;
    const Profile* profile_ = nullptr;
    std::optional<SurfaceWalk> walk_;
    std::optional<std::uint64_t> walk_of_;  // the object that it is of
    std::optional<Probes> probes_;
    int samples_ = 0;
    std::size_t next_ = 0;
    std::uint64_t hits_ = 0;
    double ms_ = 0;
};

}  // namespace searchlight
