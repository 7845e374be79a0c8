// Pictures of the light that arrives, in place of the light that leaves: what a person looks at to judge it.
#pragma once

#include "base/image.h"
#include "render/renderer.h"

namespace searchlight {

/// Transmitted irradiance over pi at the point of irradiance nearest to each sample: what a white diffuse surface would
/// show of it. Black where no point is near; transparent beside the object. Requires stages of a start().
Image irradiancePicture(const RenderStages& stages);

/// The points of irradiance as dots in that light, on a dark surface.
Image pointsPicture(const RenderStages& stages);

}  // namespace searchlight
