// The objects that the program makes itself, one file each. Closed, outward, with normals and uvs, longest side
// about 1.
#pragma once

#include "scene/mesh.h"

namespace searchlight {

/// A cube blown up to the unit-diameter sphere; each of its faces is a chart.
Mesh sphereObject(double resolution);

/// An upright plate, 1 x 1 x 0.2, flat but for its rounded edges; thin along z.
Mesh slabObject(double resolution);

/// A tube along the trefoil, one chart that is cut along and across the tube.
Mesh torusKnotObject(double resolution);

/// An abstract head with thin ears and a flat base.
Mesh statueObject(double resolution);

}  // namespace searchlight
