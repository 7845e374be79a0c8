// Texture coordinates for a mesh that has none.
#pragma once

#include "scene/mesh.h"

namespace searchlight {

/// Cuts the mesh into charts of triangles that face the same side of a box, projects each along its axis, all at one
/// scale, and packs them into the unit square. Vertices on the cuts are doubled. Areas shrink by the cosine to the
/// axis, rarely below a half; a chart that winds over itself overlaps. Other uvs are replaced.
Mesh boxCharts(const Mesh& mesh);

}  // namespace searchlight
