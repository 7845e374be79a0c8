#include "render/exitance/point_tree.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "render/exitance/box.h"

namespace searchlight {

namespace {

using Impl = PointTree::Impl;

// Points of a task: a few microseconds of work, so that threads are worth their start.
constexpr std::size_t grain = 4096;

// Flux and moments of one channel about a centre.
struct Moments {
    float flux, x, y, z, xx, xy, xz, yy, yz, zz;

    void addPoint(float f, float px, float py, float pz) {
        const float fx = f * px, fy = f * py, fz = f * pz;
        flux += f;
        x += fx, y += fy, z += fz;
        xx += fx * px, xy += fx * py, xz += fx * pz;
        yy += fy * py, yz += fy * pz, zz += fz * pz;
    }

    // Those of a child whose centre is at (dx, dy, dz) from ours.
    void addShifted(const Moments& m, float dx, float dy, float dz) {
        flux += m.flux;
        x += m.x + dx * m.flux;
        y += m.y + dy * m.flux;
        z += m.z + dz * m.flux;
        xx += m.xx + dx * (2 * m.x + dx * m.flux);
        yy += m.yy + dy * (2 * m.y + dy * m.flux);
        zz += m.zz + dz * (2 * m.z + dz * m.flux);
        xy += m.xy + dx * m.y + dy * (m.x + dx * m.flux);
        xz += m.xz + dx * m.z + dz * (m.x + dx * m.flux);
        yz += m.yz + dy * m.z + dz * (m.y + dy * m.flux);
    }
};
static_assert(sizeof(Moments) == Impl::moments_per_channel * sizeof(float));

struct NodeMoments {
    Moments channel[3];
    float padding[2];
};
static_assert(sizeof(NodeMoments) == Impl::moments_per_node * sizeof(float));

// A node's sphere and moments. Where part of it is dark the sphere is that of the lit part: a single lit point becomes
// a node without extent, which is exact at any distance.
void gatherLeaf(Impl& tree, std::size_t node, NodeMoments& sum) {
    const std::size_t first = tree.first[node], end = first + tree.count[node];
    Box lit;
    std::size_t dark = 0;
    for (std::size_t i = first; i < end; ++i) {
        if (tree.flux[0][i] != 0 || tree.flux[1][i] != 0 || tree.flux[2][i] != 0)
            lit.add(Vec3f{tree.x[i], tree.y[i], tree.z[i]});
        else
            ++dark;
    }
    float* sphere = &tree.spheres[4 * node];
    sum = {};
    if (dark == end - first) {
        sphere[3] = Impl::dark;
        return;
    }
    std::copy_n(&tree.whole[4 * node], 4, sphere);
    if (dark > 0) {
        const Vec3f centre = lit.centre();
        sphere[0] = centre.x, sphere[1] = centre.y, sphere[2] = centre.z;
        // Without the last rounding of the radius a single point has none.
        sphere[3] = 0.5f * std::sqrt(lit.diagonalSquare()) * (1 + 1e-6f);
    }
    for (std::size_t c = 0; c < 3; ++c) {
        Moments channel{};
        for (std::size_t i = first; i < end; ++i)
            channel.addPoint(tree.flux[c][i], tree.x[i] - sphere[0], tree.y[i] - sphere[1], tree.z[i] - sphere[2]);
        sum.channel[c] = channel;
    }
}

void gatherInner(Impl& tree, std::size_t node, NodeMoments* all) {
    const auto child = static_cast<std::size_t>(tree.child[node]);
    float* sphere = &tree.spheres[4 * node];
    const float* first = &tree.spheres[4 * child];
    const float* second = first + 4;
    if (first[3] < 0 || second[3] < 0) {
        const std::size_t lit = first[3] < 0 ? child + 1 : child;
        std::copy_n(&tree.spheres[4 * lit], 4, sphere);
        all[node] = all[lit];
        return;
    }
    std::copy_n(&tree.whole[4 * node], 4, sphere);
    for (std::size_t c = 0; c < 3; ++c) {
        Moments channel{};
        for (std::size_t k = child; k < child + 2; ++k) {
            const float* from = &tree.spheres[4 * k];
            channel.addShifted(all[k].channel[c], from[0] - sphere[0], from[1] - sphere[1], from[2] - sphere[2]);
        }
        all[node].channel[c] = channel;
    }
}

}  // namespace

Impl::Impl(const PointCloud& points, int threads) {
    const std::size_t n = points.positions.size();
    assert(n > 0 && points.areas.size() == n);
    std::vector<Located> located(n);
    for (std::size_t i = 0; i < n; ++i) located[i] = {points.positions[i], static_cast<std::uint32_t>(i)};

    struct Range {
        std::uint32_t first, count;
    };
    std::vector<Range> ranges{{0, static_cast<std::uint32_t>(n)}};
    while (!ranges.empty()) {
        const std::size_t begin = child.size();
        level.push_back(static_cast<std::uint32_t>(begin));
        const std::size_t nodes = ranges.size();
        spheres.resize(4 * (begin + nodes));
        // How many ranges a task takes, so that it has `grain` points.
        const std::size_t batch = std::max<std::size_t>(1, grain * nodes / n);
        parallelFor((nodes + batch - 1) / batch, threads, [&](std::size_t task) {
            for (std::size_t k = task * batch; k < std::min(nodes, (task + 1) * batch); ++k) {
                const std::span<Located> range(&located[ranges[k].first], ranges[k].count);
                const Box box = boundingBox(range);
                const Vec3f centre = box.centre();
                float* sphere = &spheres[4 * (begin + k)];
                sphere[0] = centre.x, sphere[1] = centre.y, sphere[2] = centre.z;
                sphere[3] = radiusAbout(centre, range);
                if (range.size() > leaf_size) splitAt(range, halfOf(range.size(), leaf_size), box.longestAxis());
            }
        });
        std::vector<Range> next;
        for (const Range& range : ranges) {
            first.push_back(range.first);
            count.push_back(range.count);
            child.push_back(range.count > leaf_size ? static_cast<std::int32_t>(begin + nodes + next.size()) : -1);
            if (range.count <= leaf_size) continue;
            const auto half = static_cast<std::uint32_t>(halfOf(range.count, leaf_size));
            next.push_back({range.first, half});
            next.push_back({range.first + half, range.count - half});
        }
        ranges = std::move(next);
    }
    level.push_back(static_cast<std::uint32_t>(child.size()));

    for (auto* list : {&x, &y, &z, &area, &flux[0], &flux[1], &flux[2]}) list->resize(n);
    order.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        order[i] = located[i].index;
        x[i] = located[i].position.x;
        y[i] = located[i].position.y;
        z[i] = located[i].position.z;
        area[i] = points.areas[order[i]];
        total_area += static_cast<double>(area[i]);
    }
    whole = spheres;
    weight.resize(child.size());
    moments.assign((child.size() + 1) * moments_per_node, 0.0f);
    setTransmitted(std::vector<Rgbf>(n), threads);
}

void Impl::setTransmitted(std::span<const Rgbf> transmitted, int threads) {
    const std::size_t n = order.size();
    assert(transmitted.size() == n);
    Rgb largest;
    for (const Rgbf& value : transmitted)
        for (int c = 0; c < Rgb::channels; ++c) largest[c] = std::max(largest[c], std::abs(toDouble(value)[c]));
    Rgbf scale;
    for (int c = 0; c < Rgb::channels; ++c) {
        lit[static_cast<std::size_t>(c)] = largest[c] > 0;
        unit[c] = largest[c] > 0 ? largest[c] : 1;
    }
    scale = toFloat(Rgb{1, 1, 1} / unit);
    parallelFor((n + grain - 1) / grain, threads, [&](std::size_t task) {
        for (std::size_t i = task * grain; i < std::min(n, (task + 1) * grain); ++i) {
            const Rgbf value = transmitted[order[i]];
            flux[0][i] = value.r * scale.r * area[i];
            flux[1][i] = value.g * scale.g * area[i];
            flux[2][i] = value.b * scale.b * area[i];
        }
    });
    std::array<float, 3> per_rms{};
    for (std::size_t c = 0; c < 3; ++c) {
        double squares = 0;
        for (std::size_t i = 0; i < n; ++i)
            if (area[i] > 0) squares += static_cast<double>(flux[c][i]) * static_cast<double>(flux[c][i] / area[i]);
        if (squares > 0) per_rms[c] = static_cast<float>(std::sqrt(total_area / squares));
    }
    auto* all = reinterpret_cast<NodeMoments*>(moments.data());
    for (std::size_t l = level.size() - 1; l-- > 0;) {
        const std::size_t nodes = level[l + 1] - level[l], batch = grain / leaf_size;
        parallelFor((nodes + batch - 1) / batch, threads, [&](std::size_t task) {
            for (std::size_t k = task * batch; k < std::min(nodes, (task + 1) * batch); ++k) {
                const std::size_t node = level[l] + k;
                if (child[node] < 0)
                    gatherLeaf(*this, node, all[node]);
                else
                    gatherInner(*this, node, all);
                float largest_flux = 0;
                for (std::size_t c = 0; c < 3; ++c)
                    largest_flux = std::max(largest_flux, per_rms[c] * all[node].channel[c].flux);
                weight[node] = std::cbrt(largest_flux);
            }
        });
    }
    // The first levels know where the light is to within a node of a thousandth of the points.
    fingerprint = 0xcbf29ce484222325 ^ n;
    const std::size_t known = std::min<std::size_t>(child.size(), 2048) * moments_per_node;
    for (std::size_t i = 0; i < known; ++i)
        fingerprint = (fingerprint ^ std::bit_cast<std::uint32_t>(moments[i])) * 0x100000001b3;
}

PointTree::PointTree(const PointCloud& points, int threads) : impl_(std::make_unique<Impl>(points, threads)) {}
PointTree::~PointTree() = default;
PointTree::PointTree(PointTree&&) noexcept = default;
PointTree& PointTree::operator=(PointTree&&) noexcept = default;

void PointTree::setTransmitted(std::span<const Rgbf> transmitted, int threads) {
    impl_->setTransmitted(transmitted, threads);
}

std::size_t PointTree::size() const { return impl_->order.size(); }
double PointTree::meanArea() const { return impl_->total_area / static_cast<double>(size()); }

}  // namespace searchlight
