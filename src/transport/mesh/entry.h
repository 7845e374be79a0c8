// Where and how light enters a body: what its walks start from.
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "base/random.h"
#include "base/vec.h"
#include "light/light_sampler.h"

namespace searchlight {

/// Radiance 1 from everywhere on every point of the surface: nothing casts a shadow. Has closed forms to test with.
struct UniformLight {};

/// Flux 1 along a ray that meets the body's surface at a point.
struct PencilLight {
    Vec3 position;  ///< on the surface, mm
    Vec3 normal;    ///< outward, unit
    Vec3 wi;        ///< towards the light, unit, above the surface
};

/// A LightSampler outlives its use.
using Illumination = std::variant<UniformLight, PencilLight, const LightSampler*>;

/// A walk about to start.
struct Entry {
    Vec3f position;         ///< mm, just inside
    Vec3f direction;        ///< refracted, unit
    float weight = 0;       ///< of light: in multiples of EntryOptions::whole
    std::uint32_t tag = 0;  ///< for the source's own use, when the walk leaves
    bool single = false;    ///< light of a LightSampler that comes from a single direction
};

/// A value for a cell of the surface, or for a pixel.
struct CellExit {
    std::uint32_t cell = 0;
    float weight = 0;
};

struct Crossing;

/// What the walks of a chunk start from, and what it means when they leave.
class WalkSource {
public:
    virtual ~WalkSource() = default;

    /// The next walk. False when there are no more.
    virtual bool next(Entry& entry) = 0;
    /// A walk of this tag and weight crosses the surface, coming from inside in this unit direction.
    virtual void leave(std::uint32_t tag, float weight, Vec3 direction, const Crossing& crossing,
                       std::vector<CellExit>& exits) = 0;

    /// 0, or a divisor n of 64: of n collisions of a walk that do not absorb it one, on average, calls collide().
    virtual int asksOneOf() const { return 0; }
    /// `direction` (unit) is that in which the walk came to the collision.
    virtual void collide(std::uint32_t, float /*weight*/, Vec3f /*position*/, Vec3f /*direction*/) {}
    /// Like leave(), where the last flight began at a collision: at `start`.
    virtual void leaveScattered(std::uint32_t tag, float weight, Vec3f /*start*/, Vec3 direction,
                                const Crossing& crossing, std::vector<CellExit>& exits) {
        leave(tag, weight, direction, crossing, exits);
    }
};

/// Flux that candidates carried, in multiples of EntryOptions::whole.
struct EntryTotals {
    double arrived = 0;  ///< reached the surface
    double entered = 0;  ///< crossed it
    std::uint64_t arrivals = 0, walks = 0;
};

struct EntryOptions {
    int channel = 0;
    double eta = 1;
    double whole = 1;  ///< weight that candidates are rouletted up to, mm^2
};

/// Candidates of one chunk, spread evenly over the surface. A candidate of weight w (area times irradiance over the
/// probability of its direction, mm^2) survives with probability w / whole, and then weighs 1: walks cost the same
/// whatever they weigh. What the surface mirrors is drawn like that too.
template <class Body>
class EntrySource : public WalkSource {
public:
    EntrySource(const Body& body, const Illumination& illumination, const EntryOptions& options,
                std::uint64_t candidates, SplitMix64 random);

    bool next(Entry& entry) override;
    /// Counts the weight for the cell.
    void leave(std::uint32_t tag, float weight, Vec3 direction, const Crossing& crossing,
               std::vector<CellExit>& exits) override;

    const EntryTotals& totals() const { return totals_; }
    std::uint64_t tried() const { return tried_; }

    struct Candidate {
        double weight = 0;  ///< flux through the surface's outside, before roulette,
                            ///< shadow and Fresnel
        Vec3 normal, wi;
        double distance = 0;
        bool shadowed = false;  ///< may be
        bool single = false;    ///< as in Entry
        Vec3 position;
    };
    /// The next candidate, unweighted by any roulette: for pilots.
    Candidate draw();

private:
    /// A batch of candidates, of which some enter. False when there are no more.
    bool fill();
    Candidate drawPoint();

    const Body& body_;
    const Illumination& illumination_;
    EntryOptions options_;
    std::uint64_t candidates_, tried_ = 0;
    SplitMix64 random_;
    EntryTotals totals_;
    std::vector<Entry> entries_;  ///< that wait; the last one is next
};

}  // namespace searchlight
