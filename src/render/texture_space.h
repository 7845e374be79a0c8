// Texture space importance sampling [Chang2007]: samples of the light are drawn in a texture of the surface and shared
// by all receivers. docs/texture-space.md says what is promised.
#pragma once

#include <memory>
#include <vector>

#include "render/technique.h"

namespace searchlight {

class LitTexture;

/// "samples", "atlas", "uvs", "footprint", "own_light", "sum".
std::vector<Param> textureSpaceOptions();

/// On the CPU, or where a context is given the cells are chosen and the samples summed there.
std::unique_ptr<Technique> makeTextureSpace(gl::Context* context);

/// The same on a texture that others read too; each start() brings it up to date.
std::unique_ptr<Technique> makeTextureSpace(gl::Context* context, std::shared_ptr<LitTexture> texture);

}  // namespace searchlight
