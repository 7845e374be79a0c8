// Light that shines through, on OpenGL: layers of shadow maps in place of rays.
#pragma once

#include <memory>
#include <vector>

#include "render/screen/back_light.h"

namespace searchlight {

namespace gl {
class Context;
}

/// backLight() of an object by all walls that a light sees behind each other, layer by layer: each keeps what lies
/// behind the one before, as in order-independent transparency by depth peeling [Everitt2001]. So a line from a visible
/// point knows every wall between it and the light, where one shadow map knows the first [Freude2014, Fig. 6.27].
class BackLightGl {
public:
    /// The context outlives it.
    explicit BackLightGl(gl::Context& context);
    ~BackLightGl();

    /// The same within what a texel of the map covers: at outlines, as the light sees them, a line may cross the walls
    /// of its neighbour. Lengths are measured to the walls' planes, not by the map's depth. Throws what backLight()
    /// throws, and a device Error.
    std::vector<Rgbf> operator()(const VisibleSurface& visible, const Scene& scene, const Object& object,
                                 const Profile& profile, const BackLightOptions& options, Observer& observer);

private:
    struct Device;
    gl::Context& context_;
    std::unique_ptr<Device> device_;  // made when something shines through
};

}  // namespace searchlight
