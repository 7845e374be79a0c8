// Where the visible surface turns away or ends.
#pragma once

#include "render/screen/tangent_samples.h"

namespace searchlight {

/// Takes the patches of pixels away that have a neighbour without one, or one that lies off their plane by more than
/// the plane rises within a pixel. There a plane is no measure of the surface: of the area that a sphere shows in the
/// last pixel before its contour a plane through the pixel's middle has 1 / sqrt(2), in the next ones 99 % and more.
/// What is taken away is not seen by isSeen(). The border of the picture is no contour.
void takeContours(ScreenPatches& patches);

}  // namespace searchlight
