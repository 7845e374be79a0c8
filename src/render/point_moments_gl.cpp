#include "render/point_moments_gl.h"

#include "base/parallel.h"

namespace searchlight {

namespace {

struct Moments {
    std::array<Rgb, 10> m;

    // A point, or the moments of another node whose centre is at `s` from here.
    void add(const Moments& other, Vec3 s) {
        const std::array<double, 3> o{s.x, s.y, s.z};
        m[0] = m[0] + other.m[0];
        for (int i = 0; i < 3; ++i) m[1 + i] = m[1 + i] + other.m[1 + i] + o[i] * other.m[0];
        for (int i = 0, k = 4; i < 3; ++i)
            for (int j = i; j < 3; ++j, ++k)
                m[k] = m[k] + other.m[k] + o[i] * other.m[1 + j] + o[j] * other.m[1 + i] + (o[i] * o[j]) * other.m[0];
    }
};

void pack(const Moments& moments, std::span<std::array<float, 4>> texels) {
    for (std::size_t half = 0; half < 2; ++half)
        for (std::size_t i = 0; i < 5; ++i)
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t at = 16 * half + 3 * i + c;
                texels[at / 4][at % 4] = static_cast<float>(moments.m[5 * half + i][static_cast<int>(c)]);
            }
}

Vec3 centre(const HeapTree& tree, std::size_t node) {
    const auto& sphere = tree.spheres[node];
    return {sphere[0], sphere[1], sphere[2]};
}

}  // namespace

std::vector<std::array<float, 4>> pointMomentsGl(const HeapTree& tree, std::span<const Vec3f> positions,
                                                 std::span<const Rgb> flux, int threads) {
    std::vector<Moments> moments(tree.nodes());
    std::vector<std::array<float, 4>> texels(8 * tree.nodes());
    for (int level = tree.depth; level >= 0; --level) {
        parallelFor(std::size_t{1} << level, threads, [&](std::size_t k) {
            const std::size_t node = (std::size_t{1} << level) + k;
            if (level == tree.depth) {
                for (std::size_t i = tree.first(level, k); i < tree.first(level, k + 1); ++i) {
                    const std::uint32_t point = tree.order[i];
                    moments[node].add({{flux[point]}}, toDouble(positions[point]) - centre(tree, node));
                }
            } else {
                for (const std::size_t child : {2 * node, 2 * node + 1})
                    moments[node].add(moments[child], centre(tree, child) - centre(tree, node));
            }
            pack(moments[node], std::span(texels).subspan(8 * node, 8));
        });
    }
    return texels;
}

}  // namespace searchlight
