// Light from single directions, points and small discs inside a refractive mesh, before it scatters: behind each facet
// that it meets there is a beam whose direction and strength at a point are known in closed form, and where the first
// two meet other facets from inside, their mirror images of it. So a walk from the camera needs not meet such light,
// nor be joined to walks from it: a collision sums the beams that pass through it, and there is nothing to blow up
// where two walks come close. Of a disc a direction is drawn for each collision that asks.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/random.h"
#include "light/light_sampler.h"
#include "transport/mesh/beam_cells.h"
#include "transport/mesh/body_walk.h"
#include "transport/mesh/closed_body.h"
#include "transport/mesh/disc_gates.h"

namespace searchlight {

/// The beams of one channel's medium: of singular() and narrow() lights. What a beam has left after kReach mean free
/// paths, 8e-7 of it, an image of it that is down to kWeakestImage, and what is mirrored inside more often than its
/// lists reach (mirrored()) is no part; nor is, of discs, what is left after discReach_mm() and what is mirrored.
/// Immutable; queries may run on many threads at once.
class FacetBeams {
public:
    static constexpr double kReach = 14;           ///< mean free paths
    static constexpr double kDiscReach = 5;        ///< the same, of discs: walks meet what is beyond
    static constexpr double kWeakestImage = 2e-5;  ///< of its beam: where an image is left out
    static constexpr std::size_t kMostOrders = 8;  ///< times that a beam is mirrored

    /// Body and lights outlive their use; eta is not 1. Follows beams through mirrors as long as more than 1e-4 of the
    /// light is mirrored once more, `most_orders` times at most, and while lists of images are not longer than 32 times
    /// the others' and take no more than 256 MiB. Throws an input Error when the others take more than 1 GiB.
    FacetBeams(const MeshBody& body, const BodyMedium& medium, const LightSampler& lights, int channel,
               std::size_t most_orders = kMostOrders);

    /// Radiance that one collision at `position` scatters into a walk that came there in `direction` (unit) from the
    /// camera, over the square of eta. Counts its rays.
    double scattered(Vec3f position, Vec3 direction, SplitMix64& random, std::uint64_t& rays) const;

    double discReach_mm() const { return kDiscReach / medium_.sigma_t; }

    /// How often beams are followed through a mirror.
    std::size_t orders() const { return orders_; }
    /// The part of all the light that enters the body which comes from singular() lights and is mirrored inside more
    /// often than that before it scatters: what is left out.
    double mirrored() const { return mirrored_[orders_]; }

private:
    // Beams weaker than this are followed up by a roulette: they cost as many rays as the others.
    static constexpr double kWeak = 0.2;

    // The point (u, v) of a facet from which light gets to a position x after the distance t: each is row . x +
    // constant. Behind light from a point or a disc u and v are off by up to the slack times t.
    struct Beam {
        std::uint32_t triangle = 0, light = 0;
        std::uint32_t mirrors = 0;  // the first of `order` facets in mirrors_, in the order that light meets them
        std::uint8_t order = 0;
        bool parallel = false;  // one direction; of a disc one at a time
        bool disc = false;
        float slack = 0;
        float begin = 0;  // t at the last mirror, at least
        float end = 0;    // t where it is left out
        float part = 1;   // that its mirrors leave of it, at most
        Vec3f rows[3];
        float constants[3] = {};
        float low[3] = {0, 0, 0}, high[3] = {1, 1, 1};  // of u, v and u + v: light beyond misses a mirror
    };
    // The light that the disc's beams before this one are of.
    struct DiscEnd {
        std::uint32_t beam = 0, light = 0;
    };
    // What surely needs no ray.
    struct Clearance {
        float inside_mm = 0;   // from its facet up to there nothing hides that
        bool outside = false;  // nothing hides the light from its facet
    };
    // Where the beam comes from as it looks from its last leg: x = corner + u side + v other + t direction.
    struct Frame {
        Vec3 corner, side, other, direction;
    };
    // How light arrives inside.
    struct Arrival {
        Vec3 entry, wi, direction;  // where, from where outside, and to where inside
        double distance = 0;        // from the entry, mm
        double irradiance = 0;      // without what is lost on the way through the medium and at mirrors
        double light_distance = 0;
    };
    // What asks.
    struct Collision {
        Vec3f position;
        Vec3 direction;
    };
    // Of light from a point with a facet's normal: the largest outside, and the range inside; 0 under total reflection.
    struct Cosines {
        double outside = 1, least = 1, most = 1;
    };
    // A leg of its way, followed from the light.
    struct Leg {
        Vec3 end, direction;
    };

    void addBeams(std::uint32_t light);
    void addDisc(std::uint32_t light);
    DiscGate gateOf(const Beam& beam, std::span<const Vec3> directions) const;
    void findClear(std::span<const Sweep> sweeps);
    void addOrders(std::size_t most);
    bool addOrder(const CellLists& facets, std::uint32_t first, std::size_t most);
    std::optional<Beam> behind(const Beam& beam, const Frame& frame, std::uint32_t facet) const;
    Frame frameOf(const Beam& beam) const;
    bool setRows(Beam& beam, const Frame& frame) const;
    Cosines cosinesOf(const Beam& beam) const;
    bool grazes(const Beam& beam) const;
    double turnOf(const Beam& beam) const;
    double bendOf(const Beam& beam) const;
    Vec3 directionAt(const Beam& beam, Vec3 place) const;
    Sweep sweepOf(const Beam& beam) const;
    Sweep sweepOfDisc(const Beam& beam) const;
    std::optional<Box> directionsTo(std::uint32_t light) const;
    std::span<const std::uint32_t> mirrorsOf(const Beam& beam) const {
        return {mirrors_.data() + beam.mirrors, beam.order};
    }
    bool mayReach(const Beam& beam, Vec3f position) const;
    bool arrive(const Beam& beam, Vec3 position, Arrival& arrival) const;
    bool enters(const Beam& beam, Vec3 entry) const;
    double throughMirrors(const Beam& beam, const Arrival& light, std::array<Leg, kMostOrders + 1>& legs) const;
    bool hidden(std::uint32_t beam, Vec3f from, const Arrival& light, std::uint64_t& rays) const;
    double fromDiscs(std::span<const std::uint32_t> list, const Collision& collision, SplitMix64& random,
                     std::uint64_t& rays) const;
    double byDisc(std::uint32_t beam, const LightSample& light, const Collision& collision, SplitMix64& random,
                  std::uint64_t& rays) const;
    double by(std::uint32_t index, const Collision& collision, SplitMix64& random, std::uint64_t& rays) const;
    void measureMirrored();

    const MeshBody& body_;
    BodyMedium medium_;
    const LightSampler& lights_;
    int channel_;
    BeamCells cells_;
    std::vector<Beam> beams_;
    std::vector<Clearance> clearances_;  // of those that enter
    std::vector<std::uint32_t> mirrors_;
    std::vector<Vec3> normals_;             // of the facets
    std::uint32_t discs_begin_ = 0;         // the first disc's beam; images follow the last
    std::vector<DiscEnd> disc_ends_;        // ascending
    std::vector<DiscGate> gates_;           // of all beams up to the discs' last
    std::vector<std::vector<Vec3>> spans_;  // of lights that are discs: directions that span them
    double reach_mm_ = 0;
    // Of each cell, how likely a collision is to look for beams: what is left at most of one that enters.
    std::vector<float> worth_;
    CellLists direct_, discs_, images_;  // of each cell, the beams that may pass through it
    std::size_t orders_ = 0;
    std::array<double, kMostOrders + 1> mirrored_{};  // part that is mirrored more often than that
};

}  // namespace searchlight
