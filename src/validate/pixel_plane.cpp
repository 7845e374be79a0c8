#include "validate/pixel_plane.h"

#include <algorithm>
#include <cassert>

#include "base/parallel.h"

namespace searchlight {

PixelPlane filtered(const PixelPlane& plane, std::span<const float> along_x, std::span<const float> along_y,
                    int threads) {
    assert(along_x.size() % 2 == 1 && along_y.size() % 2 == 1);
    const int width = plane.width, height = plane.height;
    const int reach_x = static_cast<int>(along_x.size() / 2), reach_y = static_cast<int>(along_y.size() / 2);
    PixelPlane rows(width, height), result(width, height);
    const auto row_of = [&](const PixelPlane& of, int y) {
        return of.values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    };
    parallelFor(static_cast<std::size_t>(height), threads, [&](std::size_t row) {
        const float* const from = row_of(plane, static_cast<int>(row));
        float* const to = rows.values.data() + row * static_cast<std::size_t>(width);
        for (int x = 0; x < width; ++x) {
            float sum = 0;
            for (int i = -reach_x; i <= reach_x; ++i)
                sum += along_x[static_cast<std::size_t>(i + reach_x)] * from[std::clamp(x + i, 0, width - 1)];
            to[x] = sum;
        }
    });
    parallelFor(static_cast<std::size_t>(height), threads, [&](std::size_t row) {
        float* const to = result.values.data() + row * static_cast<std::size_t>(width);
        for (int i = -reach_y; i <= reach_y; ++i) {
            const float weight = along_y[static_cast<std::size_t>(i + reach_y)];
            const float* const from = row_of(rows, std::clamp(static_cast<int>(row) + i, 0, height - 1));
            for (int x = 0; x < width; ++x) to[x] += weight * from[x];
        }
    });
    return result;
}

}  // namespace searchlight
