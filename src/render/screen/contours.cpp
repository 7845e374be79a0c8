#include "render/screen/contours.h"

#include <algorithm>
#include <cmath>

namespace searchlight {

namespace {

struct Patch {
    const float* cell = nullptr;
    Vec3 sight;  // through the pixel's middle, of depth 1

    bool exists() const { return cell[3] > 0; }
    double over(Vec3 direction) const { return cell[0] * direction.x + cell[1] * direction.y + cell[2] * direction.z; }
    /// Along `direction`, of depth 1; below 0 where the plane lies behind the eye.
    double depth(Vec3 direction) const { return 1 / over(direction); }
};

Patch patchAt(const ScreenPatches& patches, int x, int y) {
    return {&patches.cells[patches.cellAt(x, y)],
            {(x + 0.5 - 0.5 * patches.width) / patches.focal, (y + 0.5 - 0.5 * patches.height) / patches.focal, 1}};
}

bool goesOn(const Patch& patch, const Patch& neighbour, double focal) {
    if (!neighbour.exists()) return false;
    const double depth = patch.depth(patch.sight), cosine = patch.cell[3] / (depth * length(patch.sight));
    const double rise = depth / (focal * cosine);
    const double expected = patch.depth(neighbour.sight);
    return expected > 0 && std::abs(neighbour.depth(neighbour.sight) - expected) <= rise;
}

}  // namespace

void takeContours(ScreenPatches& patches) {
    std::vector<std::size_t> taken;
    for (int y = 0; y < patches.height; ++y)
        for (int x = 0; x < patches.width; ++x) {
            const Patch patch = patchAt(patches, x, y);
            if (!patch.exists()) continue;
            bool whole = true;
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, patches.height - 1); ++v)
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, patches.width - 1); ++u)
                    whole = whole && ((u == x && v == y) || goesOn(patch, patchAt(patches, u, v), patches.focal));
            if (!whole) taken.push_back(patches.cellAt(x, y));
        }
    for (const std::size_t cell : taken)
        for (std::size_t i = 0; i < 4; ++i) patches.cells[cell + i] = 0;
}

}  // namespace searchlight
