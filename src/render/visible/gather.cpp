#include "render/visible/gather.h"

#include <algorithm>
#include <bit>
#include <mutex>

#include "base/error.h"
#include "base/parallel.h"
#include "render/visible/surface_lanes.h"

namespace searchlight {

namespace {

// Neighbours in the list are neighbours in space: blocks of 8 x 8 pixels.
constexpr int block_side = 8;

// What a tile needs; huge enough that it is not made anew for each.
struct Scratch {
    Hits centres, samples;
    SurfacePlanes surface, at_samples;
    std::array<std::uint64_t, Tile::side> edges{};
    std::vector<std::uint16_t> edge_pixels;
};

struct Patch {
    std::size_t first;  // of its samples
    Vec3f normals;      // their sum
    int count;
};

Vec3f sum(Vec3f a, Vec3f b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

template <class Body>
void forEachList(const Body& body) {
    body(&VisibleSurface::pixels);
    body(&VisibleSurface::coverage);
    body(&VisibleSurface::positions);
    body(&VisibleSurface::normals);
    body(&VisibleSurface::geometric_normals);
}

// What a tile adds to the list: lists that never shrink, of which the first `size` count.
struct Part {
    VisibleSurface lists;
    std::size_t size = 0;

    void reserve(std::size_t count) {
        if (lists.pixels.size() < count) forEachList([&](auto list) { (lists.*list).resize(count); });
    }
    void append(std::uint32_t pixel, float coverage, Vec3f position, Vec3f normal, Vec3f geometric) {
        lists.pixels[size] = pixel;
        lists.coverage[size] = coverage;
        lists.positions[size] = position;
        lists.normals[size] = normal;
        lists.geometric_normals[size] = geometric;
        ++size;
    }
};

class TileWork {
public:
    TileWork(const View& view, const Mesh& mesh, const HitSource& source, int edge_samples, const Tile& tile,
             Scratch& scratch, Part& part)
        : view_(view),
          mesh_(mesh),
          source_(source),
          edge_samples_(static_cast<std::size_t>(std::max(1, edge_samples))),
          stride_((edge_samples_ + 7) / 8 * 8),
          tile_(tile),
          scratch_(scratch),
          part_(part),
          rule_(view) {}

    void run() {
        scratch_.centres.clear(Tile::plane);
        if (!source_.centres(tile_, scratch_.centres)) return;
        scratch_.surface.resize(Tile::plane + 16);
        surfaceAt(mesh_, view_, scratch_.centres,
                  static_cast<std::size_t>(Tile::stride) * static_cast<std::size_t>(tile_.height + 2),
                  scratch_.surface);
        scratch_.edges.fill(0);
        if (edge_samples_ > 1) divideEdges();
        std::size_t edge = 0;
        edge_of_row_.fill(0);
        for (int y = 0; y < tile_.height; ++y) {
            edge_of_row_[static_cast<std::size_t>(y)] = edge;
            edge += static_cast<std::size_t>(std::popcount(scratch_.edges[static_cast<std::size_t>(y)]));
        }
        part_.reserve(static_cast<std::size_t>(tile_.width * tile_.height) + edge * edge_samples_);
        for (int top = 0; top < tile_.height; top += block_side)
            for (int left = 0; left < tile_.width; left += block_side) block(left, top);
    }

private:
    void divideEdges() {
        findEdges(tile_, view_, scratch_.centres, scratch_.surface, scratch_.edges);
        scratch_.edge_pixels.clear();
        for (int y = 0; y < tile_.height; ++y)
            for (std::uint64_t row = scratch_.edges[static_cast<std::size_t>(y)]; row != 0; row &= row - 1)
                scratch_.edge_pixels.push_back(static_cast<std::uint16_t>(Tile::side * y + std::countr_zero(row)));
        if (scratch_.edge_pixels.empty()) return;
        const std::size_t count = scratch_.edge_pixels.size() * stride_;
        scratch_.samples.clear(count);
        source_.samples(tile_, scratch_.edge_pixels, stride_, scratch_.samples);
        if (scratch_.at_samples.position[0].size() < count + 16) scratch_.at_samples.resize(count + 16);
        surfaceAt(mesh_, view_, scratch_.samples, count, scratch_.at_samples);
    }

    void block(int left, int top) {
        for (int y = top; y < std::min(top + block_side, tile_.height); ++y) {
            const std::uint64_t row = scratch_.edges[static_cast<std::size_t>(y)];
            for (int x = left; x < std::min(left + block_side, tile_.width); ++x) {
                const auto pixel = static_cast<std::uint32_t>(tile_.top + y) * static_cast<std::uint32_t>(view_.width) +
                                   static_cast<std::uint32_t>(tile_.left + x);
                if (row >> x & 1) {
                    const std::uint64_t before = row & ((std::uint64_t{1} << x) - 1);
                    gatherEdge(pixel, edge_of_row_[static_cast<std::size_t>(y)] +
                                          static_cast<std::size_t>(std::popcount(before)));
                    continue;
                }
                const std::size_t at = Tile::at(x + 1, y + 1);
                if (scratch_.centres.inverse_depth[at] > 0)
                    part_.append(pixel, 1, scratch_.surface.positionAt(at), scratch_.surface.normalAt(at),
                                 scratch_.surface.geometricAt(at));
            }
        }
    }

    // The samples of an edge pixel, those of one patch as one: exitance hardly changes within a pixel.
    void gatherEdge(std::uint32_t pixel, std::size_t edge) {
        const SurfacePlanes& at = scratch_.at_samples;
        const Hits& hits = scratch_.samples;
        patches_.clear();
        for (std::size_t i = edge * stride_; i < edge * stride_ + edge_samples_; ++i) {
            if (!(hits.inverse_depth[i] > 0)) continue;
            const auto patch = std::ranges::find_if(patches_, [&](const Patch& p) {
                return rule_.same(at.normalAt(p.first), at.geometricAt(p.first), at.positionAt(p.first), at.normalAt(i),
                                  at.positionAt(i), std::max(hits.inverse_depth[p.first], hits.inverse_depth[i]));
            });
            if (patch == patches_.end()) {
                patches_.push_back({i, at.normalAt(i), 1});
                continue;
            }
            patch->normals = sum(patch->normals, at.normalAt(i));
            ++patch->count;
        }
        for (const Patch& patch : patches_)
            part_.append(pixel, static_cast<float>(patch.count) / static_cast<float>(edge_samples_),
                         at.positionAt(patch.first), toFloat(normalize(toDouble(patch.normals))),
                         at.geometricAt(patch.first));
    }

    const View& view_;
    const Mesh& mesh_;
    const HitSource& source_;
    std::size_t edge_samples_, stride_;
    const Tile& tile_;
    Scratch& scratch_;
    Part& part_;
    PatchRule rule_;
    std::array<std::size_t, Tile::side> edge_of_row_;  // the first edge pixel of each
    std::vector<Patch> patches_;
};

}  // namespace

struct SurfaceGatherer::Impl {
    std::mutex mutex;
    std::vector<std::unique_ptr<Scratch>> idle;
    std::vector<Part> parts;  // per tile

    std::unique_ptr<Scratch> take() {
        const std::lock_guard lock(mutex);
        if (idle.empty()) return std::make_unique<Scratch>();
        std::unique_ptr<Scratch> scratch = std::move(idle.back());
        idle.pop_back();
        return scratch;
    }
    void giveBack(std::unique_ptr<Scratch> scratch) {
        const std::lock_guard lock(mutex);
        idle.push_back(std::move(scratch));
    }

    void join(std::size_t tiles, int threads, VisibleSurface& all) const {
        std::vector<std::size_t> first(tiles + 1);
        for (std::size_t t = 0; t < tiles; ++t) first[t + 1] = first[t] + parts[t].size;
        forEachList([&](auto list) { (all.*list).resize(first[tiles]); });
        parallelFor(tiles, threads, [&](std::size_t t) {
            forEachList([&](auto list) {
                std::copy_n((parts[t].lists.*list).begin(), parts[t].size,
                            (all.*list).begin() + static_cast<std::ptrdiff_t>(first[t]));
            });
        });
    }
};

SurfaceGatherer::SurfaceGatherer() : impl_(std::make_unique<Impl>()) {}
SurfaceGatherer::~SurfaceGatherer() = default;

void SurfaceGatherer::gather(const View& view, const Mesh& mesh, const HitSource& source, const TraceOptions& options,
                             Observer& observer, VisibleSurface& visible) {
    const int columns = (view.width + Tile::side - 1) / Tile::side, rows = (view.height + Tile::side - 1) / Tile::side;
    const auto tiles = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    if (impl_->parts.size() < tiles) impl_->parts.resize(tiles);
    parallelFor(tiles, options.threads, [&](std::size_t t) {
        if (observer.cancelled()) throw interruptedError();
        Tile tile{static_cast<int>(t) % columns * Tile::side, static_cast<int>(t) / columns * Tile::side};
        tile.width = std::min(Tile::side, view.width - tile.left);
        tile.height = std::min(Tile::side, view.height - tile.top);
        Part& part = impl_->parts[t];
        part.size = 0;
        std::unique_ptr<Scratch> scratch = impl_->take();
        TileWork(view, mesh, source, options.edge_samples, tile, *scratch, part).run();
        impl_->giveBack(std::move(scratch));
    });
    visible.width = view.width;
    visible.height = view.height;
    visible.eye = view.eye;
    impl_->join(tiles, options.threads, visible);
}

}  // namespace searchlight
