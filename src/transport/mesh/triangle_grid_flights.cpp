// Flights against a TriangleGrid, per instruction set: many flights pass through the cells at once, a flight to a lane,
// which lists the pairs of a flight and a cell that holds triangles; then pair after pair is tested, a triangle to a
// lane. Between the two the memory is asked for the triangles.
#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <limits>

#include "transport/mesh/triangle_grid.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/mesh/triangle_grid_flights.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>

#include "transport/walk/lane_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

constexpr std::size_t kMostFlights = 64;  // at once
constexpr std::size_t kPairs = 256;

// A lane per triangle of a block.
using Corner = hn::CappedTag<float, TriangleGrid::kBlock>;
using CornerV = hn::Vec<Corner>;
struct CornerVec {
    CornerV x, y, z;
};

HWY_INLINE CornerVec operator-(const CornerVec& a, const CornerVec& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE CornerVec operator+(const CornerVec& a, const CornerVec& b) {
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE CornerV inner(const CornerVec& a, const CornerVec& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
// Changes sign exactly when a does, whatever is rounded.
HWY_INLINE CornerVec outer(const CornerVec& a, const CornerVec& b) {
    return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
            hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

class FlightTest {
public:
    FlightTest(const TriangleGrid& grid, const Ray* flights, std::size_t count, RayHit* hits)
        : grid_(grid), flights_(flights), hits_(hits), count_(count) {}

    void run() {
        const Float d;
        const std::size_t width = hn::Lanes(d);
        for (std::size_t i = 0; i < count_; ++i) {
            const Ray& f = flights_[i];
            ox_[i] = f.origin.x, oy_[i] = f.origin.y, oz_[i] = f.origin.z;
            dx_[i] = f.t_max * f.direction.x, dy_[i] = f.t_max * f.direction.y, dz_[i] = f.t_max * f.direction.z;
            hits_[i] = {std::numeric_limits<float>::infinity()};
        }
        // The last vector is filled with its last flight, which then counts as one that has ended.
        for (std::size_t i = count_; i % width != 0; ++i) {
            ox_[i] = ox_[count_ - 1], oy_[i] = oy_[count_ - 1], oz_[i] = oz_[count_ - 1];
            dx_[i] = dx_[count_ - 1], dy_[i] = dy_[count_ - 1], dz_[i] = dz_[count_ - 1];
        }
        for (std::size_t at = 0; at < count_; at += width) pass(at);
        test();
    }

private:
    // How far the flights of a vector are along one axis, in cells.
    struct Axis {
        FloatV from, inverse, next, step, t;
        IntV cell, cell_step;

        HWY_INLINE Axis(const float* origins, const float* along, float low, float per_cell) {
            const Float d;
            const Int di;
            const FloatV scale = hn::Set(d, per_cell), zero = hn::Zero(d), one = hn::Set(d, 1.0f);
            const FloatV length = hn::Mul(hn::Load(d, along), scale);
            from = hn::Mul(hn::Sub(hn::Load(d, origins), hn::Set(d, low)), scale);
            // What does not move along the axis reaches no boundary.
            const FloatM still = hn::Lt(hn::Abs(length), hn::Set(d, 1e-30f));
            inverse = hn::Div(one, hn::IfThenElse(still, hn::Set(d, 1e-30f), length));
            const FloatM down = hn::Lt(inverse, zero);
            cell = hn::ConvertTo(di, from);  // not below 0
            cell_step = hn::IfThenElse(hn::RebindMask(di, down), hn::Set(di, -1), hn::Set(di, 1));
            step = hn::IfThenElse(down, hn::Set(d, -1.0f), one);
            next = hn::Add(hn::ConvertTo(d, cell), hn::IfThenZeroElse(down, one));
            t = hn::Mul(hn::Sub(next, from), inverse);
        }

        HWY_INLINE void stepWhere(FloatM where) {
            cell = hn::Add(cell, hn::IfThenElseZero(hn::RebindMask(Int(), where), cell_step));
            next = hn::Add(next, hn::IfThenElseZero(where, step));
            t = hn::Mul(hn::Sub(next, from), inverse);  // from the boundary itself: rounding does not add up
        }
    };

    static HWY_INLINE std::uint64_t bits(FloatM mask) {
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(Float(), mask, bytes);
        return bytes[0] | static_cast<std::uint64_t>(bytes[1]) << 8;
    }

    // Lists the cells with triangles that the flights of a vector pass, each flight's in its order.
    HWY_INLINE void pass(std::size_t at) {
        const Float d;
        const Int di;
        const std::size_t width = hn::Lanes(d);
        const float per_cell = 1 / grid_.cell_mm;
        Axis x(ox_ + at, dx_ + at, grid_.origin.x, per_cell), y(oy_ + at, dy_ + at, grid_.origin.y, per_cell),
            z(oz_ + at, dz_ + at, grid_.origin.z, per_cell);
        const IntV bricks_x = hn::Set(di, grid_.nx >> 2), bricks_y = hn::Set(di, grid_.ny >> 2), three = hn::Set(di, 3);
        FloatM going = hn::FirstN(d, count_ - at);
        FloatV begin = hn::Zero(d);
        const auto* const table = reinterpret_cast<const std::int32_t*>(grid_.bricks.data());
        HWY_ALIGN std::int32_t bricks[16], cells[16];
        HWY_ALIGN float begins[16];
        for (;;) {
            const IntV brick = hn::Add(
                hn::ShiftRight<2>(x.cell),
                hn::Mul(bricks_x, hn::Add(hn::ShiftRight<2>(y.cell), hn::Mul(bricks_y, hn::ShiftRight<2>(z.cell)))));
            const IntV within = hn::Or(hn::And(x.cell, three), hn::Or(hn::ShiftLeft<2>(hn::And(y.cell, three)),
                                                                      hn::ShiftLeft<4>(hn::And(z.cell, three))));
            static_assert(sizeof(TriangleGrid::Brick) == 4 * sizeof(std::int32_t));
            // The half of the brick's bits that holds the cell's.
            const IntV word = hn::Or(hn::ShiftLeft<2>(brick), hn::ShiftRight<5>(within));
            const IntV half = hn::GatherIndex(di, table, hn::IfThenElseZero(hn::RebindMask(di, going), word));
            const IntV bit = hn::Shl(hn::Set(di, 1), hn::And(within, hn::Set(di, 31)));
            const FloatM full = hn::And(going, hn::RebindMask(d, hn::Ne(hn::And(half, bit), hn::Zero(di))));
            if (std::uint64_t set = bits(full); set != 0) {
                hn::Store(brick, di, bricks);
                hn::Store(within, di, cells);
                hn::Store(begin, d, begins);
                if (pairs_ + width > kPairs) test();
                for (; set != 0; set &= set - 1) {
                    const auto lane = static_cast<std::size_t>(std::countr_zero(set));
                    list_[pairs_++] = {static_cast<std::uint32_t>(at + lane), static_cast<std::uint32_t>(bricks[lane]),
                                       static_cast<std::uint32_t>(cells[lane]), begins[lane]};
                }
            }
            begin = hn::Min(x.t, hn::Min(y.t, z.t));
            going = hn::And(going, hn::Lt(begin, hn::Set(d, 1.0f)));
            if (hn::AllFalse(d, going)) return;
            const FloatM by_x = hn::Eq(x.t, begin), by_y = hn::AndNot(by_x, hn::Eq(y.t, begin));
            x.stepWhere(by_x);
            y.stepWhere(by_y);
            z.stepWhere(hn::Not(hn::Or(by_x, by_y)));
        }
    }

    // Tests the listed pairs.
    HWY_NOINLINE void test() {
        // Reads that wait for none of the others, before all that do.
        for (std::size_t i = 0; i < pairs_; ++i) {
            Pair& pair = list_[i];
            pair.block = grid_.first[grid_.bricks[pair.block].placeOf(pair.cell)];
            const auto* line = reinterpret_cast<const char*>(&grid_.blocks[pair.block]);
            for (std::size_t at = 0; at < sizeof(TriangleGrid::Block); at += 64) hwy::Prefetch(line + at);
        }
        for (std::size_t i = 0; i < pairs_; ++i) {
            const Pair& pair = list_[i];
            // What a flight has met before the cell begins is nearer than what the cell holds.
            if (hits_[pair.flight].t < pair.begin) continue;
            for (const TriangleGrid::Block* block = &grid_.blocks[pair.block];; ++block) {
                test(pair.flight, *block);
                if ((block->triangles[0] & TriangleGrid::kLast) != 0) break;
            }
        }
        pairs_ = 0;
    }

    // A line passes through a triangle when it passes all edges on the same side; the side of an edge, the volume of
    // the edge and the line, is the same but for its sign from both of its triangles, so that nothing slips between.
    HWY_INLINE void test(std::uint32_t flight, const TriangleGrid::Block& block) {
        const Corner d;
        const std::size_t width = hn::Lanes(d);
        const CornerVec origin{hn::Set(d, ox_[flight]), hn::Set(d, oy_[flight]), hn::Set(d, oz_[flight])};
        const CornerVec along{hn::Set(d, dx_[flight]), hn::Set(d, dy_[flight]), hn::Set(d, dz_[flight])};
        for (std::size_t i = 0; i < TriangleGrid::kBlock; i += width) {
            const auto corner = [&](std::size_t which) {
                const float(*c)[TriangleGrid::kBlock] = block.corners + 3 * which;
                return CornerVec{hn::Load(d, c[0] + i), hn::Load(d, c[1] + i), hn::Load(d, c[2] + i)} - origin;
            };
            const CornerVec a = corner(0), b = corner(1), c = corner(2);
            const CornerVec e0 = c - a, e1 = a - b, e2 = b - c;
            const CornerV u = inner(outer(e0, c + a), along), v = inner(outer(e1, a + b), along),
                          w = inner(outer(e2, b + c), along);
            const CornerV least = hn::Min(u, hn::Min(v, w)), most = hn::Max(u, hn::Max(v, w)), zero = hn::Zero(d);
            // The rounding of three sides that all but vanish, at a vertex, is let through, as Embree does.
            const CornerV slack = hn::Mul(hn::Set(d, 0x1p-23f), hn::Abs(hn::Add(u, hn::Add(v, w))));
            const auto through = hn::Or(hn::Ge(least, hn::Neg(slack)), hn::Le(most, slack));
            if (hn::AllFalse(d, through)) continue;
            const CornerVec normal = outer(e0, e1);
            const CornerV t = hn::Div(inner(a, normal), inner(along, normal));
            const auto met = hn::And(through, hn::And(hn::Gt(t, zero), hn::Le(t, hn::Set(d, 1.0f))));
            if (hn::AllFalse(d, met)) continue;
            std::uint8_t bytes[8] = {};
            hn::StoreMaskBits(d, met, bytes);
            HWY_ALIGN float ts[TriangleGrid::kBlock], us[TriangleGrid::kBlock], vs[TriangleGrid::kBlock],
                ws[TriangleGrid::kBlock];
            hn::Store(t, d, ts), hn::Store(u, d, us), hn::Store(v, d, vs), hn::Store(w, d, ws);
            RayHit& hit = hits_[flight];
            for (unsigned set = bytes[0]; set != 0; set &= set - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(set));
                if (!(ts[lane] < hit.t)) continue;
                const float sum = us[lane] + vs[lane] + ws[lane], scale = sum != 0 ? 1 / sum : 0;
                hit.t = ts[lane];
                hit.triangle = block.triangles[i + lane] & ~TriangleGrid::kLast;
                const auto place = [&](std::size_t which) {
                    return Vec3{block.corners[3 * which][i + lane], block.corners[3 * which + 1][i + lane],
                                block.corners[3 * which + 2][i + lane]};
                };
                const Vec3 first = place(0);
                hit.normal = toFloat(normalize(searchlight::cross(place(1) - first, place(2) - first)));
                hit.u = std::clamp(us[lane] * scale, 0.0f, 1.0f), hit.v = std::clamp(vs[lane] * scale, 0.0f, 1.0f);
            }
        }
    }

    struct Pair {
        std::uint32_t flight;
        std::uint32_t block;  // first of the cell; its brick, until they are tested
        std::uint32_t cell;   // in the brick
        float begin;          // where the flight enters it
    };

    const TriangleGrid& grid_;
    const Ray* flights_;
    RayHit* hits_;
    std::size_t count_, pairs_ = 0;
    // In multiples of t_max.
    alignas(64) float ox_[kMostFlights], oy_[kMostFlights], oz_[kMostFlights];
    alignas(64) float dx_[kMostFlights], dy_[kMostFlights], dz_[kMostFlights];
    Pair list_[kPairs];
};

void intersectGrid(const TriangleGrid& grid, const Ray* flights, std::size_t count, RayHit* hits) {
    for (std::size_t first = 0; first < count; first += kMostFlights) {
        const std::size_t now = std::min(kMostFlights, count - first);
        FlightTest(grid, flights + first, now, hits + first).run();
        for (std::size_t i = first; i < first + now; ++i) hits[i].t *= flights[i].t_max;
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(intersectGrid);

void TriangleGrid::intersect(std::span<const Ray> flights, std::span<RayHit> hits) const {
    assert(flights.size() == hits.size());
    HWY_DYNAMIC_DISPATCH(intersectGrid)(*this, flights.data(), flights.size(), hits.data());
}

}  // namespace searchlight
#endif
