// Flights against a TriangleGrid, per instruction set: many flights pass through the cells at once, a flight to a lane,
// which lists the pairs of a flight and a cell that holds triangles; then pair after pair is tested, a triangle to a
// lane. Between the two the memory is asked for the triangles.
#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
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
    FlightTest(const TriangleGrid& grid, const Ray* flights, std::size_t count, RayHit* hits, Vec3* positions)
        : grid_(grid), flights_(flights), hits_(hits), positions_(positions), count_(count) {}

    void run() {
        const Float d;
        const std::size_t width = hn::Lanes(d);
        for (std::size_t i = 0; i < count_; ++i) {
            const Ray& f = flights_[i];
            ox_[i] = f.origin.x, oy_[i] = f.origin.y, oz_[i] = f.origin.z;
            dx_[i] = f.t_max * f.direction.x, dy_[i] = f.t_max * f.direction.y, dz_[i] = f.t_max * f.direction.z;
            begin_[i] = f.t_min / f.t_max;
            hits_[i] = {std::numeric_limits<float>::infinity()};
        }
        // The last vector is filled with its last flight, which then counts as one that has ended.
        for (std::size_t i = count_; i % width != 0; ++i) {
            ox_[i] = ox_[count_ - 1], oy_[i] = oy_[count_ - 1], oz_[i] = oz_[count_ - 1];
            dx_[i] = dx_[count_ - 1], dy_[i] = dy_[count_ - 1], dz_[i] = dz_[count_ - 1];
            begin_[i] = begin_[count_ - 1];
        }
        for (std::size_t at = 0; at < count_; at += width) pass(at);
        test();
        for (std::size_t i = 0; i < count_; ++i)
            if (std::isfinite(hits_[i].t)) finish(i);
    }

private:
    // How far the flights of a vector are along one axis, in cells.
    struct Axis {
        FloatV from, inverse, next, step, t;
        IntV cell, cell_step;

        HWY_INLINE Axis(const float* origins, const float* along, FloatV begin, float low, float per_cell,
                        std::int32_t n) {
            const Float d;
            const Int di;
            const FloatV scale = hn::Set(d, per_cell), zero = hn::Zero(d), one = hn::Set(d, 1.0f);
            const FloatV length = hn::Mul(hn::Load(d, along), scale);
            from = hn::Mul(hn::Sub(hn::Load(d, origins), hn::Set(d, low)), scale);
            // What does not move along the axis reaches no boundary.
            const FloatM still = hn::Lt(hn::Abs(length), hn::Set(d, 1e-30f));
            inverse = hn::Div(one, hn::IfThenElse(still, hn::Set(d, 1e-30f), length));
            const FloatM down = hn::Lt(inverse, zero);
            // A flight that begins beyond the grid is led along the cells at its side, until it comes or is seen to
            // leave.
            cell = hn::ConvertTo(di, hn::MulAdd(begin, length, from));
            cell = hn::Min(hn::Max(cell, hn::Zero(di)), hn::Set(di, n - 1));
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
        FloatV begin = hn::Load(d, begin_ + at);
        Axis x(ox_ + at, dx_ + at, begin, grid_.origin.x, per_cell, grid_.nx),
            y(oy_ + at, dy_ + at, begin, grid_.origin.y, per_cell, grid_.ny),
            z(oz_ + at, dz_ + at, begin, grid_.origin.z, per_cell, grid_.nz);
        const IntV bricks_x = hn::Set(di, grid_.nx >> 2), bricks_y = hn::Set(di, grid_.ny >> 2), three = hn::Set(di, 3);
        FloatM going = hn::FirstN(d, count_ - at);
        const auto* const table = reinterpret_cast<const std::int32_t*>(grid_.bricks.data());
        HWY_ALIGN std::int32_t bricks[16], cells[16];
        HWY_ALIGN float begins[16], ends[16];
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
            const FloatV next = hn::Min(x.t, hn::Min(y.t, z.t));
            if (std::uint64_t set = bits(full); set != 0) {
                hn::Store(brick, di, bricks);
                hn::Store(within, di, cells);
                hn::Store(begin, d, begins);
                hn::Store(next, d, ends);
                if (pairs_ + width > kPairs) test();
                for (; set != 0; set &= set - 1) {
                    const auto lane = static_cast<std::size_t>(std::countr_zero(set));
                    pair_flights_[pairs_] = static_cast<std::int32_t>(at + lane);
                    pair_cells_[pairs_] =
                        static_cast<std::int32_t>(grid_.bricks[static_cast<std::size_t>(bricks[lane])].placeOf(
                            static_cast<unsigned>(cells[lane])));
                    hwy::Prefetch(&grid_.cells[static_cast<std::size_t>(pair_cells_[pairs_])]);
                    pair_begins_[pairs_] = begins[lane];
                    pair_ends_[pairs_++] = ends[lane];
                }
            }
            begin = next;
            going = hn::And(going, hn::Lt(begin, hn::Set(d, 1.0f)));
            if (hn::AllFalse(d, going)) return;
            const FloatM by_x = hn::Eq(x.t, begin), by_y = hn::AndNot(by_x, hn::Eq(y.t, begin));
            x.stepWhere(by_x);
            y.stepWhere(by_y);
            z.stepWhere(hn::Not(hn::Or(by_x, by_y)));
            // The mesh lies in the grid: what leaves it meets nothing more.
            const auto stays = [&](const Axis& axis, std::int32_t n) {
                return hn::And(hn::Gt(axis.cell, hn::Set(di, -1)), hn::Lt(axis.cell, hn::Set(di, n)));
            };
            const auto in_grid = hn::And(hn::And(stays(x, grid_.nx), stays(y, grid_.ny)), stays(z, grid_.nz));
            going = hn::And(going, hn::RebindMask(d, in_grid));
        }
    }

    // Tests the listed pairs.
    HWY_NOINLINE void test() {
        choose();
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

    // Keeps the pairs whose flights come up to the plane of the cell while they are in it, and asks the memory for
    // their triangles.
    HWY_INLINE void choose() {
        const Float d;
        const Int di;
        const std::size_t width = hn::Lanes(d), listed = pairs_;
        for (std::size_t i = listed; i % width != 0; ++i) {
            pair_flights_[i] = pair_flights_[listed - 1], pair_cells_[i] = pair_cells_[listed - 1];
            pair_begins_[i] = pair_ends_[i] = 0;
        }
        pairs_ = 0;
        static_assert(sizeof(TriangleGrid::Cell) == 4 * sizeof(std::int32_t));
        const auto* const cells = reinterpret_cast<const std::int32_t*>(grid_.cells.data());
        const auto* const leasts = reinterpret_cast<const float*>(grid_.cells.data());
        HWY_ALIGN std::int32_t blocks[16];
        for (std::size_t i = 0; i < listed; i += width) {
            const IntV flight = hn::Load(di, pair_flights_ + i), cell = hn::ShiftLeft<2>(hn::Load(di, pair_cells_ + i));
            const IntV normal = hn::GatherIndex(di, cells + 1, cell);
            const FloatV least = hn::GatherIndex(d, leasts + 2, cell);
            const auto component = [&](IntV bits) { return hn::ConvertTo(d, hn::ShiftRight<22>(bits)); };
            const FloatV nx = component(normal), ny = component(hn::ShiftLeft<10>(normal)),
                         nz = component(hn::ShiftLeft<20>(normal));
            const auto height = [&](const float* x, const float* y, const float* z) {
                return hn::MulAdd(
                    nx, hn::GatherIndex(d, x, flight),
                    hn::MulAdd(ny, hn::GatherIndex(d, y, flight), hn::Mul(nz, hn::GatherIndex(d, z, flight))));
            };
            const FloatV from = height(ox_, oy_, oz_), along = height(dx_, dy_, dz_);
            const FloatV begin = hn::Load(d, pair_begins_ + i),
                         end = hn::Min(hn::Load(d, pair_ends_ + i), hn::Set(d, 1.0f));
            const FloatV highest = hn::Max(hn::MulAdd(along, begin, from), hn::MulAdd(along, end, from));
            hn::Store(hn::GatherIndex(di, cells, cell), di, blocks);
            std::uint64_t set = bits(hn::And(hn::Ge(highest, least), hn::FirstN(d, listed - i)));
            for (; set != 0; set &= set - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(set));
                const auto block = static_cast<std::uint32_t>(blocks[lane]);
                list_[pairs_++] = {static_cast<std::uint32_t>(pair_flights_[i + lane]), block, pair_begins_[i + lane]};
                const auto* line = reinterpret_cast<const char*>(&grid_.blocks[block]);
                for (std::size_t at = 0; at < sizeof(TriangleGrid::Block); at += 64) hwy::Prefetch(line + at);
            }
        }
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
                met_[flight] = {&block, i + lane};
                hit.u = std::clamp(us[lane] * scale, 0.0f, 1.0f), hit.v = std::clamp(vs[lane] * scale, 0.0f, 1.0f);
            }
        }
    }

    // What is asked of the nearest hit alone.
    HWY_INLINE void finish(std::size_t flight) {
        const auto [block, lane] = met_[flight];
        const auto corner = [&, block = block, lane = lane](std::size_t which) {
            const float(*c)[TriangleGrid::kBlock] = block->corners + 3 * which;
            return Vec3{c[0][lane], c[1][lane], c[2][lane]};
        };
        RayHit& hit = hits_[flight];
        const Vec3 first = corner(0), to_second = corner(1) - first, to_third = corner(2) - first;
        hit.triangle = block->triangles[lane] & ~TriangleGrid::kLast;
        hit.normal = toFloat(normalize(searchlight::cross(to_second, to_third)));
        hit.t *= flights_[flight].t_max;
        positions_[flight] = first + static_cast<double>(hit.u) * to_second + static_cast<double>(hit.v) * to_third;
    }

    struct Met {
        const TriangleGrid::Block* block;
        std::size_t lane;
    };
    struct Pair {
        std::uint32_t flight;
        std::uint32_t block;  // first of the cell
        float begin;          // where the flight enters it
    };

    const TriangleGrid& grid_;
    const Ray* flights_;
    RayHit* hits_;
    Vec3* positions_;
    std::size_t count_, pairs_ = 0;
    // In multiples of t_max.
    alignas(64) float ox_[kMostFlights], oy_[kMostFlights], oz_[kMostFlights];
    alignas(64) float dx_[kMostFlights], dy_[kMostFlights], dz_[kMostFlights];
    alignas(64) float begin_[kMostFlights];  // where the flights may first meet something
    // Flights and the cells with triangles that they pass, from where to where; then those of them to be tested.
    alignas(64) std::int32_t pair_flights_[kPairs], pair_cells_[kPairs];
    alignas(64) float pair_begins_[kPairs], pair_ends_[kPairs];
    Pair list_[kPairs];
    Met met_[kMostFlights];
};

void intersectGrid(const TriangleGrid& grid, const Ray* flights, std::size_t count, RayHit* hits, Vec3* positions) {
    for (std::size_t first = 0; first < count; first += kMostFlights) {
        const std::size_t now = std::min(kMostFlights, count - first);
        FlightTest(grid, flights + first, now, hits + first, positions + first).run();
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(intersectGrid);

void TriangleGrid::intersect(std::span<const Ray> flights, std::span<RayHit> hits, std::span<Vec3> positions) const {
    assert(flights.size() == hits.size() && flights.size() == positions.size());
    HWY_DYNAMIC_DISPATCH(intersectGrid)(*this, flights.data(), flights.size(), hits.data(), positions.data());
}

}  // namespace searchlight
#endif
