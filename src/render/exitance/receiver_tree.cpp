#include "render/exitance/receiver_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>

#include "base/parallel.h"

namespace searchlight {

namespace {

using Impl = ReceiverTree::Impl;

constexpr std::size_t tiles_per_task = 64;

// Nodes below a piece, the root first.
struct Piece {
    Box box;
    std::array<ReceiverNode, 2 * Impl::tile_size / Impl::leaf_size - 1> nodes;
    std::uint32_t size = 0;
};

std::uint32_t spread(std::uint32_t v) {
    v &= 0x3ff;
    v = (v | v << 16) & 0x030000ff;
    v = (v | v << 8) & 0x0300f00f;
    v = (v | v << 4) & 0x030c30c3;
    return (v | v << 2) & 0x09249249;
}

// Along a Morton curve of 1024 cells a side.
void sortInSpace(std::vector<Located>& points, const Box& box, int threads) {
    const Vec3f extent = box.extent();
    const float longest = std::max({extent.x, extent.y, extent.z});
    const float scale = longest > 0 ? 1023.0f / longest : 0;
    std::vector<std::uint64_t> keys(points.size());
    constexpr std::size_t grain = 1 << 14;
    parallelFor((points.size() + grain - 1) / grain, threads, [&](std::size_t task) {
        for (std::size_t i = task * grain; i < std::min(points.size(), (task + 1) * grain); ++i) {
            const auto cell = [&](float a, float low) { return spread(static_cast<std::uint32_t>((a - low) * scale)); };
            const Vec3f p = points[i].position;
            const std::uint32_t code = cell(p.x, box.low.x) | cell(p.y, box.low.y) << 1 | cell(p.z, box.low.z) << 2;
            keys[i] = static_cast<std::uint64_t>(code) << 32 | i;
        }
    });
    std::sort(keys.begin(), keys.end());
    std::vector<Located> sorted(points.size());
    for (std::size_t i = 0; i < keys.size(); ++i) sorted[i] = points[keys[i] & 0xffffffff];
    points = std::move(sorted);
}

// Sorts up to a tile of points along an axis, by counting for each how many stand before it: without branches that a
// processor could mispredict, that is some times faster than a sort.
void sortAlong(std::span<Located> points, const Box& box, int axis) {
    std::array<std::int32_t, Impl::tile_size> keys;
    std::array<Located, Impl::tile_size> sorted;
    const std::size_t n = points.size();
    const float low = coordinate(box.low, axis), extent = coordinate(box.extent(), axis);
    const float scale = extent > 0 ? 0x1.fffffcp24f / extent : 0;
    // 25 bits of place and 6 that make keys differ.
    for (std::size_t i = 0; i < n; ++i)
        keys[i] = static_cast<std::int32_t>((coordinate(points[i].position, axis) - low) * scale) << 6 |
                  static_cast<std::int32_t>(i);
    for (std::size_t i = 0; i < n; ++i) {
        std::int32_t before = 0;
        for (std::size_t j = 0; j < n; ++j) before += keys[j] < keys[i];
        sorted[static_cast<std::size_t>(before)] = points[i];
    }
    std::copy_n(sorted.begin(), n, points.begin());
}

class Builder {
public:
    Builder(std::vector<Located>& points, int threads) : points_(points), threads_(threads) {}

    // Median of the tiles' squared diagonals: what a tile is like that lies on one surface.
    void measureTiles() {
        const std::size_t tiles = tileCount();
        std::vector<float> diagonals(tiles);
        parallelFor((tiles + tiles_per_task - 1) / tiles_per_task, threads_, [&](std::size_t task) {
            for (std::size_t t = task * tiles_per_task; t < std::min(tiles, (task + 1) * tiles_per_task); ++t)
                diagonals[t] = boundingBox(tile(t)).diagonalSquare();
        });
        const auto middle = diagonals.begin() + static_cast<std::ptrdiff_t>(tiles / 2);
        std::nth_element(diagonals.begin(), middle, diagonals.end());
        usual_ = std::sqrt(*middle);
    }

    // Tiles of a picture cover a surface about once; tiles of a list without order each cover all of it.
    bool inOrder(const Box& box) const {
        return tileCount() < 8 || usual_ * usual_ * static_cast<float>(tileCount()) < 8 * box.diagonalSquare();
    }

    std::vector<ReceiverNode> build() {
        const std::size_t tiles = tileCount(), tasks = (tiles + tiles_per_task - 1) / tiles_per_task;
        std::vector<std::vector<Piece>> parts(tasks);
        parallelFor(tasks, threads_, [&](std::size_t task) {
            for (std::size_t t = task * tiles_per_task; t < std::min(tiles, (task + 1) * tiles_per_task); ++t)
                cutApart(tile(t), parts[task]);
        });
        std::vector<Located> centres;
        std::size_t below = 0;
        for (const std::vector<Piece>& part : parts)
            for (const Piece& piece : part) {
                centres.push_back({piece.nodes[0].centre, static_cast<std::uint32_t>(pieces_.size())});
                pieces_.push_back(&piece);
                below += piece.size - 1;
            }
        nodes_.reserve(2 * pieces_.size() - 1 + below);
        nodes_.emplace_back();
        join(centres, 0);
        return std::move(nodes_);
    }

private:
    std::size_t tileCount() const { return (points_.size() + Impl::tile_size - 1) / Impl::tile_size; }

    std::span<Located> tile(std::size_t t) {
        const std::size_t first = t * Impl::tile_size;
        return {&points_[first], std::min(Impl::tile_size, points_.size() - first)};
    }

    // A tile that is larger than others usually shows two surfaces, one before the other, or the end of one row of
    // tiles and the start of the next: it is cut at its widest gap.
    void cutApart(std::span<Located> points, std::vector<Piece>& pieces) {
        const Box box = boundingBox(points);
        if (points.size() > 1 && box.diagonalSquare() > 4 * usual_ * usual_) {
            const int axis = box.longestAxis();
            sortAlong(points, box, axis);
            float widest = 0;
            std::size_t at = 0;
            for (std::size_t i = 1; i < points.size(); ++i) {
                const float gap = coordinate(points[i].position, axis) - coordinate(points[i - 1].position, axis);
                if (gap > widest) widest = gap, at = i;
            }
            // A gap in a slanted surface is one step between pixels.
            if (widest > 0.25f * coordinate(box.extent(), axis)) {
                cutApart(points.first(at), pieces);
                cutApart(points.subspan(at), pieces);
                return;
            }
        }
        Piece piece;
        piece.box = box;
        piece.size = 1;
        grow(points, box, 0, piece);
        pieces.push_back(piece);
    }

    void grow(std::span<Located> points, const Box& box, std::size_t slot, Piece& piece) {
        ReceiverNode& node = piece.nodes[slot];
        node.centre = box.centre();
        node.radius = radiusAbout(node.centre, points);
        node.first = static_cast<std::uint32_t>(points.data() - points_.data());
        node.count = static_cast<std::uint32_t>(points.size());
        if (points.size() <= Impl::leaf_size) return;
        const std::size_t half = halfOf(points.size(), Impl::leaf_size);
        sortAlong(points, box, box.longestAxis());
        const std::size_t child = piece.size;
        node.child = static_cast<std::int32_t>(child);
        piece.size += 2;
        grow(points.first(half), boundingBox(points.first(half)), child, piece);
        grow(points.subspan(half), boundingBox(points.subspan(half)), child + 1, piece);
    }

    // The tree over pieces, by medians of their centres; returns the box of the node.
    Box join(std::span<Located> centres, std::size_t slot) {
        if (centres.size() == 1) {
            const Piece& piece = *pieces_[centres[0].index];
            const auto offset = static_cast<std::int32_t>(nodes_.size()) - 1;
            for (std::uint32_t i = 0; i < piece.size; ++i) {
                ReceiverNode node = piece.nodes[i];
                if (node.child >= 0) node.child += offset;
                if (i == 0)
                    nodes_[slot] = node;
                else
                    nodes_.push_back(node);
            }
            return piece.box;
        }
        splitAt(centres, centres.size() / 2, boundingBox(centres).longestAxis());
        const std::size_t child = nodes_.size();
        nodes_.resize(child + 2);
        Box box = join(centres.first(centres.size() / 2), child);
        box.add(join(centres.subspan(centres.size() / 2), child + 1));
        ReceiverNode& node = nodes_[slot];
        node.child = static_cast<std::int32_t>(child);
        node.centre = box.centre();
        // Both the box and the children's spheres hold the points.
        const float diagonal = 0.5f * std::sqrt(box.diagonalSquare());
        float reach = 0;
        for (std::size_t k = child; k < child + 2; ++k) {
            const Vec3 between = toDouble(nodes_[k].centre) - toDouble(node.centre);
            reach = std::max(reach, static_cast<float>(length(between)) + nodes_[k].radius);
            node.count += nodes_[k].count;
        }
        node.radius = std::min(diagonal, reach) * (1 + 1e-6f);
        return box;
    }

    std::vector<Located>& points_;
    int threads_;
    float usual_ = 0;
    std::vector<const Piece*> pieces_;
    std::vector<ReceiverNode> nodes_;
};

}  // namespace

Impl::Impl(std::span<const Vec3f> receivers, int threads) {
    const auto start = std::chrono::steady_clock::now();
    const std::size_t n = receivers.size();
    std::vector<Located> points(n);
    constexpr std::size_t grain = 1 << 14;
    const auto forEach = [&](const auto& body) {
        parallelFor((n + grain - 1) / grain, threads, [&](std::size_t task) {
            for (std::size_t i = task * grain; i < std::min(n, (task + 1) * grain); ++i) body(i);
        });
    };
    forEach([&](std::size_t i) { points[i] = {receivers[i], static_cast<std::uint32_t>(i)}; });
    if (n > 0) {
        Builder builder(points, threads);
        const Box box = boundingBox(points);
        builder.measureTiles();
        if (!builder.inOrder(box)) {
            sortInSpace(points, box, threads);
            builder.measureTiles();
        }
        nodes = builder.build();
    }
    constexpr std::size_t spare = 16;
    order.resize(n);
    for (auto* list : {&x, &y, &z}) list->resize(n + spare);
    forEach([&](std::size_t i) {
        order[i] = points[i].index;
        x[i] = points[i].position.x;
        y[i] = points[i].position.y;
        z[i] = points[i].position.z;
    });
    fingerprint = 0xcbf29ce484222325 ^ n;
    for (const ReceiverNode& node : nodes) {
        const auto bits = static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(node.centre.x)) << 32 |
                          std::bit_cast<std::uint32_t>(node.centre.y);
        fingerprint = (fingerprint ^ bits ^ std::bit_cast<std::uint32_t>(node.centre.z)) * 0x100000001b3;
    }
    build_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

ReceiverTree::ReceiverTree(std::span<const Vec3f> receivers, int threads)
    : impl_(std::make_unique<Impl>(receivers, threads)) {}
ReceiverTree::~ReceiverTree() = default;
ReceiverTree::ReceiverTree(ReceiverTree&&) noexcept = default;
ReceiverTree& ReceiverTree::operator=(ReceiverTree&&) noexcept = default;

std::size_t ReceiverTree::size() const { return impl_->order.size(); }

}  // namespace searchlight
