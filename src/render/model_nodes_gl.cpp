#include "render/model_nodes_gl.h"

#include <algorithm>

#include "base/parallel.h"

namespace searchlight {

std::vector<std::array<float, 4>> modelNodesGl(std::span<const ModelNode> nodes, int threads) {
    std::vector<std::array<float, 4>> texels(8 * nodes.size());
    constexpr std::size_t grain = 1024;
    parallelFor((nodes.size() + grain - 1) / grain, threads, [&](std::size_t task) {
        for (std::size_t i = task * grain; i < std::min(nodes.size(), (task + 1) * grain); ++i) {
            const ModelNode& node = nodes[i];
            const Vec3f flux{node.flux.r, node.flux.g, node.flux.b};
            const std::array<Vec3f, 10> vectors{node.position,
                                                node.offsets[0],
                                                node.offsets[1],
                                                node.normal,
                                                flux,
                                                node.normal_offsets[0],
                                                node.normal_offsets[1],
                                                node.wi,
                                                node.wi_offsets[0],
                                                node.wi_offsets[1]};
            for (std::size_t k = 0; k < vectors.size(); ++k) {
                const std::array<float, 3> v{vectors[k].x, vectors[k].y, vectors[k].z};
                for (std::size_t c = 0; c < 3; ++c) {
                    const std::size_t at = 16 * (k / 5) + 3 * (k % 5) + c;
                    texels[8 * i + at / 4][at % 4] = v[c];
                }
            }
        }
    });
    return texels;
}

}  // namespace searchlight
