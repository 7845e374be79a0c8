#include "scene/medium.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "base/text.h"

namespace searchlight {

namespace {

std::string inChannel(const Medium& medium, int channel) {
    constexpr const char* names[] = {" in the red channel", " in the green channel", " in the blue channel"};
    return medium.channels == 1 ? "" : names[channel];
}

Rgb perChannel(const std::vector<double>& list, const char* name) {
    if (list.size() == 1) return {list[0], list[0], list[0]};
    if (list.size() == 3) return {list[0], list[1], list[2]};
    throw inputError(fmt::format("{} has {} numbers", name, list.size()), "expected one number or R,G,B");
}

}  // namespace

void checkMedium(const Medium& medium) {
    for (int channel = 0; channel < medium.channels; ++channel) {
        const auto require = [&](bool valid, const char* name, double value, const char* hint) {
            if (!valid)
                throw inputError(fmt::format("{} is {}{}", name, numberText(value), inChannel(medium, channel)), hint);
        };
        const double sigma_a = medium.sigma_a[channel], sigma_s = medium.sigma_s[channel], g = medium.g[channel];
        require(std::isfinite(sigma_a) && sigma_a >= 0, "sigma_a", sigma_a,
                "expected a finite number of at least 0 1/mm");
        require(std::isfinite(sigma_s) && sigma_s >= 0, "sigma_s", sigma_s,
                "expected a finite number of at least 0 1/mm");
        require(std::abs(g) < 1, "g", g, "expected a mean cosine above -1 and below 1");
        if (sigma_a == 0 && sigma_s == 0)
            throw inputError(fmt::format("sigma_a and sigma_s are both 0{}", inChannel(medium, channel)),
                             "a medium absorbs or scatters");
    }
    if (!(medium.eta >= 0.25 && medium.eta <= 4))
        throw inputError(fmt::format("eta is {}", numberText(medium.eta)),
                         "expected a refractive index from 0.25 to 4, inside over outside");
}

Medium makeMedium(const std::vector<double>& sigma_a, const std::vector<double>& sigma_s, const std::vector<double>& g,
                  double eta) {
    const bool single = sigma_a.size() == 1 && sigma_s.size() == 1 && g.size() == 1;
    const Medium medium{perChannel(sigma_a, "sigma_a"), perChannel(sigma_s, "sigma_s"), perChannel(g, "g"), eta,
                        single ? 1 : 3};
    checkMedium(medium);
    return medium;
}

Medium scaled(const Medium& medium, double scale) {
    if (!(std::isfinite(scale) && scale > 0))
        throw usageError(fmt::format("scale is {}", numberText(scale)), "expected a finite number above 0");
    Medium larger = medium;
    larger.sigma_a = (1 / scale) * medium.sigma_a;
    larger.sigma_s = (1 / scale) * medium.sigma_s;
    return larger;
}

}  // namespace searchlight
