#include "transport/slab/slab_entry.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ranges>

#include "transport/slab/slab.h"
#include "transport/walk/fresnel.h"

namespace searchlight {

namespace {

// Unpolarised; n sin = `invariant` on both sides.
double reflectance(double n, double n_beyond, double invariant) {
    if (n == n_beyond) return 0;
    const double sine = invariant / n, sine_beyond = invariant / n_beyond;
    if (sine >= 1 || sine_beyond >= 1) return 1;
    const double c = std::sqrt((1 - sine) * (1 + sine)), t = std::sqrt((1 - sine_beyond) * (1 + sine_beyond));
    return fresnelReflectance(n, c, n_beyond, t);
}

// Of a surface of reflectance r over all that reflects `rest`: intensities add up between clear layers, as in
// [Wang1995] for one layer.
double together(double r, double rest) {
    return r == 1 || rest == 1 ? 1 : r + (1 - r) * (1 - r) * rest / (1 - r * rest);
}

}  // namespace

// Let `back` be the part of light, sent up at a surface from below it, that comes back down there after reflections
// above. Of light that meets a surface of reflectance r from above, what the surface reflects has another try with
// probability back: so it passes first with probability 1 - r back of what ever passes. Of light that meets it from
// below, r is reflected at once and `back` of the surface below it comes back at all. Rejection, a try for each beam
// that does not enter, would never end close to total reflection.
EntryShift::EntryShift(std::span<const Surface> surfaces) {
    double back = 0;
    for (const auto& [r, shift_mm] : surfaces) {
        const double next = together(r, back);
        surfaces_.push_back({1 - r * back, next > 0 ? r / next : 1, shift_mm});
        back = next;
    }
}

double EntryShift::draw(SplitMix64& random) const {
    double shift = 0;
    bool down = true;
    for (std::size_t at = 0; at < surfaces_.size();) {
        const double goes_down = down ? surfaces_[at].passes : surfaces_[at].returns;
        down = at == 0 || random.uniform() < goes_down;
        if (!down) --at;
        if (at + 1 < surfaces_.size()) shift += surfaces_[at].shift_mm;
        if (down) ++at;
    }
    return shift;
}

SlabEntry slabEntry(const SlabProblem& problem) {
    const double angle = problem.angle_deg * (std::numbers::pi / 180);
    const double invariant = problem.n_above * std::sin(angle);
    std::vector<EntryShift::Surface> surfaces;
    SlabEntry entry;
    double n = problem.n_above;
    const std::vector<SlabLayer>& layers = problem.layers;
    for (;; ++entry.first) {
        const bool below = entry.first == layers.size();
        const double next = below ? problem.n_below : layers[entry.first].n;
        surfaces.push_back({reflectance(n, next, invariant)});
        n = next;
        if (below || !layers[entry.first].clear()) break;
        const double sine = std::min(invariant / n, 1.0);
        // Beyond total reflection nothing gets here.
        surfaces.back().shift_mm =
            sine < 1 ? layers[entry.first].thickness_mm * sine / std::sqrt((1 - sine) * (1 + sine)) : 0;
    }
    entry.sine = std::min(invariant / n, 1.0);
    for (const EntryShift::Surface& surface : std::views::reverse(surfaces))
        entry.specular = together(surface.reflectance, entry.specular);
    if (problem.angle_deg > 0 && entry.first > 0 && entry.specular < 1) entry.shift = EntryShift(surfaces);
    return entry;
}

}  // namespace searchlight
