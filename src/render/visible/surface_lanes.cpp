#include "render/visible/surface_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/visible/surface_lanes.cpp"
#include <hwy/foreach_target.h>

#include "base/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

struct Vectors {
    FloatV x, y, z;
};

HWY_INLINE Vectors sub(const Vectors& a, const Vectors& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

HWY_INLINE Vectors scaled(FloatV s, const Vectors& a) { return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)}; }

HWY_INLINE FloatV dotOf(const Vectors& a, const Vectors& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

// a b - c d to the last digits where multiply-adds are fused (Kahan): of a sliver the products cancel.
HWY_INLINE FloatV difference(FloatV a, FloatV b, FloatV c, FloatV d) {
    const FloatV product = hn::Mul(c, d);
    const FloatV rest = hn::NegMulAdd(c, d, product);
    return hn::Add(hn::MulSub(a, b, product), rest);
}

HWY_INLINE Vectors crossOf(const Vectors& a, const Vectors& b) {
    return {difference(a.y, b.z, a.z, b.y), difference(a.z, b.x, a.x, b.z), difference(a.x, b.y, a.y, b.x)};
}

HWY_INLINE Vectors gathered(const std::vector<Vec3f>& from, IntV three_times) {
    const Float d;
    const float* base = &from[0].x;
    return {hn::GatherIndex(d, base, three_times), hn::GatherIndex(d, base + 1, three_times),
            hn::GatherIndex(d, base + 2, three_times)};
}

HWY_INLINE Vectors loaded(const std::array<std::vector<float>, 3>& planes, std::size_t i) {
    const Float d;
    return {hn::LoadU(d, &planes[0][i]), hn::LoadU(d, &planes[1][i]), hn::LoadU(d, &planes[2][i])};
}

HWY_INLINE void stored(const Vectors& v, std::array<std::vector<float>, 3>& planes, std::size_t i) {
    const Float d;
    hn::StoreU(v.x, d, &planes[0][i]);
    hn::StoreU(v.y, d, &planes[1][i]);
    hn::StoreU(v.z, d, &planes[2][i]);
}

void surfaceAtLanes(const Mesh& mesh, const View& view, const Hits& hits, std::size_t count, SurfacePlanes& planes) {
    const Float d;
    const Int di;
    const FloatV zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const Vec3f eye = toFloat(view.eye);
    const auto* corners = reinterpret_cast<const std::int32_t*>(mesh.triangles.data());
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const auto hit = hn::Gt(hn::LoadU(d, &hits.inverse_depth[i]), zero);
        if (hn::AllFalse(d, hit)) continue;
        const IntV triangle = hn::IfThenElseZero(
            hn::RebindMask(di, hit), hn::LoadU(di, reinterpret_cast<const std::int32_t*>(&hits.triangle[i])));
        const auto thrice = [](IntV k) { return hn::Add(k, hn::ShiftLeft<1>(k)); };
        const IntV first = thrice(triangle);
        const IntV a = thrice(hn::GatherIndex(di, corners, first));
        const IntV b = thrice(hn::GatherIndex(di, corners + 1, first));
        const IntV c = thrice(hn::GatherIndex(di, corners + 2, first));
        const FloatV u = hn::LoadU(d, &hits.u[i]), v = hn::LoadU(d, &hits.v[i]);
        const FloatV w = hn::Sub(hn::Sub(one, u), v);
        const Vectors p = gathered(mesh.positions, a);
        const Vectors pb = sub(gathered(mesh.positions, b), p), pc = sub(gathered(mesh.positions, c), p);
        const Vectors to_eye{hn::Sub(hn::Set(d, eye.x), p.x), hn::Sub(hn::Set(d, eye.y), p.y),
                             hn::Sub(hn::Set(d, eye.z), p.z)};
        Vectors geometric = crossOf(pb, pc);
        // One without area, which rounding let be hit, faces the eye.
        const auto flat = hn::Eq(dotOf(geometric, geometric), zero);
        geometric = {hn::IfThenElse(flat, to_eye.x, geometric.x), hn::IfThenElse(flat, to_eye.y, geometric.y),
                     hn::IfThenElse(flat, to_eye.z, geometric.z)};
        geometric = scaled(hn::Div(one, hn::Sqrt(dotOf(geometric, geometric))), geometric);
        // Open meshes show their inside.
        const FloatV side = hn::CopySign(one, dotOf(geometric, to_eye));
        geometric = scaled(side, geometric);
        Vectors normal = geometric;
        if (!mesh.normals.empty()) {
            const Vectors na = gathered(mesh.normals, a), nb = gathered(mesh.normals, b),
                          nc = gathered(mesh.normals, c);
            const auto mixed = [&](FloatV x, FloatV y, FloatV z) {
                return hn::MulAdd(w, x, hn::MulAdd(u, y, hn::Mul(v, z)));
            };
            const Vectors mean{mixed(na.x, nb.x, nc.x), mixed(na.y, nb.y, nc.y), mixed(na.z, nb.z, nc.z)};
            const FloatV square = dotOf(mean, mean);
            const Vectors unit = scaled(hn::Div(side, hn::Sqrt(square)), mean);
            const auto usable = hn::And(hn::Gt(square, hn::Set(d, 1e-12f)), hn::Gt(dotOf(unit, geometric), zero));
            normal = {hn::IfThenElse(usable, unit.x, geometric.x), hn::IfThenElse(usable, unit.y, geometric.y),
                      hn::IfThenElse(usable, unit.z, geometric.z)};
        }
        // From the first corner: what is added is small.
        stored({hn::MulAdd(u, pb.x, hn::MulAdd(v, pc.x, p.x)), hn::MulAdd(u, pb.y, hn::MulAdd(v, pc.y, p.y)),
                hn::MulAdd(u, pb.z, hn::MulAdd(v, pc.z, p.z))},
               planes.position, i);
        stored(normal, planes.normal, i);
        stored(geometric, planes.geometric, i);
    }
}

void findEdgesLanes(const Tile& tile, const View& view, const Hits& hits, const SurfacePlanes& planes,
                    std::array<std::uint64_t, Tile::side>& rows) {
    const Float d;
    const FloatV zero = hn::Zero(d);
    const PatchRule rule(view);
    const std::size_t lanes = hn::Lanes(d);
    rows.fill(0);
    struct Neighbour {
        std::ptrdiff_t offset;
        bool in_picture;
    };
    for (int y = 0; y < tile.height; ++y) {
        // Those to the left and to the right are looked at with their own columns below.
        const Neighbour neighbours[] = {
            {-Tile::stride, tile.top + y > 0}, {Tile::stride, tile.top + y + 1 < view.height}, {-1, true}, {1, true}};
        for (int x = 0; x < tile.width; x += static_cast<int>(lanes)) {
            const std::size_t here = Tile::at(x + 1, y + 1);
            const FloatV near = hn::LoadU(d, &hits.inverse_depth[here]);
            const auto hit = hn::Gt(near, zero);
            const Vectors position = loaded(planes.position, here), normal = loaded(planes.normal, here),
                          geometric = loaded(planes.geometric, here);
            for (const Neighbour& neighbour : neighbours) {
                if (!neighbour.in_picture) continue;
                const std::size_t there = here + static_cast<std::size_t>(neighbour.offset);
                const FloatV other = hn::LoadU(d, &hits.inverse_depth[there]);
                const auto hit_there = hn::Gt(other, zero);
                auto differs = hn::Xor(hit, hit_there);
                const auto both = hn::And(hit, hit_there);
                if (!hn::AllFalse(d, both)) {
                    const FloatV turn = dotOf(normal, loaded(planes.normal, there));
                    const FloatV step = dotOf(geometric, sub(loaded(planes.position, there), position));
                    const auto same =
                        hn::And(hn::Gt(turn, hn::Set(d, PatchRule::crease_cosine)),
                                hn::Lt(hn::Mul(hn::Abs(step), hn::Max(near, other)), hn::Set(d, rule.largest_step)));
                    differs = hn::Or(differs, hn::AndNot(same, both));
                }
                std::uint64_t bits = 0;
                hn::StoreMaskBits(d, differs, reinterpret_cast<std::uint8_t*>(&bits));
                if (neighbour.offset == -1 && tile.left + x == 0) bits &= ~std::uint64_t{1};
                if (neighbour.offset == 1 && tile.left + tile.width == view.width &&
                    x + static_cast<int>(lanes) >= tile.width)
                    bits &= ~(std::uint64_t{1} << (tile.width - 1 - x));
                rows[static_cast<std::size_t>(y)] |= bits << x;
            }
        }
        if (tile.width < Tile::side) rows[static_cast<std::size_t>(y)] &= (std::uint64_t{1} << tile.width) - 1;
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(surfaceAtLanes);
HWY_EXPORT(findEdgesLanes);

void SurfacePlanes::resize(std::size_t count) {
    for (auto* planes : {&position, &normal, &geometric})
        for (std::vector<float>& plane : *planes) plane.resize(count);
}

void surfaceAt(const Mesh& mesh, const View& view, const Hits& hits, std::size_t count, SurfacePlanes& planes) {
    HWY_DYNAMIC_DISPATCH(surfaceAtLanes)(mesh, view, hits, count, planes);
}

void findEdges(const Tile& tile, const View& view, const Hits& hits, const SurfacePlanes& planes,
               std::array<std::uint64_t, Tile::side>& rows) {
    HWY_DYNAMIC_DISPATCH(findEdgesLanes)(tile, view, hits, planes, rows);
}

}  // namespace searchlight
#endif
