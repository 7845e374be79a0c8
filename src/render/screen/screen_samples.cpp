#include "render/screen/screen_samples.h"

#include <algorithm>
#include <cassert>
#include <limits>

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
    const std::size_t padded = samples.padded(), count = samples.count;
    for (auto* planes : {&samples.position, &samples.normal})
        for (std::vector<float>& plane : *planes) plane.resize(padded);
    samples.depth.assign(samples.cells(), 0.0f);
    if (count == 0) return samples;

    // Who stands for which pixel; the samples of a pixel follow each other in the list.
    constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();
    const auto width = static_cast<std::size_t>(view.width), height = static_cast<std::size_t>(view.height);
    std::vector<std::uint32_t> standing(width * height, nobody), others;
    for (std::size_t i = 0; i < count;) {
        const std::uint32_t pixel = visible.pixels[i];
        std::size_t end = i + 1, widest = i;
        for (; end < count && visible.pixels[end] == pixel; ++end)
            if (visible.coverage[end] > visible.coverage[widest]) widest = end;
        standing[pixel] = static_cast<std::uint32_t>(widest);
        for (; i < end; ++i)
            if (i != widest) others.push_back(static_cast<std::uint32_t>(i));
    }
    samples.source.reserve(count);
    samples.cell.reserve(count - others.size());
    for (std::size_t first = 0; first < width; first += ScreenSamples::strip)
        for (std::size_t y = 0; y < height; ++y)
            for (std::size_t x = first; x < std::min(width, first + ScreenSamples::strip); ++x) {
                if (standing[y * width + x] == nobody) continue;
                samples.source.push_back(standing[y * width + x]);
                samples.cell.push_back(static_cast<std::uint32_t>(
                    ScreenSamples::margin + (y + 1) * static_cast<std::size_t>(samples.stride()) + x + 1));
            }
    samples.standing = samples.source.size();
    samples.source.insert(samples.source.end(), others.begin(), others.end());

    const auto put = [&](auto& planes, std::size_t i, Vec3 v) {
        planes[0][i] = static_cast<float>(dot(v, view.right));
        planes[1][i] = static_cast<float>(-dot(v, view.up));
        planes[2][i] = static_cast<float>(dot(v, view.forward));
    };
    parallelFor((padded + grain - 1) / grain, threads, [&](std::size_t part) {
        for (std::size_t i = part * grain; i < std::min(padded, (part + 1) * grain); ++i) {
            const std::uint32_t from = samples.source[std::min(i, count - 1)];
            const Vec3 offset = toDouble(visible.positions[from]) - visible.eye;
            // A shading normal that looks away spans no plane that is seen.
            const Vec3 shading = toDouble(visible.normals[from]);
            put(samples.position, i, offset);
            put(samples.normal, i, dot(shading, offset) < 0 ? shading : toDouble(visible.geometric_normals[from]));
            if (i < samples.standing) samples.depth[samples.cell[i]] = samples.position[2][i];
        }
    });
    return samples;
}

}  // namespace searchlight
