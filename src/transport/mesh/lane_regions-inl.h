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

// A convex region without surface: a ball cut by a plane.
struct Region {
    FloatV x, y, z, square;     // middle of the ball, and square of its radius
    FloatV nx, ny, nz, offset;  // normal . (position - middle) is below offset

    // Square of the distance from the middle.
    HWY_INLINE FloatV away(FloatV px, FloatV py, FloatV pz) const {
        const FloatV dx = hn::Sub(px, x), dy = hn::Sub(py, y), dz = hn::Sub(pz, z);
        return hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    }

    HWY_INLINE FloatM holds(FloatV px, FloatV py, FloatV pz) const {
        const FloatV dx = hn::Sub(px, x), dy = hn::Sub(py, y), dz = hn::Sub(pz, z);
        const FloatV height = hn::MulAdd(nx, dx, hn::MulAdd(ny, dy, hn::Mul(nz, dz)));
        return hn::And(hn::Lt(away(px, py, pz), square), hn::Lt(height, offset));
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
        const FloatV ball = hn::Div(hn::Sub(hn::Sqrt(hn::MulAdd(a, rest, hn::Mul(b, b))), b), a);
        const FloatV up = inner(nx, ny, nz, dx, dy, dz);
        const FloatV plane = hn::Div(hn::Sub(offset, inner(nx, ny, nz, fx, fy, fz)), up);
        return hn::IfThenElse(hn::Gt(up, hn::Zero(d)), hn::Min(ball, plane), ball);
    }
};

// Of each lane the region that its walk is in; a square of 0 where none is known.
struct alignas(64) LaneRegions {
    float x[kLanes], y[kLanes], z[kLanes], square[kLanes];
    float nx[kLanes], ny[kLanes], nz[kLanes], offset[kLanes];
    float deep[kLanes];  // square of the distance from the middle up to which a large step fits into the ball

    HWY_INLINE Region load(std::size_t at) const {
        const Float d;
        return {hn::Load(d, x + at),  hn::Load(d, y + at),  hn::Load(d, z + at),  hn::Load(d, square + at),
                hn::Load(d, nx + at), hn::Load(d, ny + at), hn::Load(d, nz + at), hn::Load(d, offset + at)};
    }
    // `least`: radius of the smallest large step. There is none where a plane cuts the ball.
    HWY_INLINE void scatter(const Region& r, IntV lanes, FloatV least) {
        const Float d;
        const FloatV inner = hn::Max(hn::Sub(hn::Sqrt(r.square), least), hn::Zero(d));
        const FloatM cut =
            hn::Or(hn::Ne(r.nx, hn::Zero(d)), hn::Or(hn::Ne(r.ny, hn::Zero(d)), hn::Ne(r.nz, hn::Zero(d))));
        hn::ScatterIndex(hn::IfThenZeroElse(cut, hn::Mul(inner, inner)), d, deep, lanes);
        hn::ScatterIndex(r.x, d, x, lanes), hn::ScatterIndex(r.y, d, y, lanes), hn::ScatterIndex(r.z, d, z, lanes);
        hn::ScatterIndex(r.nx, d, nx, lanes), hn::ScatterIndex(r.ny, d, ny, lanes);
        hn::ScatterIndex(r.nz, d, nz, lanes), hn::ScatterIndex(r.offset, d, offset, lanes);
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
          table_(reinterpret_cast<const std::int32_t*>(regions_.regions.data())),
          per_cell_(1 / regions_.cell_mm) {
        const double step = static_cast<double>(regions_.cell_mm) / SafeRegion::kSteps;
        step_ = static_cast<float>(step);
        height_step_ = static_cast<float>(SafeRegion::kNormal * step);
    }

    // What a walk starts with: nothing is known.
    float first() const { return 0; }
    bool tabulated() const { return table_ != nullptr; }

    // Asks the memory for what at() will need.
    HWY_INLINE void fetch(FloatV px, FloatV py, FloatV pz, std::size_t count) const {
        const Int di;
        HWY_ALIGN std::int32_t places[16];
        hn::Store(placeOf(cellsOf(px, py, pz)), di, places);
        for (std::size_t i = 0; i < count; ++i) hwy::Prefetch(table_ + places[i]);
    }

    // Of the cell that a point is in; of one beyond the grid a region that does not hold it.
    HWY_INLINE Region at(FloatV px, FloatV py, FloatV pz) const {
        const Float d;
        const Int di;
        const auto [x, y, z] = cellsOf(px, py, pz);
        const IntV first = placeOf({x, y, z});
        const IntV normal = hn::GatherIndex(di, table_, first), lengths = hn::GatherIndex(di, table_ + 1, first);
        const auto middle = [&](IntV of, float low) {
            const FloatV place = hn::Add(hn::ConvertTo(d, of), hn::Set(d, 0.5f));
            return hn::MulAdd(place, hn::Set(d, regions_.cell_mm), hn::Set(d, low));
        };
        const auto component = [&](IntV bits) { return hn::ConvertTo(d, hn::ShiftRight<22>(bits)); };
        const FloatV radius = hn::Mul(hn::ConvertTo(d, hn::And(lengths, hn::Set(di, 0xFFFF))), hn::Set(d, step_));
        return {middle(x, regions_.origin.x),
                middle(y, regions_.origin.y),
                middle(z, regions_.origin.z),
                hn::Mul(radius, radius),
                component(normal),
                component(hn::ShiftLeft<10>(normal)),
                component(hn::ShiftLeft<20>(normal)),
                hn::Mul(hn::ConvertTo(d, hn::ShiftRight<16>(lengths)), hn::Set(d, height_step_))};
    }

private:
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
        static_assert(sizeof(SafeRegion) == 2 * sizeof(std::int32_t));
        return hn::ShiftLeft<1>(hn::Or(hn::ShiftLeft<9>(bricks), within));
    }

    const SafeRegions& regions_;
    const std::int32_t* table_;
    float per_cell_, step_, height_step_;
};

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
