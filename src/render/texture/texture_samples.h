// Samples of the light on a surface, drawn in its atlas: what all receivers share.
#pragma once

#include "geometry/atlas/texel_map.h"
#include "light/irradiance.h"
#include "light/lit_points.h"
#include "render/technique.h"
#include "render/texture/texture_gl.h"

namespace searchlight {

struct TextureSampleOptions {
    std::size_t count = 1600;
    bool own_light = false;  ///< light at each sample, not that of its texel's middle
    bool beams = false;      ///< also as beams
    std::uint64_t seed = 1;
};

/// Points with the areas that they stand for (1 / (count times their density on the surface), so that a sum over them
/// is the integral over the surface in the mean over seeds), and the light there.
struct TextureSamples {
    PointCloud points;
    Irradiance irradiance;
    double lit_area_mm2 = 0;  ///< (integral of E)^2 / integral of E^2: the area on which the light falls
    bool dark = false;        ///< no light at all: there are no points
};

/// Irradiance per cell of a TexelMap and its distribution; kept while neither surface nor light change.
class LitAtlas {
public:
    /// `map` and what `input` points to stay alive.
    LitAtlas(const Atlas& atlas, const TexelMap& map, const RenderInput& input, Observer& observer);

    /// Takes the light anew.
    void light(const RenderInput& input, Observer& observer);

    /// Cells are chosen in proportion to area times transmitted light, the mean of the channels. Where the light is
    /// read at the samples one in ten is chosen by area alone, so that nothing lit is missed that is dark at the middle
    /// of its texel.
    /// `device`: chooses them; null: the CPU does.
    TextureSamples draw(const RenderInput& input, const TextureSampleOptions& options, TextureGl* device,
                        Observer& observer) const;

    std::span<const Rgbf> transmitted() const { return transmitted_; }  ///< per cell

private:
    const Atlas& atlas_;
    const TexelMap& map_;
    LitPoints places_;
    std::vector<Rgbf> transmitted_;
    double area_mm2_ = 0, power_ = 0, lit_area_mm2_ = 0;  // power: sum of area times light, mean of the channels
};

}  // namespace searchlight
