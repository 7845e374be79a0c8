// The analogue walk inside a closed body, 64 at a time. A step flies to the next collision as if there were no surface
// and scatters there. Steps that may have met the surface are tested by a ray; where one did, the walk is put back to
// the surface, unscattered, and its next step is a fresh one: free paths have no memory. Walks that end are replaced at
// once.
//
// Where a ball around a collision lies inside the walk's region, the walk goes through it in one large step
// (large_steps-inl.h).
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

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/mesh/body_walk.cpp"
#include <hwy/foreach_target.h>

#include "transport/mesh/large_steps-inl.h"
#include "transport/mesh/open_flights-inl.h"
#include "transport/mesh/surface_meeting-inl.h"

HWY_BEFORE_NAMESPACE();
namespace searchlight {
namespace HWY_NAMESPACE {

// A walk that is taken back more often is in a place that is none: a fold, or two surfaces that cross.
constexpr int kMostTakenBack = 16;

template <class Body, class Regions, bool kIsotropic>
class BodyWalker {
public:
    BodyWalker(const Body& body, const BodyMedium& medium, WalkSource& source, SplitMix64 seeds)
        : body_(body),
          medium_(medium),
          regions_(body),
          source_(source),
          steps_(medium.sigma_t, medium.g, medium.ways, SplitMix64(seeds.next())) {
        mfp_ = static_cast<float>(1 / medium.sigma_t);
        collisions_per_log_ = medium.absorbed > 0 ? -1 / std::log1p(-medium.absorbed) : 0;
        for (Group& group : groups_) {
            seed(group.lanes[0], seeds);
            for (auto& plane : group.regions.planes) std::ranges::fill(plane.offset, 1.0f);
            std::ranges::fill(group.regions.deep, deepAtFirst());
        }
        random_ = SplitMix64(seeds.next());
        if (const int one_of = source.asksOneOf(); one_of > 0)
            for (int lane = static_cast<int>(random_.uniform() * one_of); lane < 64; lane += one_of)
                asks_ |= std::uint64_t{1} << lane;
    }

    BodyChunk run() {
        for (Group& group : groups_)
            for (std::size_t lane = 0; lane < kLanes; ++lane) start(group, group.lanes[0], lane);
        const auto walks = [](const Group& group) { return group.walking != 0; };
        while (std::ranges::any_of(groups_, walks)) {
            open_.count = 0;
            for (std::size_t group = 0; group < kGroups; ++group) advance(group);
            open_.fill();
            chooseTested();
            cross();
            if (asks_ != 0) ask();
            step();
            for (Group& group : groups_) {
                for (; group.ends != 0; group.ends &= group.ends - 1) {
                    const auto lane = static_cast<std::size_t>(std::countr_zero(group.ends));
                    chunk_.absorbed += group.weight[lane];
                    end(group, lane, to(group).collisions[lane]);
                }
                group.scattered = group.collided;
            }
            now_ ^= 1;
        }
        return std::move(chunk_);
    }

private:
    Lanes& from(Group& group) const { return group.lanes[now_]; }
    Lanes& to(Group& group) const { return group.lanes[now_ ^ 1]; }

    HWY_INLINE void advance(std::size_t which) {
        Group& group = groups_[which];
        const Float d;
        const std::size_t width = hn::Lanes(d);
        const double g = medium_.g;
        const FloatV asymmetry = hn::Set(d, static_cast<float>(g)),
                     half_qq = hn::Set(d, static_cast<float>(0.5 * (1 - g) * (1 - g)));
        const Lanes& before = from(group);
        Lanes& after = to(group);
        std::uint64_t stay = 0, ends = 0, deep = 0;
        std::size_t opened = open_.count;
        for (std::size_t at = 0; at < kLanes; at += width) {
            Pack pack = load(before, at);
            const FloatV x = pack.x, y = pack.y, z = pack.z, reach = hn::Load(d, group.reach + at);
            fly(pack, hn::Mul(exponential(pack.random.next()), reach));
            const Region region = group.regions.load(at);
            const FloatM stays = region.holds(pack.x, pack.y, pack.z);
            stay |= bitsOf(stays) << at;
            const Listing leaving(hn::AndNot(stays, hn::Gt(reach, hn::Zero(d))));
            leaving.append(x, open_.x + opened);
            leaving.append(y, open_.y + opened);
            leaving.append(z, open_.z + opened);
            leaving.append(pack.x, open_.end_x + opened);
            leaving.append(pack.y, open_.end_y + opened);
            leaving.append(pack.z, open_.end_z + opened);
            leaving.append(hn::Iota(Int(), static_cast<std::int32_t>(which * kLanes + at)), open_.lane + opened);
            opened += leaving.count();
            deep |= bitsOf(hn::Lt(region.away(pack.x, pack.y, pack.z), hn::Load(d, group.regions.deep + at))) << at;
            scatter<kIsotropic>(pack, asymmetry, half_qq);
            store(pack, after, at);
            ends |= bitsOf(hn::RebindMask(d, hn::Gt(pack.collisions, hn::Load(Int(), group.survives + at)))) << at;
        }
        open_.count = opened;
        group.uncleared = group.walking & ~stay;
        group.collided = group.walking;
        group.ends = ends;
        group.deep = deep & stay & group.walking & ~ends;
        chunk_.flights += static_cast<std::uint64_t>(std::popcount(group.walking));
    }

    void chooseTested() {
        if constexpr (Regions::kLooksUp)
            if (regions_.tabulated()) return lookUp(regions_, leastStep(), open_, groups_[0].regions, tested_);
        testAll(open_, tested_);
    }

    // Square of 0 where walks take no large steps: nothing is that near to a middle.
    float leastStep() const { return medium_.ways > 0 ? steps_.least() : std::numeric_limits<float>::infinity(); }
    float deepAtFirst() const {
        const float inner = std::max(std::sqrt(regions_.first()) - leastStep(), 0.0f);
        return inner * inner;
    }

    // Large steps of walks that have just scattered deep inside their region.
    HWY_NOINLINE void step() {
        const Float d;
        const Int di;
        const std::size_t width = hn::Lanes(d);
        const LaneList list(groups_, &Group::deep);
        Group& first = groups_[0];
        Lanes& lanes = to(first);
        HWY_ALIGN std::int32_t bits[16], balls[16];
        for (std::size_t i = 0; i < list.filled; i += width) {
            std::int32_t last = 0;
            for (std::size_t lane = 0; lane < width; ++lane) {
                if (i + lane < list.count) last = static_cast<std::int32_t>(random_.next() >> 32);
                bits[lane] = last;
            }
            const IntV at = hn::Load(di, list.places + i);
            const auto take = [&](const float* of) { return hn::GatherIndex(d, of, at); };
            LargeStep step{take(lanes.x),
                           take(lanes.y),
                           take(lanes.z),
                           {take(lanes.u), take(lanes.v), take(lanes.w)},
                           hn::GatherIndex(di, lanes.collisions, at)};
            const LaneRegions& r = first.regions;
            const Region region{take(r.x), take(r.y), take(r.z), take(r.square), {}};
            const IntV ball =
                steps_.ballOf(hn::Sub(hn::Sqrt(region.square), hn::Sqrt(region.away(step.x, step.y, step.z))));
            hn::Store(ball, di, balls);
            for (std::size_t lane = 0; lane < width; ++lane) steps_.need(balls[lane]);
            const IntV way = hn::GatherIndex(di, first.way, at);
            steps_.take(step, ball, way, azimuth(hn::Load(di, bits)));
            const IntV survives = hn::GatherIndex(di, first.survives, at);
            const hn::Mask<Int> ends = hn::Gt(step.collisions, survives);
            step.collisions = hn::IfThenElse(ends, hn::Add(survives, hn::Set(di, 1)), step.collisions);
            hn::ScatterIndex(step.x, d, lanes.x, at);
            hn::ScatterIndex(step.y, d, lanes.y, at);
            hn::ScatterIndex(step.z, d, lanes.z, at);
            hn::ScatterIndex(step.direction.u, d, lanes.u, at);
            hn::ScatterIndex(step.direction.v, d, lanes.v, at);
            hn::ScatterIndex(step.direction.w, d, lanes.w, at);
            hn::ScatterIndex(step.collisions, di, lanes.collisions, at);
            hn::ScatterIndex(hn::Add(way, hn::Set(di, 1)), di, first.way, at);
            std::uint64_t ended = bitsOf(hn::RebindMask(d, ends));
            if (i + width > list.count) ended &= (std::uint64_t{1} << (list.count - i)) - 1;
            for (; ended != 0; ended &= ended - 1) {
                const unsigned lane = list.lanes[i + static_cast<std::size_t>(std::countr_zero(ended))];
                groups_[lane / kLanes].ends |= std::uint64_t{1} << lane % kLanes;
            }
        }
    }

    // Tells the source of the collisions of lanes whose turn it is. Turns go round from a random one, so that each
    // collision has the same chance, and lanes that began together are not asked together.
    void ask() {
        asks_ = std::rotl(asks_, 1);
        for (Group& group : groups_) {
            const Lanes &before = from(group), &after = to(group);
            for (std::uint64_t rest = group.collided & ~group.ends & asks_; rest != 0; rest &= rest - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
                source_.collide(group.tag[lane], group.weight[lane], {after.x[lane], after.y[lane], after.z[lane]},
                                {before.u[lane], before.v[lane], before.w[lane]});
            }
        }
    }

    // Tests flights that no region clears against the surface.
    void cross() {
        if (tested_.flights.count < open_.count) {
            for (Group& group : groups_) group.uncleared = 0;
            for (std::size_t i = 0; i < tested_.flights.count; ++i) groupOf(i).uncleared |= bitOf(i);
        }
        chunk_.rays += tested_.flights.count;
        body_.cross(tested_.flights, hits_);
        lose();
        for (Group& group : groups_) {
            group.doubtful &= group.uncleared;  // the others are inside
            group.met = 0;
        }
        for (std::size_t i = 0; i < hits_.count; ++i) {
            const auto flight = static_cast<std::size_t>(hits_.flight[i]);
            groupOf(flight).met |= bitOf(flight);
        }
        for (Group& group : groups_) {
            const Lanes& before = from(group);
            for (std::uint64_t rest = group.uncleared & ~(group.doubtful | group.met); rest != 0; rest &= rest - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
                group.sure[lane] = {{before.x[lane], before.y[lane], before.z[lane]},
                                    {before.u[lane], before.v[lane], before.w[lane]},
                                    before.collisions[lane]};
            }
            group.doubtful = group.uncleared & ~group.met;
        }
        for (std::size_t i = 0; i < hits_.lost_count; ++i) takeBack(static_cast<std::size_t>(hits_.lost[i]));
        meet();
    }

    Group& groupOf(std::size_t flight) { return groups_[tested_.lanes[flight] / static_cast<std::int32_t>(kLanes)]; }
    std::size_t laneOf(std::size_t flight) const { return static_cast<std::size_t>(tested_.lanes[flight]) % kLanes; }
    std::uint64_t bitOf(std::size_t flight) const { return std::uint64_t{1} << laneOf(flight); }

    // What ends beyond the body without having met anything had slipped out before.
    void lose() {
        const Float d;
        const Vec3f low = body_.low(), high = body_.high();
        for (std::size_t at = 0; at < tested_.flights.count; at += hn::Lanes(d)) {
            const auto within = [&](const float* from, const float* along, float least, float most) {
                const FloatV end = hn::Add(hn::Load(d, from + at), hn::Load(d, along + at));
                return hn::And(hn::Gt(end, hn::Set(d, least)), hn::Lt(end, hn::Set(d, most)));
            };
            const FloatM inside = hn::And(within(tested_.flights.x, tested_.flights.dx, low.x, high.x),
                                          hn::And(within(tested_.flights.y, tested_.flights.dy, low.y, high.y),
                                                  within(tested_.flights.z, tested_.flights.dz, low.z, high.z)));
            for (std::uint64_t out = bitsOf(hn::AndNot(inside, hn::FirstN(d, tested_.flights.count - at))); out != 0;
                 out &= out - 1) {
                const auto flight = static_cast<std::int32_t>(at) + std::countr_zero(out);
                const auto listed = [flight](std::span<const std::int32_t> list) {
                    return std::ranges::find(list, flight) != list.end();
                };
                if (!listed({hits_.flight, hits_.count}) && !listed({hits_.lost, hits_.lost_count}))
                    hits_.lost[hits_.lost_count++] = flight;
            }
        }
    }

    void takeBack(std::size_t flight) {
        Group& group = groupOf(flight);
        const std::size_t lane = laneOf(flight);
        group.ends &= ~bitOf(flight);
        if (++group.taken_back[lane] > kMostTakenBack) {
            ++chunk_.lost;
            end(group, lane, from(group).collisions[lane]);
        } else {
            ++chunk_.taken_back;
            const Group::Sure& sure = group.sure[lane];
            put(group, to(group), lane, sure.position, sure.direction);
            to(group).collisions[lane] = sure.collisions;
        }
    }

    // Leaves through the surface or is reflected by it. What is random is drawn in the order of the hits, however many
    // lanes a vector has.
    HWY_NOINLINE void meet() {
        const std::size_t width = hn::Lanes(Float());
        for (std::size_t i = 0; i < hits_.count; ++i) {
            const auto flight = static_cast<std::size_t>(hits_.flight[i]);
            Group& group = groupOf(flight);
            const std::size_t lane = laneOf(flight);
            group.ends &= ~bitOf(flight);
            const Lanes& before = from(group);
            to(group).collisions[lane] = before.collisions[lane];
            meeting_.u[i] = before.u[lane], meeting_.v[i] = before.v[lane], meeting_.w[i] = before.w[lane];
            if (medium_.eta != 1) meeting_.bits[i] = static_cast<std::int32_t>(random_.next() >> 32);
        }
        std::size_t exits = 0;
        for (std::size_t at = 0; at < hits_.count; at += width) {
            const std::size_t some = std::min(width, hits_.count - at);
            const std::uint64_t all = (std::uint64_t{1} << some) - 1, back = meeting_.reflect(hits_, at, medium_.eta);
            for (std::uint64_t rest = all & back; rest != 0; rest &= rest - 1) {
                const std::size_t i = at + static_cast<std::size_t>(std::countr_zero(rest));
                const auto flight = static_cast<std::size_t>(hits_.flight[i]);
                Group& group = groupOf(flight);
                put(group, to(group), laneOf(flight), {hits_.inside_x[i], hits_.inside_y[i], hits_.inside_z[i]},
                    {meeting_.u[i], meeting_.v[i], meeting_.w[i]});
            }
            for (std::uint64_t rest = all & ~back; rest != 0; rest &= rest - 1) {
                const std::size_t i = at + static_cast<std::size_t>(std::countr_zero(rest));
                body_.seekCell(static_cast<std::uint32_t>(hits_.triangle[i]));
                exits_[exits++] = static_cast<std::uint16_t>(i);
            }
        }
        for (std::size_t i = 0; i < exits; ++i) leave(exits_[i]);
    }

    void leave(std::size_t i) {
        const auto flight = static_cast<std::size_t>(hits_.flight[i]);
        Group& group = groupOf(flight);
        const std::size_t lane = laneOf(flight);
        const Lanes& before = from(group);
        Crossing crossing;
        crossing.what = Crossing::What::surface;
        crossing.position = {hits_.x[i], hits_.y[i], hits_.z[i]};
        crossing.inside = {hits_.inside_x[i], hits_.inside_y[i], hits_.inside_z[i]};
        crossing.normal = toDouble(Vec3f{hits_.nx[i], hits_.ny[i], hits_.nz[i]});
        crossing.triangle = static_cast<std::uint32_t>(hits_.triangle[i]);
        crossing.u = hits_.u[i], crossing.v = hits_.v[i];
        crossing.cell = body_.cellOf(crossing);
        const float weight = group.weight[lane];
        chunk_.left += weight;
        chunk_.exits = chunk_.exits + static_cast<double>(weight) * toDouble(crossing.position);
        const Vec3 direction = toDouble(Vec3f{before.u[lane], before.v[lane], before.w[lane]});
        if ((group.scattered >> lane & 1) != 0)
            source_.leaveScattered(group.tag[lane], weight, {before.x[lane], before.y[lane], before.z[lane]}, direction,
                                   crossing, chunk_.cells);
        else
            source_.leave(group.tag[lane], weight, direction, crossing, chunk_.cells);
        end(group, lane, before.collisions[lane]);
    }

    void put(Group& group, Lanes& lanes, std::size_t lane, Vec3f position, Vec3f direction) {
        group.regions.square[lane] = regions_.first();
        group.regions.deep[lane] = deepAtFirst();
        group.collided &= ~(std::uint64_t{1} << lane);
        lanes.x[lane] = position.x, lanes.y[lane] = position.y, lanes.z[lane] = position.z;
        lanes.u[lane] = direction.x, lanes.v[lane] = direction.y, lanes.w[lane] = direction.z;
    }

    void end(Group& group, std::size_t lane, std::int32_t collisions) {
        chunk_.collisions += static_cast<std::uint64_t>(collisions);
        start(group, to(group), lane);
    }

    // The next walk, or none: a lane without one stays where it is.
    void start(Group& group, Lanes& lanes, std::size_t lane) {
        const std::uint64_t bit = std::uint64_t{1} << lane;
        Entry entry;
        lanes.collisions[lane] = 0;
        group.doubtful &= ~bit;
        group.taken_back[lane] = 0;
        group.survives[lane] = kNever;
        if (!source_.next(entry)) {
            put(group, lanes, lane, {}, {0, 0, 1});
            group.reach[lane] = 0;
            group.walking &= ~bit;
            return;
        }
        group.walking |= bit;
        put(group, lanes, lane, entry.position, entry.direction);
        group.reach[lane] = mfp_;
        group.weight[lane] = entry.weight;
        group.tag[lane] = entry.tag;
        if (medium_.ways > 0) group.way[lane] = static_cast<std::int32_t>(random_.next() & 0xFFFF);
        // Absorption is drawn at once for the whole walk: it survives n collisions with probability albedo^n.
        if (collisions_per_log_ > 0) group.survives[lane] = survives();
    }

    // How many collisions a walk survives; drawn for many at once.
    std::int32_t survives() {
        if (survives_left_ == 0) {
            const Int di;
            for (std::size_t i = 0; i < kLanes; i += 2) {
                const std::uint64_t bits = random_.next();
                survives_[i] = static_cast<std::int32_t>(bits),
                survives_[i + 1] = static_cast<std::int32_t>(bits >> 32);
            }
            const FloatV scale = hn::Set(Float(), static_cast<float>(collisions_per_log_));
            for (std::size_t at = 0; at < kLanes; at += hn::Lanes(di))
                hn::Store(collisionsSurvived(hn::Load(di, survives_ + at), scale), di, survives_ + at);
            survives_left_ = kLanes;
        }
        return survives_[--survives_left_];
    }

    const Body& body_;
    BodyMedium medium_;
    Regions regions_;
    WalkSource& source_;
    std::uint64_t asks_ = 0;  // the lanes whose collisions the source wants to know of
    LargeSteps<kIsotropic> steps_;
    float mfp_;
    double collisions_per_log_;  // -1 / log(albedo)
    SplitMix64 random_;          // of what is rare: entries, the surface
    int now_ = 0;                // which lanes a step begins from
    BodyChunk chunk_;
    Group groups_[kGroups];
    OpenFlights open_;
    TestedFlights tested_;
    FlightHits hits_;
    SurfaceMeeting meeting_;
    std::uint16_t exits_[Flights::kMost];
    alignas(64) std::int32_t survives_[kLanes];
    std::size_t survives_left_ = 0;
};

template <class Body, class Regions>
BodyChunk walkIn(const Body& body, const BodyMedium& medium, WalkSource& source, SplitMix64 seeds) {
    if (medium.g == 0) return std::make_unique<BodyWalker<Body, Regions, true>>(body, medium, source, seeds)->run();
    return std::make_unique<BodyWalker<Body, Regions, false>>(body, medium, source, seeds)->run();
}

BodyChunk walkBall(const Ball& ball, const BodyMedium& medium, WalkSource& source, SplitMix64 seeds) {
    return walkIn<Ball, BallRegions>(ball, medium, source, seeds);
}

BodyChunk walkMesh(const MeshBody& mesh, const BodyMedium& medium, WalkSource& source, SplitMix64 seeds) {
    return walkIn<MeshBody, MeshRegions>(mesh, medium, source, seeds);
}

}  // namespace HWY_NAMESPACE
}  // namespace searchlight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace searchlight {

HWY_EXPORT(walkBall);
HWY_EXPORT(walkMesh);

BodyChunk walkBodyChunk(const Ball& ball, const BodyMedium& medium, WalkSource& source, SplitMix64 seeds) {
    return HWY_DYNAMIC_DISPATCH(walkBall)(ball, medium, source, seeds);
}

BodyChunk walkBodyChunk(const MeshBody& mesh, const BodyMedium& medium, WalkSource& source, SplitMix64 seeds) {
    return HWY_DYNAMIC_DISPATCH(walkMesh)(mesh, medium, source, seeds);
}

}  // namespace searchlight
#endif
