// The analogue walk inside a closed body, 64 at a time. A step flies to the next collision as if there were no surface
// and scatters there. Steps that may have met the surface are tested by a ray; where one did, the walk is put back to
// the surface, unscattered, and its next step is a fresh one: free paths have no memory. Walks that end are replaced at
// once.
//
// Positions are float, in mm from the centre of the body. A coordinate of a body of 100 mean free paths is known to
// 4e-6 of one, and a step adds a rounding as often up as down. At the surface rounding is systematic: a walk goes on
// from a point that is moved inwards by 2^-22 of the body's size, so that a flight does not meet the triangle that it
// comes from. That is below 3e-5 mean free paths in such a body and 3e-3 in the largest that is let in.
//
// A flight is tested between its ends as they are stored. Tested with the length that was drawn, a collision just short
// of the surface could be rounded to its far side without a crossing, and a walk that scatters outwards there is gone:
// one in 1e6. What the rounding of the ray test still lets through is recognised by where it meets the surface next
// (MeshBody::cross), and taken back to the last flight that surely began inside, whose length is drawn again. So the
// results are those of walks under the condition that none slips through: they differ from all walks' by less than the
// part that is taken back, which is counted and limited.
#include "transport/mesh/body_walk.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>

#include "transport/walk/fresnel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/mesh/body_walk.cpp"
// As in half_space_walk.cpp.
#define HWY_DISABLED_TARGETS HWY_SSSE3
#define HWY_BROKEN_EMU128 0
#include <hwy/foreach_target.h>

#include "transport/walk/lane_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

// Whether the flight from `before` may have met the surface, for a pack of lanes.
class MayLeaveBall {
public:
    explicit MayLeaveBall(const Ball& ball) : square_(static_cast<float>(ball.radius() * ball.radius())) {}

    HWY_INLINE FloatM operator()(const Pack&, FloatV, const Pack& after) const {
        const FloatV square = hn::MulAdd(after.x, after.x, hn::MulAdd(after.y, after.y, hn::Mul(after.z, after.z)));
        return hn::Gt(square, hn::Set(Float(), square_));
    }

private:
    float square_;
};

class MayLeaveMesh {
public:
    explicit MayLeaveMesh(const MeshBody& mesh)
        : regions_(mesh.regions()),
          table_(reinterpret_cast<const float*>(regions_.regions.data())),
          per_cell_(1 / regions_.cell_mm) {}

    HWY_INLINE FloatM operator()(const Pack& before, FloatV length, const Pack& after) const {
        const Float d;
        const Int di;
        const FloatV scale = hn::Set(d, per_cell_);
        const auto cell = [&](FloatV position, float low) {
            return hn::ConvertTo(di, hn::Mul(hn::Sub(position, hn::Set(d, low)), scale));
        };
        const IntV x = cell(before.x, regions_.origin.x), y = cell(before.y, regions_.origin.y),
                   z = cell(before.z, regions_.origin.z);
        const IntV row = hn::Add(hn::Mul(z, hn::Set(di, regions_.ny)), y);
        const IntV index = hn::Add(hn::Mul(row, hn::Set(di, regions_.nx)), x);
        static_assert(sizeof(SafeRegion) == 8 * sizeof(float));
        const IntV at = hn::ShiftLeft<3>(hn::GatherIndex(di, regions_.regions_of.data(), index));
        const FloatV nx = hn::GatherIndex(d, table_, at), ny = hn::GatherIndex(d, table_ + 1, at),
                     nz = hn::GatherIndex(d, table_ + 2, at), offset = hn::GatherIndex(d, table_ + 3, at),
                     reach = hn::GatherIndex(d, table_ + 4, at);
        const auto height = [&](const Pack& pack) {
            return hn::MulAdd(nx, pack.x, hn::MulAdd(ny, pack.y, hn::Mul(nz, pack.z)));
        };
        const FloatV highest = hn::Max(height(before), height(after));
        return hn::Or(hn::Ge(length, reach), hn::Ge(highest, offset));
    }

private:
    const SafeRegions& regions_;
    const float* table_;
    float per_cell_;
};

// A walk that is taken back more often is in a place that is none: a fold, or two surfaces that cross.
constexpr int kMostTakenBack = 16;

template <class Body, class MayLeave, bool kIsotropic>
class BodyWalker {
public:
    BodyWalker(const Body& body, const BodyMedium& medium, EntrySource<Body>& source, SplitMix64 seeds)
        : body_(body), medium_(medium), may_leave_(body), source_(source) {
        mfp_ = static_cast<float>(1 / medium.sigma_t);
        collisions_per_log_ = medium.absorbed > 0 ? -1 / std::log1p(-medium.absorbed) : 0;
        seed(*from_, seeds);
        random_ = SplitMix64(seeds.next());
    }

    BodyChunk run() {
        const std::size_t width = hn::Lanes(Float());
        for (std::size_t lane = 0; lane < kLanes; ++lane) start(*from_, lane);
        while (walking_ != 0) {
            std::uint64_t may_leave = 0, ends = 0;
            for (std::size_t at = 0; at < kLanes; at += width) advance(at, may_leave, ends);
            chunk_.flights += static_cast<std::uint64_t>(std::popcount(walking_));
            may_leave &= walking_;
            doubtful_ &= may_leave;  // the others are inside
            if (may_leave != 0) ends &= ~cross(may_leave);
            for (; ends != 0; ends &= ends - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(ends));
                chunk_.absorbed += weight_[lane];
                end(lane, to_->collisions[lane]);
            }
            std::swap(from_, to_);
        }
        chunk_.entry = source_.totals();
        chunk_.candidates = source_.tried();
        return std::move(chunk_);
    }

private:
    HWY_INLINE void advance(std::size_t at, std::uint64_t& may_leave, std::uint64_t& ends) {
        const Float d;
        const Pack before = load(*from_, at);
        Pack pack = before;
        const FloatV length = hn::Mul(exponential(pack.random.next()), hn::Load(d, reach_ + at));
        fly(pack, length);
        const FloatM leaves = may_leave_(before, length, pack);
        const double g = medium_.g;
        scatter<kIsotropic>(pack, hn::Set(d, static_cast<float>(g)),
                            hn::Set(d, static_cast<float>(0.5 * (1 - g) * (1 - g))));
        store(pack, *to_, at);
        may_leave |= bitsOf(leaves) << at;
        ends |= bitsOf(hn::RebindMask(d, hn::Gt(pack.collisions, hn::Load(Int(), survives_ + at)))) << at;
    }

    static HWY_INLINE std::uint64_t bitsOf(FloatM mask) {
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(Float(), mask, bits);
        return bits[0] | static_cast<std::uint64_t>(bits[1]) << 8;
    }

    // Tests flights against the surface; returns the lanes that met it.
    std::uint64_t cross(std::uint64_t lanes) {
        Ray flights[kLanes];
        Crossing crossings[kLanes];
        std::size_t count = 0;
        for (std::uint64_t rest = lanes; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            const Vec3f start{from_->x[lane], from_->y[lane], from_->z[lane]};
            flights[count++] = {start, {to_->x[lane] - start.x, to_->y[lane] - start.y, to_->z[lane] - start.z}, 0, 1};
        }
        chunk_.rays += count;
        body_.cross({flights, count}, {crossings, count});
        std::uint64_t met = 0;
        const Crossing* crossing = crossings;
        for (std::uint64_t rest = lanes; rest != 0; rest &= rest - 1, ++crossing) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            const std::uint64_t bit = std::uint64_t{1} << lane;
            if (crossing->what != Crossing::What::surface && (doubtful_ & bit) == 0) {
                doubtful_ |= bit;
                sure_[lane] = {{from_->x[lane], from_->y[lane], from_->z[lane]},
                               {from_->u[lane], from_->v[lane], from_->w[lane]},
                               from_->collisions[lane]};
            }
            if (crossing->what == Crossing::What::none) continue;
            met |= bit;
            to_->collisions[lane] = from_->collisions[lane];
            if (crossing->what == Crossing::What::surface) {
                doubtful_ &= ~bit;
                meet(lane, *crossing);
            } else if (++taken_back_[lane] > kMostTakenBack) {
                ++chunk_.lost;
                end(lane, to_->collisions[lane]);
            } else {
                ++chunk_.taken_back;
                put(*to_, lane, sure_[lane].position, sure_[lane].direction);
                to_->collisions[lane] = sure_[lane].collisions;
            }
        }
        return met;
    }

    // Leaves through the surface or is reflected by it.
    void meet(std::size_t lane, const Crossing& crossing) {
        const Vec3 direction{from_->u[lane], from_->v[lane], from_->w[lane]};
        const double cosine = std::clamp(dot(direction, crossing.normal), 0.0, 1.0);
        if (medium_.eta != 1 && random_.uniform() < internalReflectance(medium_.eta, cosine)) {
            put(*to_, lane, crossing.inside, toFloat(normalize(direction - 2 * cosine * crossing.normal)));
            return;
        }
        chunk_.left += weight_[lane];
        chunk_.exits = chunk_.exits + static_cast<double>(weight_[lane]) * toDouble(crossing.position);
        chunk_.cells.push_back({crossing.cell, weight_[lane]});
        end(lane, from_->collisions[lane]);
    }

    static void put(Lanes& lanes, std::size_t lane, Vec3f position, Vec3f direction) {
        lanes.x[lane] = position.x, lanes.y[lane] = position.y, lanes.z[lane] = position.z;
        lanes.u[lane] = direction.x, lanes.v[lane] = direction.y, lanes.w[lane] = direction.z;
    }

    void end(std::size_t lane, std::int32_t collisions) {
        chunk_.collisions += static_cast<std::uint64_t>(collisions);
        start(*to_, lane);
    }

    // The next walk, or none: a lane without one stays where it is.
    void start(Lanes& lanes, std::size_t lane) {
        Entry entry;
        lanes.collisions[lane] = 0;
        doubtful_ &= ~(std::uint64_t{1} << lane);
        taken_back_[lane] = 0;
        if (!source_.next(entry)) {
            put(lanes, lane, last_, {0, 0, 1});
            reach_[lane] = 0;
            survives_[lane] = kNever;
            walking_ &= ~(std::uint64_t{1} << lane);
            return;
        }
        walking_ |= std::uint64_t{1} << lane;
        last_ = entry.position;
        put(lanes, lane, entry.position, entry.direction);
        reach_[lane] = mfp_;
        weight_[lane] = entry.weight;
        survives_[lane] = kNever;
        // Absorption is drawn at once for the whole walk: it survives n collisions with probability albedo^n.
        if (collisions_per_log_ > 0)
            survives_[lane] =
                static_cast<std::int32_t>(std::min(-std::log(random_.uniform()) * collisions_per_log_, 0x1p30));
    }

    const Body& body_;
    BodyMedium medium_;
    MayLeave may_leave_;
    EntrySource<Body>& source_;
    float mfp_;
    double collisions_per_log_;  // -1 / log(albedo)
    SplitMix64 random_;          // of what is rare: entries, the surface
    std::uint64_t walking_ = 0;  // a bit per lane
    Vec3f last_;                 // where lanes without a walk wait: in reach of the tables
    BodyChunk chunk_;
    struct Sure {
        Vec3f position, direction;
        std::int32_t collisions = 0;
    };
    std::uint64_t doubtful_ = 0;  // a bit per lane: flights since sure_ were tested and met nothing
    Sure sure_[kLanes];           // of those lanes: the start of the last flight known to
                                  // begin inside
    int taken_back_[kLanes] = {};
    Lanes lanes_[2] = {};
    Lanes *from_ = &lanes_[0], *to_ = &lanes_[1];
    alignas(64) float reach_[kLanes];  // mean free path; 0 in lanes without a walk
    alignas(64) std::int32_t survives_[kLanes];
    float weight_[kLanes];
};

template <class Body, class MayLeave>
BodyChunk walkIn(const Body& body, const BodyMedium& medium, EntrySource<Body>& source, SplitMix64 seeds) {
    if (medium.g == 0) return std::make_unique<BodyWalker<Body, MayLeave, true>>(body, medium, source, seeds)->run();
    return std::make_unique<BodyWalker<Body, MayLeave, false>>(body, medium, source, seeds)->run();
}

BodyChunk walkBall(const Ball& ball, const BodyMedium& medium, EntrySource<Ball>& source, SplitMix64 seeds) {
    return walkIn<Ball, MayLeaveBall>(ball, medium, source, seeds);
}

BodyChunk walkMesh(const MeshBody& mesh, const BodyMedium& medium, EntrySource<MeshBody>& source, SplitMix64 seeds) {
    return walkIn<MeshBody, MayLeaveMesh>(mesh, medium, source, seeds);
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(walkBall);
HWY_EXPORT(walkMesh);

std::vector<double> BodyChunk::pack() const {
    const auto number = [](std::uint64_t count) { return static_cast<double>(count); };
    std::vector<double> values{entry.arrived,
                               entry.entered,
                               number(entry.arrivals),
                               number(entry.walks),
                               number(candidates),
                               number(collisions),
                               number(flights),
                               number(rays),
                               number(taken_back),
                               number(lost),
                               left,
                               absorbed,
                               exits.x,
                               exits.y,
                               exits.z};
    for (const CellExit& exit : cells) values.insert(values.end(), {number(exit.cell), exit.weight});
    return values;
}

void BodyChunk::unpack(std::span<const double> values) {
    const double* next = values.data();
    const auto count = [&](std::uint64_t& value) { value = static_cast<std::uint64_t>(*next++); };
    entry.arrived = *next++, entry.entered = *next++;
    count(entry.arrivals), count(entry.walks), count(candidates), count(collisions), count(flights), count(rays);
    count(taken_back), count(lost);
    left = *next++, absorbed = *next++;
    exits = {next[0], next[1], next[2]};
    cells.clear();
    for (next += 3; next != values.data() + values.size(); next += 2)
        cells.push_back({static_cast<std::uint32_t>(next[0]), static_cast<float>(next[1])});
}

BodyChunk walkBodyChunk(const Ball& ball, const BodyMedium& medium, EntrySource<Ball>& source, SplitMix64 seeds) {
    return HWY_DYNAMIC_DISPATCH(walkBall)(ball, medium, source, seeds);
}

BodyChunk walkBodyChunk(const MeshBody& mesh, const BodyMedium& medium, EntrySource<MeshBody>& source,
                        SplitMix64 seeds) {
    return HWY_DYNAMIC_DISPATCH(walkMesh)(mesh, medium, source, seeds);
}

}  // namespace searchlight
#endif
