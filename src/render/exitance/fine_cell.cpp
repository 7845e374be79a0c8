#include "render/exitance/fine_cell.h"

#include <algorithm>
#include <numbers>

namespace searchlight {

double fineCellArea(const Profile& profile) {
    const double reach = profile.radii().back();
    double radius = reach;
    for (int c = 0; c < Rgb::channels; ++c) {
        const double total = profile.total()[c];
        if (!(total > 0)) continue;
        double r = reach;
        while (r > 1e-9 * reach && profile.encircled(r)[c] > 1e-4 * total) r *= 0.8;
        radius = std::min(radius, r);
    }
    return std::numbers::pi * radius * radius;
}

}  // namespace searchlight
