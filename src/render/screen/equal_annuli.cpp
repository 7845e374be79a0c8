#include "render/screen/equal_annuli.h"

#include <algorithm>

namespace searchlight {

std::vector<float> equalAnnuli(const Profile& density) {
    constexpr int parts = 2048;
    std::vector<float> annuli;
    double inner = 0;
    for (int i = 1; i <= parts; ++i) {
        const double outer =
            i < parts ? density.sampleRadius(static_cast<double>(i) / parts, 0) : density.radii().back();
        const double width = std::max(outer * outer - inner * inner, 1e-12 * outer * outer);
        annuli.push_back(static_cast<float>(inner * inner));
        annuli.push_back(static_cast<float>(width));
        inner = outer;
    }
    return annuli;
}

}  // namespace searchlight
