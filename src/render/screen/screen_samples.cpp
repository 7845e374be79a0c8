#include "render/screen/screen_samples.h"

#include <algorithm>
#include <cassert>

#include "base/parallel.h"

namespace searchlight {

namespace {

constexpr std::size_t grain = 8192;

}  // namespace

ScreenSamples screenSamples(const View& view, const VisibleSurface& visible, int threads) {
    assert(view.width == visible.width && view.height == visible.height);
    ScreenSamples samples{.width = view.width,
                          .height = view.height,
                          .focal = static_cast<float>(0.5 * view.height / view.tan_half),
                          .count = visible.positions.size()};
    const std::size_t padded = samples.padded();
    for (auto* planes : {&samples.position, &samples.normal})
        for (std::vector<float>& plane : *planes) plane.resize(padded);
    samples.cell.assign(padded, ScreenSamples::nothing);
    samples.depth.assign(samples.cells(), 0.0f);
    if (samples.count == 0) return samples;

    const auto inCamera = [&](Vec3 v) {
        return std::array{static_cast<float>(dot(v, view.right)), static_cast<float>(-dot(v, view.up)),
                          static_cast<float>(dot(v, view.forward))};
    };
    // The samples of a pixel follow each other: those of one that began in the part before are the part's before.
    const auto startOf = [&](std::size_t i) {
        while (i > 0 && i < samples.count && visible.pixels[i] == visible.pixels[i - 1]) ++i;
        return std::min(i, samples.count);
    };
    parallelFor((samples.count + grain - 1) / grain, threads, [&](std::size_t part) {
        const std::size_t end = startOf((part + 1) * grain);
        for (std::size_t i = startOf(part * grain); i < end;) {
            const std::uint32_t pixel = visible.pixels[i];
            std::size_t widest = i;
            for (; i < end && visible.pixels[i] == pixel; ++i) {
                const Vec3 offset = toDouble(visible.positions[i]) - visible.eye;
                // A shading normal that looks away spans no plane that is seen.
                const Vec3 shading = toDouble(visible.normals[i]);
                const Vec3 normal = dot(shading, offset) < 0 ? shading : toDouble(visible.geometric_normals[i]);
                const auto p = inCamera(offset), n = inCamera(normal);
                for (std::size_t k = 0; k < 3; ++k) samples.position[k][i] = p[k], samples.normal[k][i] = n[k];
                if (visible.coverage[i] > visible.coverage[widest]) widest = i;
            }
            const auto width = static_cast<std::uint32_t>(view.width);
            const std::uint32_t cell =
                (pixel / width + 1) * static_cast<std::uint32_t>(samples.stride()) + pixel % width + 1;
            samples.cell[widest] = cell;
            samples.depth[cell] = samples.position[2][widest];
        }
    });
    for (std::size_t i = samples.count; i < padded; ++i)
        for (auto* planes : {&samples.position, &samples.normal})
            for (std::vector<float>& plane : *planes) plane[i] = plane[samples.count - 1];
    return samples;
}

}  // namespace searchlight
