// The flux of points, gathered in the nodes of their tree.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/vec.h"
#include "render/heap_tree.h"

namespace searchlight {

/// Eight texels a node, for ten colours in a row: the sums over its points of flux, of flux times offset (x, y, z), and
/// of flux times products of offsets (xx, xy, xz, yy, yz, zz). Offsets are from the centre of the node's sphere, mm; a
/// tree does not move with the light. Colours 0 to 4 fill the first four texels but for one component, 5 to 9 the rest.
std::vector<std::array<float, 4>> pointMomentsGl(const HeapTree& tree, std::span<const Vec3f> positions,
                                                 std::span<const Rgb> flux, int threads);

}  // namespace searchlight
