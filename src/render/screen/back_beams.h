// Where light from behind comes from, and what of it comes through: what rays and shadow maps share.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/vec.h"
#include "geometry/object.h"
#include "light/light_filter.h"
#include "light/transmitted_cosine.h"
#include "model/profile.h"
#include "render/screen/back_light.h"

namespace searchlight {

/// Parallel light, or light from a point.
struct BackBeam {
    Vec3 place;  ///< towards the light, unit; of a point: where it is, mm
    bool from_point = false;
    Rgb irradiance;      ///< on a surface that faces it; of a point: at unit_mm
    double unit_mm = 1;  ///< of a point
    std::shared_ptr<const LightFilter> filter;
};

/// The scene's lights: of an environment and of a light's disc as many as options.beam_count. Throws what opening the
/// scene's pictures throws.
std::vector<BackBeam> backBeams(const Scene& scene, const Object& object, const BackLightOptions& options);

/// Where a line from a visible point to a light leaves the object.
struct WayOut {
    Vec3 from, wi;      ///< start of the line, mm, and the unit vector to the light
    double out = 0;     ///< distance from there to the way out, mm
    double way = 0;     ///< of that what counts as material, mm
    double behind = 0;  ///< distance from the way out to the light, of a point
    std::uint32_t triangle = 0;
};

/// What comes in at the ends of lines, times what of it comes through.
class LightThrough {
public:
    /// All of it outlives this. `spacing_mm`: between neighbours in the picture, by which light through a slide is
    /// smoothed.
    LightThrough(const Object& object, const Profile& profile, double eta, double spacing_mm);

    /// Exitance at the line's start.
    Rgb operator()(const BackBeam& beam, const WayOut& line) const;

private:
    const Object& object_;
    const Profile& profile_;
    TransmittedCosine transmitted_cosine_;
    Rgb total_;
    double spacing_mm_;
};

}  // namespace searchlight
