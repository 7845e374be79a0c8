#include "render/hybrid/split.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace searchlight {

namespace {

// [Chang2007, Fig. 3.4]: 1.5 / mm with R_p = 2.4141 mm.
constexpr double steepness = 3.6;

double localWeight(double r, double border) {
    if (!(border > 0)) return 0;
    const double beyond = steepness * (r - border) / border;
    return beyond <= 0 ? 1 - 0.5 * std::exp(beyond) : 0.5 * std::exp(-beyond);
}

// Radii close enough for both parts: those of the profile, and some between.
std::vector<double> refined(std::span<const double> radii) {
    constexpr int parts = 4;
    std::vector<double> finer;
    for (std::size_t i = 0; i + 1 < radii.size(); ++i)
        for (int k = 0; k < parts; ++k) finer.push_back(radii[i] + (radii[i + 1] - radii[i]) * k / parts);
    finer.push_back(radii.back());
    return finer;
}

double borderOf(const Profile& profile, const std::vector<double>& radii, double total, double spacing, double share,
                int channel) {
    const auto arrives = [&](double r) { return 2 * std::numbers::pi * r * std::abs(profile(r)[channel]) * spacing; };
    const double least = share * total;
    for (std::size_t i = radii.size(); i-- > 1;) {
        if (arrives(radii[i - 1]) < least) continue;
        double low = radii[i - 1], high = radii[i];
        if (arrives(high) >= least) return high;
        for (int step = 0; step < 60; ++step) (arrives(0.5 * (low + high)) >= least ? low : high) = 0.5 * (low + high);
        return low;
    }
    return 0;
}

}  // namespace

Split splitProfile(const Profile& profile, double spacing_mm, double share) {
    const std::vector<double> radii = refined(profile.radii());
    const Rgb total = profile.total();
    Split split;
    for (int c = 0; c < Rgb::channels; ++c)
        if (std::abs(total[c]) > 0)
            split.border_mm[c] = borderOf(profile, radii, std::abs(total[c]), spacing_mm, share, c);
    std::vector<Rgb> local, global;
    for (const double r : radii) {
        const Rgb Rd = profile(r);
        Rgb near;
        for (int c = 0; c < Rgb::channels; ++c) near[c] = localWeight(r, split.border_mm[c]) * Rd[c];
        local.push_back(near);
        global.push_back(Rd - near);
    }
    split.local = Profile(radii, std::move(local));
    split.global = Profile(radii, std::move(global));
    for (int c = 0; c < Rgb::channels; ++c)
        if (std::abs(total[c]) > 0) split.local_share[c] = split.local.total()[c] / total[c];
    return split;
}

}  // namespace searchlight
