// Flights that may have met the surface, and which of them regions clear. Included once per instruction set.
#if defined(SEARCHLIGHT_TRANSPORT_OPEN_FLIGHTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SEARCHLIGHT_TRANSPORT_OPEN_FLIGHTS_INL_H_
#undef SEARCHLIGHT_TRANSPORT_OPEN_FLIGHTS_INL_H_
#else
#define SEARCHLIGHT_TRANSPORT_OPEN_FLIGHTS_INL_H_
#endif

#include "transport/mesh/lane_group-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

// Flights that have left the regions that they began in, of all groups: together they fill vectors.
struct OpenFlights {
    static constexpr std::size_t kRoom = Flights::kRoom;

    alignas(64) float x[kRoom] = {}, y[kRoom] = {}, z[kRoom] = {};
    alignas(64) float end_x[kRoom] = {}, end_y[kRoom] = {}, end_z[kRoom] = {};
    alignas(64) std::int32_t lane[kRoom] = {};
    std::size_t count = 0;

    // Fills the last vector with the last flight: what is written for it is written twice.
    void fill() {
        if (count == 0) return;
        for (float* of : {x, y, z, end_x, end_y, end_z})
            hn::StoreU(hn::Set(Float(), of[count - 1]), Float(), of + count);
        hn::StoreU(hn::Set(Int(), lane[count - 1]), Int(), lane + count);
    }
};

// Those of them that are to be tested against the surface.
struct TestedFlights {
    Flights flights;
    alignas(64) std::int32_t lanes[Flights::kRoom] = {};
};

// Finds regions for walks that left theirs, and lists the flights that these do not clear. What is read is asked
// for one pass ahead.
// `least`: radius of the smallest large step.
template <class Regions>
HWY_NOINLINE void lookUp(const Regions& tables, float least, const OpenFlights& open, LaneRegions& regions,
                         TestedFlights& tested) {
    const Float d;
    const Int di;
    const std::size_t width = hn::Lanes(d);
    alignas(64) std::int32_t places[2][OpenFlights::kRoom];  // of the regions of begins and ends
    for (std::size_t i = 0; i < open.count; i += width) {
        const auto take = [i](const float* of) { return hn::Load(Float(), of + i); };
        hn::Store(tables.seek(take(open.x), take(open.y), take(open.z)), di, places[0] + i);
        hn::Store(tables.seek(take(open.end_x), take(open.end_y), take(open.end_z)), di, places[1] + i);
    }
    for (auto& of : places)
        for (std::size_t i = 0; i < open.count; i += width)
            hn::Store(tables.seekRegion(hn::Load(di, of + i)), di, of + i);
    std::size_t count = 0;
    for (std::size_t i = 0; i < open.count; i += width) {
        const auto take = [i](const float* of) { return hn::Load(Float(), of + i); };
        const FloatV px = take(open.x), py = take(open.y), pz = take(open.z);
        const FloatV qx = take(open.end_x), qy = take(open.end_y), qz = take(open.end_z);
        const FloatM listed = hn::FirstN(d, open.count - i);
        // Preferably the region of where the flight ends: the next one begins there.
        const Region end = tables.at(qx, qy, qz, hn::Load(di, places[1] + i)),
                     begin = tables.at(px, py, pz, hn::Load(di, places[0] + i));
        const FloatM useful = end.holds(qx, qy, qz), by_end = hn::And(useful, end.holds(px, py, pz));
        const FloatM known = begin.holds(px, py, pz), by_begin = hn::And(known, begin.holds(qx, qy, qz));
        // Two convex regions that meet on the flight hold all of it. What rounding does to it is far below what
        // regions were shrunk by.
        const FloatV dx = hn::Sub(qx, px), dy = hn::Sub(qy, py), dz = hn::Sub(qz, pz);
        const FloatV first = hn::IfThenElseZero(known, begin.reaches(px, py, pz, dx, dy, dz));
        const FloatV last =
            hn::Sub(hn::Set(d, 1.0f),
                    hn::IfThenElseZero(useful, end.reaches(qx, qy, qz, hn::Neg(dx), hn::Neg(dy), hn::Neg(dz))));
        const auto choose = [&](FloatV a, FloatV b) { return hn::IfThenElse(useful, a, b); };
        Region kept{choose(end.x, begin.x),
                    choose(end.y, begin.y),
                    choose(end.z, begin.z),
                    choose(end.square, hn::IfThenElseZero(by_begin, begin.square)),
                    {}};
        for (std::size_t j = 0; j < kPlanes; ++j) {
            const Region::Plane &e = end.planes[j], &b = begin.planes[j];
            kept.planes[j] = {choose(e.nx, b.nx), choose(e.ny, b.ny), choose(e.nz, b.nz), choose(e.offset, b.offset)};
        }
        const IntV lane = hn::Load(di, open.lane + i);
        regions.scatter(kept, placesOf(lane), hn::Set(d, least));
        // A flight without length, whose parts are no numbers, is cleared.
        const FloatM uncleared = hn::And(listed, hn::AndNot(hn::Or(by_end, by_begin), hn::Lt(first, last)));
        const Listing listing(uncleared);
        const std::size_t to = count;
        listing.append(px, tested.flights.x + to);
        listing.append(py, tested.flights.y + to);
        listing.append(pz, tested.flights.z + to);
        listing.append(hn::Mul(last, dx), tested.flights.dx + to);
        listing.append(hn::Mul(last, dy), tested.flights.dy + to);
        listing.append(hn::Mul(last, dz), tested.flights.dz + to);
        listing.append(hn::Div(first, last), tested.flights.begin + to);
        listing.append(lane, tested.lanes + to);
        count += listing.count();
    }
    tested.flights.count = count;
}

// Without tables: all flights that may meet the surface are tested.
HWY_INLINE void testAll(const OpenFlights& open, TestedFlights& tested) {
    const Float d;
    for (std::size_t i = 0; i < open.count; i += hn::Lanes(d)) {
        const auto copy = [&](const float* end, const float* begin, float* from, float* along) {
            const FloatV start = hn::Load(d, begin + i);
            hn::Store(start, d, from + i);
            hn::Store(hn::Sub(hn::Load(d, end + i), start), d, along + i);
        };
        copy(open.end_x, open.x, tested.flights.x, tested.flights.dx);
        copy(open.end_y, open.y, tested.flights.y, tested.flights.dy);
        copy(open.end_z, open.z, tested.flights.z, tested.flights.dz);
        hn::Store(hn::Zero(d), d, tested.flights.begin + i);
        hn::Store(hn::Load(Int(), open.lane + i), Int(), tested.lanes + i);
    }
    tested.flights.count = open.count;
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#endif
