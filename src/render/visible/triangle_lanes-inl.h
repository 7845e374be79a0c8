// Triangles as edge functions in a tile. Included once per instruction set.
#if defined(SEARCHLIGHT_RENDER_TRIANGLE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_RENDER_TRIANGLE_LANES_INL_H_
#undef SEARCHLIGHT_RENDER_TRIANGLE_LANES_INL_H_
#else
#define SEARCHLIGHT_RENDER_TRIANGLE_LANES_INL_H_
#endif

#include <bit>
#include <cstddef>
#include <cstdint>

#include "base/lanes-inl.h"
#include "render/visible/raster.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

using Double = hn::CappedTag<double, 8>;
using DoubleV = hn::Vec<Double>;
using Long = hn::RebindToSigned<Double>;

/// Triangles that are set up together, and in which pixels each is looked for.
struct TrianglePack {
    static constexpr std::size_t size = 16;

    std::size_t count = 0;
    std::uint32_t triangle[size];
    int left[size], right[size], top[size], bottom[size];
    /// a x + b y + c, (x, y) from the centre of the window's first pixel: the three edge functions, and 1 / depth.
    alignas(64) float a[4][size], b[4][size], c[4][size];

    HWY_INLINE void add(std::uint32_t number, int l, int r, int t, int u) {
        triangle[count] = number;
        left[count] = l, right[count] = r, top[count] = t, bottom[count] = u;
        ++count;
    }
};

/// Fills the functions of the pack. Without FMA in the products: both sides of an edge must be exact negatives.
HWY_INLINE void setUp(const Raster::Drawing& drawing, const Tile& tile, TrianglePack& pack) {
    const Double d;
    const Long dl;
    const hn::Rebind<float, Double> df;
    const DoubleV origin_x = hn::Set(d, tile.left - 0.5), origin_y = hn::Set(d, tile.top - 0.5);
    const DoubleV zero = hn::Zero(d);
    struct Corner {
        DoubleV x, y, w;
    };
    struct Plane {
        DoubleV a, b, c;
    };
    for (std::size_t first = 0; first < pack.count; first += hn::Lanes(d)) {
        alignas(64) std::int64_t at[3][8];
        for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
            const auto& corners = drawing.mesh->triangles[pack.triangle[std::min(first + k, pack.count - 1)]];
            for (std::size_t i = 0; i < 3; ++i) at[i][k] = 4 * static_cast<std::int64_t>(corners[i]);
        }
        const auto corner = [&](std::size_t i) {
            const auto index = hn::Load(dl, at[i]);
            const double* base = drawing.corners.data();
            const DoubleV w = hn::GatherIndex(d, base + 2, index);
            return Corner{hn::Sub(hn::GatherIndex(d, base, index), hn::Mul(origin_x, w)),
                          hn::Sub(hn::GatherIndex(d, base + 1, index), hn::Mul(origin_y, w)), w};
        };
        const Corner p[3] = {corner(0), corner(1), corner(2)};
        const auto between = [](const Corner& q, const Corner& r) {
            return Plane{hn::Sub(hn::Mul(q.y, r.w), hn::Mul(q.w, r.y)), hn::Sub(hn::Mul(q.w, r.x), hn::Mul(q.x, r.w)),
                         hn::Sub(hn::Mul(q.x, r.y), hn::Mul(q.y, r.x))};
        };
        Plane edge[3] = {between(p[1], p[2]), between(p[2], p[0]), between(p[0], p[1])};
        const DoubleV det = hn::MulAdd(p[0].x, edge[0].a, hn::MulAdd(p[0].y, edge[0].b, hn::Mul(p[0].w, edge[0].c)));
        const auto nothing = hn::Eq(det, zero);
        const DoubleV sign = hn::CopySign(hn::Set(d, 1.0), det);
        const DoubleV per_det = hn::Div(hn::Set(d, drawing.scale), hn::IfThenElse(nothing, sign, hn::Abs(det)));
        const auto put = [&](std::size_t i, DoubleV a, DoubleV b, DoubleV c) {
            hn::Store(hn::DemoteTo(df, a), df, pack.a[i] + first);
            hn::Store(hn::DemoteTo(df, b), df, pack.b[i] + first);
            hn::Store(hn::DemoteTo(df, c), df, pack.c[i] + first);
        };
        for (std::size_t i = 0; i < 3; ++i)
            // One that is seen from its edge is nowhere.
            put(i, hn::IfThenZeroElse(nothing, hn::Mul(sign, edge[i].a)),
                hn::IfThenZeroElse(nothing, hn::Mul(sign, edge[i].b)),
                hn::IfThenElse(nothing, hn::Set(d, -1.0), hn::Mul(sign, edge[i].c)));
        const auto sum = [&](DoubleV u, DoubleV v, DoubleV w) {
            return hn::Mul(hn::Mul(sign, per_det), hn::Add(u, hn::Add(v, w)));
        };
        put(3, sum(edge[0].a, edge[1].a, edge[2].a), sum(edge[0].b, edge[1].b, edge[2].b),
            sum(edge[0].c, edge[1].c, edge[2].c));
    }
}

/// The functions of triangle k at some places.
template <class D>
struct AtPlaces {
    hn::Vec<D> u, v, sum, inverse_depth;
    hn::Mask<D> inside;

    HWY_INLINE AtPlaces(D d, const TrianglePack& pack, std::size_t k, hn::Vec<D> x, hn::Vec<D> y) {
        const auto value = [&](std::size_t i) HWY_ATTR {
            return hn::MulAdd(hn::Set(d, pack.a[i][k]), x,
                              hn::MulAdd(hn::Set(d, pack.b[i][k]), y, hn::Set(d, pack.c[i][k])));
        };
        const auto e0 = value(0);
        u = value(1);
        v = value(2);
        inverse_depth = value(3);
        sum = hn::Add(e0, hn::Add(u, v));
        inside = hn::And(hn::And(hn::Ge(hn::Min(e0, hn::Min(u, v)), hn::Zero(d)), hn::Gt(sum, hn::Zero(d))),
                         hn::Gt(inverse_depth, hn::Zero(d)));
    }
    HWY_INLINE void divide(D d) {
        const auto per_sum = hn::Div(hn::Set(d, 1.0f), sum);
        u = hn::Mul(u, per_sum);
        v = hn::Mul(v, per_sum);
    }
};

/// Triangle k of the pack at the centres of its pixels, by blocks of four columns; true where it is the nearest so far.
HWY_INLINE bool drawOne(const TrianglePack& pack, std::size_t k, Hits& hits) {
    const Float d;
    const Int di;
    constexpr int columns = 4;
    const int rows = static_cast<int>(hn::Lanes(d)) / columns;
    const IntV lane = hn::Iota(di, 0);
    const FloatV lane_x = hn::ConvertTo(d, hn::And(lane, hn::Set(di, columns - 1)));
    const FloatV lane_y = hn::ConvertTo(d, hn::ShiftRight<2>(lane));
    bool any = false;
    for (int y = pack.top[k]; y <= pack.bottom[k]; y += rows)
        for (int x = pack.left[k]; x <= pack.right[k]; x += columns) {
            AtPlaces at(d, pack, k, hn::Add(lane_x, hn::Set(d, static_cast<float>(x))),
                        hn::Add(lane_y, hn::Set(d, static_cast<float>(y))));
            if (hn::AllFalse(d, at.inside)) continue;
            at.divide(d);
            std::uint64_t bits = 0;
            hn::StoreMaskBits(d, at.inside, reinterpret_cast<std::uint8_t*>(&bits));
            alignas(64) float u[16], v[16], inverse_depth[16];
            hn::Store(at.u, d, u);
            hn::Store(at.v, d, v);
            hn::Store(at.inverse_depth, d, inverse_depth);
            for (; bits != 0; bits &= bits - 1) {
                const int i = std::countr_zero(bits);
                const std::size_t pixel = Tile::at(x + i % columns, y + i / columns);
                if (!(inverse_depth[i] > hits.inverse_depth[pixel])) continue;
                hits.inverse_depth[pixel] = inverse_depth[i];
                hits.triangle[pixel] = pack.triangle[k];
                hits.u[pixel] = u[i];
                hits.v[pixel] = v[i];
                any = true;
            }
        }
    return any;
}

/// Triangle k of the pack at the points of the edge pattern in pixel (x, y) of the tile, `stride` hits from `first` on.
HWY_INLINE void drawOneAt(const Raster::Drawing& drawing, const TrianglePack& pack, std::size_t k, int x, int y,
                          std::size_t stride, std::size_t first, Hits& hits) {
    // Eight, as the usual pattern has.
    const hn::CappedTag<float, 8> d;
    const hn::RebindToSigned<decltype(d)> di;
    // From the centre of the window's first pixel, which is the tile's less one.
    const auto left = hn::Set(d, static_cast<float>(x) + 0.5f), top = hn::Set(d, static_cast<float>(y) + 0.5f);
    for (std::size_t i = 0; i < stride; i += hn::Lanes(d)) {
        AtPlaces at(d, pack, k, hn::Add(left, hn::LoadU(d, &drawing.pattern[0][i])),
                    hn::Add(top, hn::LoadU(d, &drawing.pattern[1][i])));
        float* const nearest = &hits.inverse_depth[first + i];
        const auto wins = hn::And(at.inside, hn::Gt(at.inverse_depth, hn::LoadU(d, nearest)));
        if (hn::AllFalse(d, wins)) continue;
        at.divide(d);
        hn::BlendedStore(at.inverse_depth, wins, d, nearest);
        hn::BlendedStore(at.u, wins, d, &hits.u[first + i]);
        hn::BlendedStore(at.v, wins, d, &hits.v[first + i]);
        hn::BlendedStore(hn::Set(di, static_cast<std::int32_t>(pack.triangle[k])), hn::RebindMask(di, wins), di,
                         reinterpret_cast<std::int32_t*>(&hits.triangle[first + i]));
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
