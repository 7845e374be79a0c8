// Light that shines through: what entered where the camera does not look, and leaves at what it sees.
#pragma once

#include <cstdint>
#include <vector>

#include "base/observer.h"
#include "base/param.h"
#include "geometry/object.h"
#include "geometry/rays.h"
#include "model/profile.h"
#include "render/view.h"
#include "scene/scene.h"

namespace searchlight {

/// How far it is from a visible point to where the light came in, along the line to the light.
enum class Thickness : std::uint8_t {
    nothing,    ///< nothing shines through
    outermost,  ///< to the surface that the light sees first, gaps included: what a shadow map says [Freude2014,
                ///< Fig. 6.27]
    material,   ///< to that surface, without the gaps: rays count what they leave and enter
    nearest,    ///< to where the line leaves the object for the first time; that place may lie in shadow
};

/// The option of techniques that chooses one, and what it says.
Param thicknessOption();
Thickness thicknessOf(const ParamValues& options);

struct BackLightOptions {
    Thickness thickness = Thickness::nearest;
    double eta = 1.3;
    int beam_count = 16;  ///< directions that an environment becomes, and samples of a light's disc
    std::uint64_t seed = 1;
    int threads = 0;
};

/// Exitance per sample of `visible` by light that comes out where its source is not seen: per light
///
///     T(s) T12 E,    T(s) = integral of R_d((r^2 + s^2)^1/2) 2 pi r dr = total - encircled(s),
///
/// s being the way to where it came in: exact behind a slab under even light that falls straight onto it, R_d being a
/// function of the distance as other techniques take it. Under slanting light the nearest way through is shorter than
/// s, and a plane there gives more than the object, whose back is bent: of lengths between the two s was nearest to the
/// sum over points (docs/separable.md). Of environments every direction is shadowed by the object. Throws
/// interruptedError() when cancelled, and what opening the scene's pictures throws.
std::vector<Rgbf> backLight(const VisibleSurface& visible, const Scene& scene, const Object& object,
                            const RayScene& rays, const Profile& profile, const BackLightOptions& options,
                            Observer& observer);

}  // namespace searchlight
