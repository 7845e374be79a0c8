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

#include "transport/mesh/lane_list-inl.h"
#include "transport/walk/lane_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

constexpr std::size_t kPairs = 512;

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

// The difference of two products, which may be nearly the same.
HWY_INLINE FloatV crossed(FloatV a, FloatV b, FloatV c, FloatV d) {
    const FloatV rest = hn::Mul(c, d);
    return hn::Add(hn::MulSub(a, b, rest), hn::NegMulAdd(c, d, rest));
}

class FlightTest {
public:
    FlightTest(const TriangleGrid& grid, const Flights& flights) : grid_(grid), flights_(flights) {}

    void run() {
        const Float d;
        const std::size_t width = hn::Lanes(d);
        for (std::size_t at = 0; at < flights_.count; at += width) {
            hn::Store(hn::Set(d, std::numeric_limits<float>::infinity()), d, t_ + at);
            pass(at);
        }
        test();
    }

    // The nearest hit of one flight.
    bool hit(std::size_t flight, RayHit& hit, Vec3& position) const {
        hit = {t_[flight]};
        if (std::isinf(t_[flight])) return false;
        const auto [block, lane] = metBy(flight);
        const auto corner = [&, block = block, lane = lane](std::size_t i) { return toDouble(block->corner(lane, i)); };
        const Vec3 first = corner(0), to_second = corner(1) - first, to_third = corner(2) - first;
        hit.u = u_[flight], hit.v = v_[flight];
        hit.triangle = block->number(lane);
        hit.normal = toFloat(normalize(searchlight::cross(to_second, to_third)));
        position = first + static_cast<double>(hit.u) * to_second + static_cast<double>(hit.v) * to_third;
        return true;
    }

    // Those of all.
    void list(float nudge, FlightHits& hits) const {
        const Float d;
        const Int di;
        const std::size_t width = hn::Lanes(d);
        hits.count = 0;
        for (std::size_t at = 0; at < flights_.count; at += width) {
            const FloatM met = hn::And(hn::Lt(hn::Load(d, t_ + at), hn::Set(d, std::numeric_limits<float>::infinity())),
                                       hn::FirstN(d, flights_.count - at));
            const Listing listing(met);
            listing.append(hn::Iota(di, static_cast<std::int32_t>(at)), hits.flight + hits.count);
            hits.count += listing.count();
        }
        HWY_ALIGN float corners[9][16] = {};
        for (std::size_t at = 0; at < hits.count; at += width) {
            for (std::size_t i = 0; i < width && at + i < hits.count; ++i) {
                const auto flight = static_cast<std::size_t>(hits.flight[at + i]);
                const auto [block, lane] = metBy(flight);
                for (std::size_t k = 0; k < 3; ++k) {
                    const Vec3f p = block->corner(lane, k);
                    corners[3 * k][i] = p.x, corners[3 * k + 1][i] = p.y, corners[3 * k + 2][i] = p.z;
                }
                hits.triangle[at + i] = static_cast<std::int32_t>(block->number(lane));
                hits.u[at + i] = u_[flight], hits.v[at + i] = v_[flight];
            }
            const auto corner = [&](std::size_t i) { return hn::Load(d, corners[i]); };
            const FloatV ax = corner(0), ay = corner(1), az = corner(2);
            const FloatV bx = hn::Sub(corner(3), ax), by = hn::Sub(corner(4), ay), bz = hn::Sub(corner(5), az);
            const FloatV cx = hn::Sub(corner(6), ax), cy = hn::Sub(corner(7), ay), cz = hn::Sub(corner(8), az);
            const FloatV u = hn::Load(d, hits.u + at), v = hn::Load(d, hits.v + at);
            FloatV nx = crossed(by, cz, bz, cy), ny = crossed(bz, cx, bx, cz), nz = crossed(bx, cy, by, cx);
            // Of the largest component, so that no square vanishes.
            const FloatV largest = hn::Max(hn::Max(hn::Abs(nx), hn::Abs(ny)), hn::Max(hn::Abs(nz), hn::Set(d, 1e-37f)));
            nx = hn::Div(nx, largest), ny = hn::Div(ny, largest), nz = hn::Div(nz, largest);
            const FloatV length = hn::Sqrt(hn::MulAdd(nx, nx, hn::MulAdd(ny, ny, hn::Mul(nz, nz))));
            const FloatV inverse = hn::Div(hn::Set(d, 1.0f), hn::Max(length, hn::Set(d, 1e-37f)));
            nx = hn::Mul(nx, inverse), ny = hn::Mul(ny, inverse), nz = hn::Mul(nz, inverse);
            const FloatV x = hn::MulAdd(u, bx, hn::Mul(v, cx)), y = hn::MulAdd(u, by, hn::Mul(v, cy)),
                         z = hn::MulAdd(u, bz, hn::Mul(v, cz));
            const FloatV off = hn::Set(d, nudge);
            hn::Store(nx, d, hits.nx + at), hn::Store(ny, d, hits.ny + at), hn::Store(nz, d, hits.nz + at);
            hn::Store(hn::Add(ax, x), d, hits.x + at);
            hn::Store(hn::Add(ay, y), d, hits.y + at);
            hn::Store(hn::Add(az, z), d, hits.z + at);
            hn::Store(hn::Add(ax, hn::NegMulAdd(off, nx, x)), d, hits.inside_x + at);
            hn::Store(hn::Add(ay, hn::NegMulAdd(off, ny, y)), d, hits.inside_y + at);
            hn::Store(hn::Add(az, hn::NegMulAdd(off, nz, z)), d, hits.inside_z + at);
        }
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

    // Lists the cells with triangles that the flights of a vector pass, each flight's in its order.
    HWY_INLINE void pass(std::size_t at) {
        const Float d;
        const Int di;
        const std::size_t width = hn::Lanes(d);
        const float per_cell = 1 / grid_.cell_mm;
        FloatV begin = hn::Load(d, flights_.begin + at);
        Axis x(flights_.x + at, flights_.dx + at, begin, grid_.origin.x, per_cell, grid_.nx),
            y(flights_.y + at, flights_.dy + at, begin, grid_.origin.y, per_cell, grid_.ny),
            z(flights_.z + at, flights_.dz + at, begin, grid_.origin.z, per_cell, grid_.nz);
        const IntV bricks_x = hn::Set(di, grid_.nx >> 2), bricks_y = hn::Set(di, grid_.ny >> 2), three = hn::Set(di, 3);
        FloatM going = hn::FirstN(d, flights_.count - at);
        const IntV flight = hn::Iota(di, static_cast<std::int32_t>(at));
        const auto* const table = reinterpret_cast<const std::int32_t*>(grid_.bricks.data());
        for (;;) {
            const IntV brick = hn::Add(
                hn::ShiftRight<2>(x.cell),
                hn::Mul(bricks_x, hn::Add(hn::ShiftRight<2>(y.cell), hn::Mul(bricks_y, hn::ShiftRight<2>(z.cell)))));
            const IntV within = hn::Or(hn::And(x.cell, three), hn::Or(hn::ShiftLeft<2>(hn::And(y.cell, three)),
                                                                      hn::ShiftLeft<4>(hn::And(z.cell, three))));
            static_assert(sizeof(TriangleGrid::Brick) == 4 * sizeof(std::int32_t));
            // The half of the brick's bits that holds the cell's.
            const IntV word = hn::IfThenElseZero(hn::RebindMask(di, going),
                                                 hn::Or(hn::ShiftLeft<2>(brick), hn::ShiftRight<5>(within)));
            const IntV half = hn::GatherIndex(di, table, word);
            const IntV bit = hn::Shl(hn::Set(di, 1), hn::And(within, hn::Set(di, 31)));
            const FloatM full = hn::And(going, hn::RebindMask(d, hn::Ne(hn::And(half, bit), hn::Zero(di))));
            const FloatV next = hn::Min(x.t, hn::Min(y.t, z.t));
            if (!hn::AllFalse(d, full)) {
                const hn::RebindToUnsigned<Float> du;
                const IntV before = hn::And(half, hn::Sub(bit, hn::Set(di, 1)));
                const IntV cell = hn::Add(hn::GatherIndex(di, table + 2, word),
                                          hn::BitCast(di, hn::PopulationCount(hn::BitCast(du, before))));
                if (pairs_ + width > kPairs) test();
                const Listing listing(full);
                listing.append(flight, pair_flights_ + pairs_);
                listing.append(cell, pair_cells_ + pairs_);
                listing.append(begin, pair_begins_ + pairs_);
                listing.append(next, pair_ends_ + pairs_);
                for (const std::size_t end = pairs_ + listing.count(); pairs_ < end; ++pairs_)
                    hwy::Prefetch(&grid_.cells[static_cast<std::size_t>(pair_cells_[pairs_])]);
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
        for (std::size_t i = 0; i < chosen_; ++i) {
            const std::int32_t flight = chosen_flights_[i];
            // What a flight has met before the cell begins is nearer than what the cell holds.
            if (t_[flight] < chosen_begins_[i]) continue;
            const auto first = static_cast<std::uint32_t>(chosen_blocks_[i]);
            for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(chosen_counts_[i]); ++k)
                test(static_cast<std::size_t>(flight), first + k);
        }
        pairs_ = 0;
    }

    // Keeps the pairs whose flights come up to the plane of the cell while they are in it, and asks the memory for
    // their triangles.
    HWY_INLINE void choose() {
        const Float d;
        const Int di;
        const std::size_t width = hn::Lanes(d);
        chosen_ = 0;
        static_assert(sizeof(TriangleGrid::Cell) == 4 * sizeof(std::int32_t));
        const auto* const cells = reinterpret_cast<const std::int32_t*>(grid_.cells.data());
        const auto* const leasts = reinterpret_cast<const float*>(grid_.cells.data());
        for (std::size_t i = 0; i < pairs_; i += width) {
            const FloatM listed = hn::FirstN(d, pairs_ - i);
            const auto known = [&](const std::int32_t* of) {
                return hn::IfThenElseZero(hn::RebindMask(di, listed), hn::Load(di, of + i));
            };
            const IntV flight = known(pair_flights_), cell = hn::ShiftLeft<2>(known(pair_cells_));
            const IntV normal = hn::GatherIndex(di, cells + 2, cell);
            const FloatV least = hn::GatherIndex(d, leasts + 3, cell);
            const auto component = [&](IntV bits) { return hn::ConvertTo(d, hn::ShiftRight<22>(bits)); };
            const FloatV nx = component(normal), ny = component(hn::ShiftLeft<10>(normal)),
                         nz = component(hn::ShiftLeft<20>(normal));
            const auto height = [&](const float* x, const float* y, const float* z) {
                return hn::MulAdd(
                    nx, hn::GatherIndex(d, x, flight),
                    hn::MulAdd(ny, hn::GatherIndex(d, y, flight), hn::Mul(nz, hn::GatherIndex(d, z, flight))));
            };
            const FloatV from = height(flights_.x, flights_.y, flights_.z),
                         along = height(flights_.dx, flights_.dy, flights_.dz);
            const FloatV begin = hn::Load(d, pair_begins_ + i),
                         end = hn::Min(hn::Load(d, pair_ends_ + i), hn::Set(d, 1.0f));
            const FloatV highest = hn::Max(hn::MulAdd(along, begin, from), hn::MulAdd(along, end, from));
            const Listing listing(hn::And(hn::Ge(highest, least), listed));
            listing.append(flight, chosen_flights_ + chosen_);
            listing.append(hn::GatherIndex(di, cells, cell), chosen_blocks_ + chosen_);
            listing.append(hn::GatherIndex(di, cells + 1, cell), chosen_counts_ + chosen_);
            listing.append(begin, chosen_begins_ + chosen_);
            for (const std::size_t last = chosen_ + listing.count(); chosen_ < last; ++chosen_) {
                const auto* line =
                    reinterpret_cast<const char*>(&grid_.blocks[static_cast<std::uint32_t>(chosen_blocks_[chosen_])]);
                for (std::size_t at = 0; at < sizeof(TriangleGrid::Block); at += 64) hwy::Prefetch(line + at);
            }
        }
    }

    // The corners of triangles of a block, by the vertices that they share.
    class Corners {
    public:
        HWY_INLINE Corners(const TriangleGrid::Block& block, std::size_t first) : block_(block), first_(first) {}

        HWY_INLINE CornerVec at(std::size_t which, const CornerVec& origin) const {
            const hn::RebindToSigned<Corner> di;
            const hn::Rebind<std::uint8_t, Corner> bytes;
            const auto vertex = hn::PromoteTo(di, hn::LoadU(bytes, block_.corners[which] + first_));
            return CornerVec{take(block_.x, vertex), take(block_.y, vertex), take(block_.z, vertex)} - origin;
        }

    private:
        HWY_INLINE CornerV take(const float* of, hn::Vec<hn::RebindToSigned<Corner>> vertex) const {
            const Corner d;
#if HWY_TARGET <= HWY_AVX2
            // Twelve vertices in two vectors that overlap.
            const hn::RebindToSigned<Corner> di;
            constexpr std::size_t beyond = TriangleGrid::kVertices - TriangleGrid::kBlock;
            const auto seven = hn::Set(di, 7);
            const auto behind = hn::Sub(vertex, hn::Set(di, static_cast<std::int32_t>(beyond)));
            const auto low = hn::TableLookupLanes(hn::LoadU(d, of), hn::IndicesFromVec(d, hn::And(vertex, seven)));
            const auto high =
                hn::TableLookupLanes(hn::LoadU(d, of + beyond), hn::IndicesFromVec(d, hn::And(behind, seven)));
            return hn::IfThenElse(hn::RebindMask(d, hn::Gt(vertex, seven)), high, low);
#else
            return hn::GatherIndex(d, of, vertex);
#endif
        }

        const TriangleGrid::Block& block_;
        std::size_t first_;
    };

    // A line passes through a triangle when it passes all edges on the same side; the side of an edge, the volume of
    // the edge and the line, is the same but for its sign from both of its triangles, so that nothing slips between.
    HWY_INLINE void test(std::size_t flight, std::uint32_t place) {
        const Corner d;
        const std::size_t width = hn::Lanes(d);
        const CornerVec origin{hn::Set(d, flights_.x[flight]), hn::Set(d, flights_.y[flight]),
                               hn::Set(d, flights_.z[flight])};
        const CornerVec along{hn::Set(d, flights_.dx[flight]), hn::Set(d, flights_.dy[flight]),
                              hn::Set(d, flights_.dz[flight])};
        for (std::size_t i = 0; i < TriangleGrid::kBlock; i += width) {
            const Corners corners(grid_.blocks[place], i);
            const auto corner = [&](std::size_t which) { return corners.at(which, origin); };
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
            for (unsigned set = bytes[0]; set != 0; set &= set - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(set));
                if (!(ts[lane] < t_[flight])) continue;
                const float sum = us[lane] + vs[lane] + ws[lane], scale = sum != 0 ? 1 / sum : 0;
                t_[flight] = ts[lane];
                met_[flight] = place * TriangleGrid::kBlock + static_cast<std::uint32_t>(i + lane);
                u_[flight] = std::clamp(us[lane] * scale, 0.0f, 1.0f),
                v_[flight] = std::clamp(vs[lane] * scale, 0.0f, 1.0f);
            }
        }
    }

    struct Met {
        const TriangleGrid::Block* block;
        std::size_t lane;
    };
    Met metBy(std::size_t flight) const {
        return {&grid_.blocks[met_[flight] / TriangleGrid::kBlock], met_[flight] % TriangleGrid::kBlock};
    }

    const TriangleGrid& grid_;
    const Flights& flights_;
    std::size_t pairs_ = 0, chosen_ = 0;
    // Of each flight the nearest hit: in multiples of the flight, and the place of its triangle in the blocks.
    alignas(64) float t_[Flights::kRoom], u_[Flights::kRoom], v_[Flights::kRoom];
    std::uint32_t met_[Flights::kRoom];
    // Flights and the cells with triangles that they pass, from where to where; then those of them to be tested.
    alignas(64) std::int32_t pair_flights_[kPairs + 16], pair_cells_[kPairs + 16];
    alignas(64) float pair_begins_[kPairs + 16], pair_ends_[kPairs + 16];
    alignas(64) std::int32_t chosen_flights_[kPairs + 16], chosen_blocks_[kPairs + 16], chosen_counts_[kPairs + 16];
    alignas(64) float chosen_begins_[kPairs + 16];
};

void intersectGrid(const TriangleGrid& grid, const Ray* flights, std::size_t count, RayHit* hits, Vec3* positions) {
    Flights some;
    for (std::size_t first = 0; first < count; first += Flights::kMost) {
        some.count = std::min(Flights::kMost, count - first);
        for (std::size_t i = 0; i < some.count; ++i) {
            const Ray& f = flights[first + i];
            some.x[i] = f.origin.x, some.y[i] = f.origin.y, some.z[i] = f.origin.z;
            some.dx[i] = f.t_max * f.direction.x, some.dy[i] = f.t_max * f.direction.y;
            some.dz[i] = f.t_max * f.direction.z;
            some.begin[i] = f.t_min / f.t_max;
        }
        FlightTest test(grid, some);
        test.run();
        for (std::size_t i = 0; i < some.count; ++i)
            if (test.hit(i, hits[first + i], positions[first + i])) hits[first + i].t *= flights[first + i].t_max;
    }
}

void intersectFlights(const TriangleGrid& grid, const Flights& flights, float nudge, FlightHits& hits) {
    FlightTest test(grid, flights);
    test.run();
    test.list(nudge, hits);
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(intersectGrid);
HWY_EXPORT(intersectFlights);

void TriangleGrid::intersect(std::span<const Ray> flights, std::span<RayHit> hits, std::span<Vec3> positions) const {
    assert(flights.size() == hits.size() && flights.size() == positions.size());
    HWY_DYNAMIC_DISPATCH(intersectGrid)(*this, flights.data(), flights.size(), hits.data(), positions.data());
}

void TriangleGrid::intersect(const Flights& flights, float nudge_mm, FlightHits& hits) const {
    HWY_DYNAMIC_DISPATCH(intersectFlights)(*this, flights, nudge_mm, hits);
}

}  // namespace searchlight
#endif
