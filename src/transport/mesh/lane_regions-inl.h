// The safe regions that walks on lanes are in: around a sphere's middle, and of a mesh. Included once per instruction
// set.
#if defined(SEARCHLIGHT_TRANSPORT_LANE_REGIONS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_LANE_REGIONS_INL_H_
#undef SEARCHLIGHT_TRANSPORT_LANE_REGIONS_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_LANE_REGIONS_INL_H_
#endif

#include <hwy/cache_control.h>

#include "transport/mesh/closed_body.h"
#include "transport/walk/lane_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

constexpr std::size_t kPlanes = SafeRegion::kPlanes;

// A convex region without surface: a ball cut by planes.
struct Region {
    struct Plane {
        FloatV nx, ny, nz, offset;  // normal . (position - middle) is below offset
    };

    FloatV x, y, z, square;  // middle of the ball, and square of its radius
    Plane planes[kPlanes];

    // Square of the distance from the middle.
    HWY_INLINE FloatV away(FloatV px, FloatV py, FloatV pz) const {
        const FloatV dx = hn::Sub(px, x), dy = hn::Sub(py, y), dz = hn::Sub(pz, z);
        return hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    }

    HWY_INLINE FloatM holds(FloatV px, FloatV py, FloatV pz) const {
        const FloatV dx = hn::Sub(px, x), dy = hn::Sub(py, y), dz = hn::Sub(pz, z);
        FloatM inside = hn::Lt(away(px, py, pz), square);
        for (const Plane& p : planes)
            inside = hn::And(inside, hn::Lt(hn::MulAdd(p.nx, dx, hn::MulAdd(p.ny, dy, hn::Mul(p.nz, dz))), p.offset));
        return inside;
    }

    // How far along (dx, dy, dz) from a point that it holds the region reaches.
    HWY_INLINE FloatV reaches(FloatV px, FloatV py, FloatV pz, FloatV dx, FloatV dy, FloatV dz) const {
        const Float d;
        const auto inner = [](FloatV ax, FloatV ay, FloatV az, FloatV bx, FloatV by, FloatV bz) {
            return hn::MulAdd(ax, bx, hn::MulAdd(ay, by, hn::Mul(az, bz)));
        };
        const FloatV fx = hn::Sub(px, x), fy = hn::Sub(py, y), fz = hn::Sub(pz, z);
        const FloatV a = inner(dx, dy, dz, dx, dy, dz), b = inner(fx, fy, fz, dx, dy, dz);
        const FloatV rest = hn::Max(hn::Sub(square, inner(fx, fy, fz, fx, fy, fz)), hn::Zero(d));
        FloatV reach = hn::Div(hn::Sub(hn::Sqrt(hn::MulAdd(a, rest, hn::Mul(b, b))), b), a);
        for (const Plane& p : planes) {
            const FloatV up = inner(p.nx, p.ny, p.nz, dx, dy, dz);
            const FloatV plane = hn::Div(hn::Sub(p.offset, inner(p.nx, p.ny, p.nz, fx, fy, fz)), up);
            reach = hn::IfThenElse(hn::Gt(up, hn::Zero(d)), hn::Min(reach, plane), reach);
        }
        return reach;
    }
};

// Of each lane the region that its walk is in; a square of 0 where none is known.
struct alignas(64) LaneRegions {
    struct Plane {
        float nx[kLanes], ny[kLanes], nz[kLanes], offset[kLanes];
    };

    float x[kLanes], y[kLanes], z[kLanes], square[kLanes];
    Plane planes[kPlanes];
    float deep[kLanes];  // square of the distance from the middle up to which a large step fits into the ball

    HWY_INLINE Region load(std::size_t at) const {
        const Float d;
        Region region{hn::Load(d, x + at), hn::Load(d, y + at), hn::Load(d, z + at), hn::Load(d, square + at), {}};
        for (std::size_t i = 0; i < kPlanes; ++i)
            region.planes[i] = {hn::Load(d, planes[i].nx + at), hn::Load(d, planes[i].ny + at),
                                hn::Load(d, planes[i].nz + at), hn::Load(d, planes[i].offset + at)};
        return region;
    }
    // `least`: radius of the smallest large step. There is none where a plane cuts the ball.
    HWY_INLINE void scatter(const Region& r, IntV lanes, FloatV least) {
        const Float d;
        const FloatV inner = hn::Max(hn::Sub(hn::Sqrt(r.square), least), hn::Zero(d)), zero = hn::Zero(d);
        // The first plane is there when any is.
        const Region::Plane& first = r.planes[0];
        const FloatM cut = hn::Or(hn::Ne(first.nx, zero), hn::Or(hn::Ne(first.ny, zero), hn::Ne(first.nz, zero)));
        hn::ScatterIndex(hn::IfThenZeroElse(cut, hn::Mul(inner, inner)), d, deep, lanes);
        hn::ScatterIndex(r.x, d, x, lanes), hn::ScatterIndex(r.y, d, y, lanes), hn::ScatterIndex(r.z, d, z, lanes);
        for (std::size_t i = 0; i < kPlanes; ++i) {
            hn::ScatterIndex(r.planes[i].nx, d, planes[i].nx, lanes);
            hn::ScatterIndex(r.planes[i].ny, d, planes[i].ny, lanes);
            hn::ScatterIndex(r.planes[i].nz, d, planes[i].nz, lanes);
            hn::ScatterIndex(r.planes[i].offset, d, planes[i].offset, lanes);
        }
        hn::ScatterIndex(r.square, d, square, lanes);
    }
};

// The region of a ball: itself.
class BallRegions {
public:
    static constexpr bool kLooksUp = false;

    explicit BallRegions(const Ball& ball) : square_(static_cast<float>(ball.radius() * ball.radius())) {}
    float first() const { return square_; }

private:
    float square_;
};

class MeshRegions {
public:
    static constexpr bool kLooksUp = true;

    explicit MeshRegions(const MeshBody& mesh)
        : regions_(mesh.regions()),
          table_(reinterpret_cast<const std::int32_t*>(regions_.cells.data())),
          cuts_(reinterpret_cast<const std::int32_t*>(regions_.regions.data())),
          per_cell_(1 / regions_.cell_mm) {
        const double step = static_cast<double>(regions_.cell_mm) / SafeRegion::kSteps;
        step_ = static_cast<float>(step);
        height_step_ = static_cast<float>(CutBall::kNormal * step);
    }

    // What a walk starts with: nothing is known.
    float first() const { return 0; }
    bool tabulated() const { return table_ != nullptr; }

    // Of the cell that a point is in, what is needed to find its region: asks the memory for it.
    HWY_INLINE IntV seek(FloatV px, FloatV py, FloatV pz) const {
        const IntV place = placeOf(cellsOf(px, py, pz));
        fetch(table_, place, 1);
        return place;
    }
    // The same for the region itself.
    HWY_INLINE IntV seekRegion(IntV place) const {
        const IntV entry = hn::GatherIndex(Int(), table_, place);
        fetch(cuts_, entry, kWords);
        return entry;
    }

    // Of the cell that a point is in, which was sought; of one beyond the grid a region that does not hold it.
    HWY_INLINE Region at(FloatV px, FloatV py, FloatV pz, IntV entry) const {
        const Float d;
        const Int di;
        const auto [x, y, z] = cellsOf(px, py, pz);
        const auto middle = [&](IntV of, float low) {
            const FloatV place = hn::Add(hn::ConvertTo(d, of), hn::Set(d, 0.5f));
            return hn::MulAdd(place, hn::Set(d, regions_.cell_mm), hn::Set(d, low));
        };
        const auto component = [&](IntV bits) { return hn::ConvertTo(d, hn::ShiftRight<22>(bits)); };
        const auto is_cut = hn::Lt(entry, hn::Zero(di));
        // Of a ball that is not cut the first region's planes, which cut nothing.
        const IntV cut =
            hn::IfThenElseZero(is_cut, hn::Mul(hn::And(entry, hn::Set(di, 0x7FFF'FFFF)), hn::Set(di, kWords)));
        const auto word = [&](std::size_t i) { return hn::GatherIndex(di, cuts_ + i, cut); };
        const FloatV radius =
            hn::Mul(hn::ConvertTo(d, hn::IfThenElse(is_cut, word(kPlanes + kPlanes / 2), entry)), hn::Set(d, step_));
        Region region{middle(x, regions_.origin.x),
                      middle(y, regions_.origin.y),
                      middle(z, regions_.origin.z),
                      hn::Mul(radius, radius),
                      {}};
        IntV pair = hn::Zero(di);
        for (std::size_t i = 0; i < kPlanes; ++i) {
            const IntV normal = word(i);
            if (i % 2 == 0) pair = word(kPlanes + i / 2);
            const IntV offset = hn::ShiftRight<16>(i % 2 == 0 ? hn::ShiftLeft<16>(pair) : pair);
            region.planes[i] = {component(normal), component(hn::ShiftLeft<10>(normal)),
                                component(hn::ShiftLeft<20>(normal)),
                                hn::Mul(hn::ConvertTo(d, offset), hn::Set(d, height_step_))};
        }
        return region;
    }

private:
    static constexpr std::int32_t kWords = sizeof(SafeRegion) / sizeof(std::int32_t);

    static HWY_INLINE void fetch(const std::int32_t* from, IntV places, std::int32_t words) {
        const Int di;
        HWY_ALIGN std::int32_t list[16];
        hn::Store(places, di, list);
        for (std::size_t i = 0; i < hn::Lanes(di); ++i)
            hwy::Prefetch(from + static_cast<std::uint32_t>(words) * static_cast<std::uint32_t>(list[i] & 0x7FFF'FFFF));
    }

    struct Cells {
        IntV x, y, z;
    };

    HWY_INLINE Cells cellsOf(FloatV px, FloatV py, FloatV pz) const {
        const Float d;
        const auto cell = [&](FloatV position, float low, std::int32_t n) {
            const FloatV place = hn::Mul(hn::Sub(position, hn::Set(d, low)), hn::Set(d, per_cell_));
            const FloatV last = hn::Set(d, static_cast<float>(n - 1));
            return hn::ConvertTo(Int(), hn::Min(hn::Max(place, hn::Zero(d)), last));
        };
        return {cell(px, regions_.origin.x, regions_.nx), cell(py, regions_.origin.y, regions_.ny),
                cell(pz, regions_.origin.z, regions_.nz)};
    }

    // Of the cells' regions in the table.
    HWY_INLINE IntV placeOf(const Cells& cells) const {
        const Int di;
        const auto brick = [&](IntV of, std::int32_t n, IntV rest) {
            return hn::Add(hn::Mul(rest, hn::Set(di, n >> 3)), hn::ShiftRight<3>(of));
        };
        const IntV seven = hn::Set(di, 7);
        const IntV within = hn::Or(hn::And(cells.x, seven), hn::Or(hn::ShiftLeft<3>(hn::And(cells.y, seven)),
                                                                   hn::ShiftLeft<6>(hn::And(cells.z, seven))));
        const IntV bricks = brick(cells.x, regions_.nx, brick(cells.y, regions_.ny, hn::ShiftRight<3>(cells.z)));
        return hn::Or(hn::ShiftLeft<9>(bricks), within);
    }

    const SafeRegions& regions_;
    const std::int32_t *table_, *cuts_;
    float per_cell_, step_, height_step_;
};

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
