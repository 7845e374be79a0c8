#include "render/visible/raster.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/visible/raster.cpp"
#include <hwy/foreach_target.h>

#include "render/visible/triangle_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

constexpr int kSide = Tile::side;

// Vertices [begin, end) to pixels.
void projectPart(Raster::Drawing& to, std::size_t begin, std::size_t end) {
    const View& view = *to.view;
    const double per_pixel = view.height / (2 * view.tan_half);
    const Vec3 right = (to.scale * per_pixel) * view.right + (to.scale * 0.5 * view.width) * view.forward;
    const Vec3 down = (-to.scale * per_pixel) * view.up + (to.scale * 0.5 * view.height) * view.forward;
    const Vec3 forward = to.scale * view.forward;
    for (std::size_t i = begin; i < end; ++i) {
        const Vec3 p = toDouble(to.mesh->positions[i]) - view.eye;
        const double x = dot(right, p), y = dot(down, p), w = dot(forward, p);
        double* const corner = &to.corners[4 * i];
        corner[0] = x, corner[1] = y, corner[2] = w;
        // 1e-6 of the object's size: closer than that a place in pixels means nothing.
        const bool seen = w > 1e-6;
        to.x[i] = seen ? static_cast<float>(std::clamp(x / w, -1e9, 1e9)) : Raster::behind;
        to.y[i] = seen ? static_cast<float>(std::clamp(y / w, -1e9, 1e9)) : Raster::behind;
    }
}

// One way of a triangle's box: pixels and, of those, the centres.
struct Range {
    int first, last, first_centre, last_centre;
};

void binPart(const Raster::Drawing& from, std::size_t begin, std::size_t end,
             std::vector<std::vector<BinnedTriangle>>& bins) {
    const Float d;
    const Int di;
    const std::size_t lanes = hn::Lanes(d);
    const auto* corners = reinterpret_cast<const std::int32_t*>(from.mesh->triangles.data());
    const int width = from.view->width, height = from.view->height;
    // A place in pixels is a rounded float: off by 1e-4 of a pixel at most.
    constexpr float slack = 1.0f / 64;
    struct alignas(64) Lane16 {
        std::int32_t at[16];
    } x[4], y[4];
    const auto put = [&](std::uint32_t triangle, Range h, Range v) {
        const int column0 = std::max(0, (h.first - 1) >> 6), column1 = std::min(from.columns - 1, (h.last + 1) >> 6);
        const int row0 = std::max(0, (v.first - 1) >> 6), row1 = std::min(from.rows - 1, (v.last + 1) >> 6);
        // In the window of a tile.
        const auto ends = [](int first, int last, int first_centre, int last_centre, int origin) {
            const int a = std::max(0, first - origin), b = std::min(Tile::window - 1, last - origin);
            const bool skip_a = first_centre - origin > a, skip_b = last_centre - origin < b;
            return std::pair{static_cast<std::uint8_t>(a | (skip_a ? Raster::beside_centre : 0)),
                             static_cast<std::uint8_t>(b | (skip_b ? Raster::beside_centre : 0))};
        };
        for (int row = row0; row <= row1; ++row)
            for (int column = column0; column <= column1; ++column) {
                const auto [left, right] = ends(h.first, h.last, h.first_centre, h.last_centre, column * kSide - 1);
                const auto [top, bottom] = ends(v.first, v.last, v.first_centre, v.last_centre, row * kSide - 1);
                bins[static_cast<std::size_t>(row * from.columns + column)].push_back(
                    {triangle, left, right, top, bottom});
            }
    };
    for (std::size_t i = begin; i < end; i += lanes) {
        const std::size_t count = std::min(lanes, end - i);
        const IntV number = hn::Add(hn::Set(di, static_cast<std::int32_t>(i)), hn::Iota(di, 0));
        const IntV triangle = hn::Min(number, hn::Set(di, static_cast<std::int32_t>(end - 1)));
        const IntV first = hn::Add(triangle, hn::ShiftLeft<1>(triangle));
        const IntV a = hn::GatherIndex(di, corners, first), b = hn::GatherIndex(di, corners + 1, first),
                   c = hn::GatherIndex(di, corners + 2, first);
        FloatV largest = hn::Zero(d);
        auto inside = hn::FirstN(d, count);
        const auto range = [&](const std::vector<float>& place, int size, Lane16* to) {
            const FloatV pa = hn::GatherIndex(d, place.data(), a), pb = hn::GatherIndex(d, place.data(), b),
                         pc = hn::GatherIndex(d, place.data(), c);
            const FloatV low = hn::Min(pa, hn::Min(pb, pc)), high = hn::Max(pa, hn::Max(pb, pc));
            largest = hn::Max(largest, high);
            const FloatV limit = hn::Set(d, static_cast<float>(size + 2));
            // The border of a window may lie outside of the picture: nothing is asked there.
            inside = hn::And(inside, hn::And(hn::Gt(high, hn::Set(d, -slack)),
                                             hn::Lt(low, hn::Set(d, static_cast<float>(size) + slack))));
            const auto pixel = [&](FloatV v, float by) {
                const FloatV clamped = hn::Min(hn::Max(hn::Add(v, hn::Set(d, by)), hn::Set(d, -2.0f)), limit);
                return hn::ConvertTo(di, hn::Floor(clamped));
            };
            hn::Store(pixel(low, -slack), di, to[0].at);
            hn::Store(pixel(high, slack), di, to[1].at);
            hn::Store(pixel(low, 0.5f - slack), di, to[2].at);  // ceil(low - 0.5)
            hn::Store(pixel(high, -0.5f + slack), di, to[3].at);
        };
        range(from.x, width, x);
        range(from.y, height, y);
        const auto crossing = hn::And(hn::FirstN(d, count), hn::Ge(largest, hn::Set(d, Raster::behind)));
        std::uint64_t bits = 0, crossing_bits = 0;
        hn::StoreMaskBits(d, hn::AndNot(crossing, inside), reinterpret_cast<std::uint8_t*>(&bits));
        hn::StoreMaskBits(d, crossing, reinterpret_cast<std::uint8_t*>(&crossing_bits));
        for (; bits != 0; bits &= bits - 1) {
            const int k = std::countr_zero(bits);
            put(static_cast<std::uint32_t>(i) + static_cast<std::uint32_t>(k),
                {x[0].at[k], x[1].at[k], x[2].at[k], x[3].at[k]}, {y[0].at[k], y[1].at[k], y[2].at[k], y[3].at[k]});
        }
        // Partly behind the eye: it may be seen anywhere.
        for (; crossing_bits != 0; crossing_bits &= crossing_bits - 1) {
            const std::size_t k = i + static_cast<std::size_t>(std::countr_zero(crossing_bits));
            const auto& vertices = from.mesh->triangles[k];
            if (std::ranges::all_of(vertices,
                                    [&](std::uint32_t v) { return from.corners[4 * std::size_t{v} + 2] <= 0; }))
                continue;
            put(static_cast<std::uint32_t>(k), {-1, width, -1, width}, {-1, height, -1, height});
        }
    }
}

bool drawCentres(const Raster::Drawing& drawing, const Tile& tile, std::size_t index, Hits& hits) {
    TrianglePack pack;
    bool any = false;
    const auto flush = [&] {
        setUp(drawing, tile, pack);
        for (std::size_t k = 0; k < pack.count; ++k) any = drawOne(pack, k, hits) || any;
        pack.count = 0;
    };
    for (const auto& run : drawing.bins)
        for (const BinnedTriangle& binned : run[index]) {
            const auto from = [](std::uint8_t end) { return (end & 0x7f) + (end >> 7); };
            const auto to = [](std::uint8_t end) { return (end & 0x7f) - (end >> 7); };
            const int left = from(binned.left), right = to(binned.right);
            const int top = from(binned.top), bottom = to(binned.bottom);
            if (left > right || top > bottom) continue;
            pack.add(binned.triangle, left, right, top, bottom);
            if (pack.count == TrianglePack::size) flush();
        }
    flush();
    return any;
}

void drawSamples(const Raster::Drawing& drawing, const Tile& tile, std::size_t index,
                 std::span<const std::uint16_t> pixels, std::size_t stride, Hits& hits) {
    std::array<std::uint64_t, kSide> rows{};
    std::array<std::uint16_t, kSide + 1> first_of_row{};  // among `pixels`
    for (const std::uint16_t pixel : pixels) {
        rows[pixel / kSide] |= std::uint64_t{1} << pixel % kSide;
        ++first_of_row[pixel / kSide + 1];
    }
    for (std::size_t y = 0; y < kSide; ++y)
        first_of_row[y + 1] = static_cast<std::uint16_t>(first_of_row[y + 1] + first_of_row[y]);
    TrianglePack pack;
    const auto columns = [](int left, int right) {
        return ~std::uint64_t{0} << left & ~std::uint64_t{0} >> (kSide - 1 - right);
    };
    const auto flush = [&] {
        setUp(drawing, tile, pack);
        for (std::size_t k = 0; k < pack.count; ++k) {
            const std::uint64_t wanted = columns(pack.left[k], pack.right[k]);
            for (int y = pack.top[k]; y <= pack.bottom[k]; ++y) {
                const std::uint64_t row = rows[static_cast<std::size_t>(y)];
                for (std::uint64_t bits = row & wanted; bits != 0; bits &= bits - 1) {
                    const int x = std::countr_zero(bits);
                    const auto before = static_cast<std::size_t>(std::popcount(row & ((std::uint64_t{1} << x) - 1)));
                    drawOneAt(drawing, pack, k, x, y, stride,
                              (first_of_row[static_cast<std::size_t>(y)] + before) * stride, hits);
                }
            }
        }
        pack.count = 0;
    };
    for (const auto& run : drawing.bins)
        for (const BinnedTriangle& binned : run[index]) {
            const auto inner = [](std::uint8_t end) { return (end & 0x7f) - 1; };
            const int left = std::max(0, inner(binned.left)), right = std::min(kSide - 1, inner(binned.right));
            const int top = std::max(0, inner(binned.top)), bottom = std::min(kSide - 1, inner(binned.bottom));
            if (left > right || top > bottom) continue;
            std::uint64_t seen = 0;
            for (int y = top; y <= bottom; ++y) seen |= rows[static_cast<std::size_t>(y)];
            if ((seen & columns(left, right)) == 0) continue;
            pack.add(binned.triangle, left, right, top, bottom);
            if (pack.count == TrianglePack::size) flush();
        }
    flush();
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(projectPart);
HWY_EXPORT(binPart);
HWY_EXPORT(drawCentres);
HWY_EXPORT(drawSamples);

void Raster::draw(const View& view, const Mesh& mesh, const TraceOptions& options) {
    drawing_.view = &view;
    drawing_.mesh = &mesh;
    drawing_.columns = (view.width + Tile::side - 1) / Tile::side;
    drawing_.rows = (view.height + Tile::side - 1) / Tile::side;
    const auto tiles = static_cast<std::size_t>(drawing_.columns) * static_cast<std::size_t>(drawing_.rows);
    for (auto& list : drawing_.pattern) list.clear();
    for (const auto& [x, y] : edgePattern(std::max(1, options.edge_samples))) {
        drawing_.pattern[0].push_back(static_cast<float>(x));
        drawing_.pattern[1].push_back(static_cast<float>(y));
    }
    for (auto& list : drawing_.pattern) list.resize(list.size() + 16, list.back());

    const std::size_t vertices = mesh.positions.size();
    drawing_.corners.resize(4 * vertices);
    drawing_.x.resize(vertices);
    drawing_.y.resize(vertices);
    // The size of what is looked at, or its distance.
    drawing_.scale = 1 / std::max(length(view.eye), 1e-30);
    constexpr std::size_t vertex_grain = 8192, least_run = 8192, most_runs = 32;
    parallelFor((vertices + vertex_grain - 1) / vertex_grain, options.threads, [&](std::size_t part) {
        HWY_DYNAMIC_DISPATCH(projectPart)
        (drawing_, part * vertex_grain, std::min(vertices, (part + 1) * vertex_grain));
    });
    const std::size_t triangles = mesh.triangles.size();
    const std::size_t run = std::max(least_run, (triangles + most_runs - 1) / most_runs);
    drawing_.bins.resize((triangles + run - 1) / run);
    parallelFor(drawing_.bins.size(), options.threads, [&](std::size_t part) {
        auto& bins = drawing_.bins[part];
        bins.resize(tiles);
        for (auto& bin : bins) bin.clear();
        HWY_DYNAMIC_DISPATCH(binPart)(drawing_, part * run, std::min(triangles, (part + 1) * run), bins);
    });
}

std::size_t Raster::tileIndex(const Tile& tile) const {
    return static_cast<std::size_t>(tile.top / Tile::side * drawing_.columns + tile.left / Tile::side);
}

bool Raster::centres(const Tile& tile, Hits& hits) const {
    return HWY_DYNAMIC_DISPATCH(drawCentres)(drawing_, tile, tileIndex(tile), hits);
}

void Raster::samples(const Tile& tile, std::span<const std::uint16_t> pixels, std::size_t stride, Hits& hits) const {
    HWY_DYNAMIC_DISPATCH(drawSamples)(drawing_, tile, tileIndex(tile), pixels, stride, hits);
}

}  // namespace searchlight
#endif
