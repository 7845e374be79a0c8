// The atlas of an object with its light, kept while neither changes.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/param.h"
#include "geometry/surface_walk.h"
#include "render/texture/texture_samples.h"

namespace searchlight {

class LitTexture {
public:
    /// By the options "atlas" and "uvs" of texture-space. Returns a number that is another when the light of some texel
    /// may have changed. The time of stages "atlas" and "light" goes into `stage_ms`. Throws what makeAtlas() throws.
    std::uint64_t refresh(const RenderInput& input, const ParamValues& options, std::map<std::string, double>& stage_ms,
                          Observer& observer);

    const Atlas& atlas() const { return atlas_; }
    const TexelMap& map() const { return map_; }
    const LitAtlas& lit() const { return *lit_; }

    /// Flux per mm^2 that crossed into the medium at a place of the mesh: linear between the middles of texels, of
    /// those that belong to its chart.
    Rgb lightAt(const SurfacePlace& place) const;

private:
    bool refreshAtlas(const RenderInput& input, const ParamValues& options, Observer& observer);

    Atlas atlas_;
    TexelMap map_;
    std::vector<std::uint32_t> first_cell_;  // per texel; one more at the end, along map_.texels in their own order
    std::vector<std::uint32_t> cells_;       // of the texels in turn
    std::string atlas_from_;
    std::uint64_t light_of_ = 0, version_ = 0;
    std::optional<LitAtlas> lit_;
};

}  // namespace searchlight
