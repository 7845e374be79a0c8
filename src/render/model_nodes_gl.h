// Nodes of a model's points as a shader reads them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "render/model_nodes.h"

namespace searchlight {

/// Eight texels a node, for the ten vectors of a ModelNode in a row: five in the first four, but for one component, and
/// five in the rest. The flux is texel 3.
std::vector<std::array<float, 4>> modelNodesGl(std::span<const ModelNode> nodes, int threads);

}  // namespace searchlight
