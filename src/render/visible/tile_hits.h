// What rays of a tile of a picture hit, by whatever means it is found.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace searchlight {

/// A piece of a picture, in pixels. It is looked at through a window that is one pixel wider on every side: pixel
/// (x, y) of the picture stands at Tile::at(x - left + 1, y - top + 1) of a plane.
struct Tile {
    static constexpr int side = 64;
    static constexpr int window = side + 2;
    /// Of a plane: whole vectors reach beyond a row, and blocks of four rows beyond the last one.
    static constexpr int stride = 80, plane = stride * (window + 4);

    int left = 0, top = 0, width = 0, height = 0;  ///< within the picture: at most `side`

    static std::size_t at(int x, int y) { return static_cast<std::size_t>(y * stride + x); }
};

/// Hits, plane by plane.
struct Hits {
    std::vector<float> inverse_depth;     ///< 1/mm along the camera's forward axis; 0: nothing is hit
    std::vector<std::uint32_t> triangle;  ///< where something is hit
    std::vector<float> u, v;              ///< barycentric, as in RayHit

    /// Room for `count` hits and a vector more; none of them hits anything.
    void clear(std::size_t count) {
        inverse_depth.assign(count + 16, 0.0f);
        for (auto* plane : {&u, &v}) plane->resize(count + 16);
        triangle.resize(count + 16);
    }
};

/// Finds hits. Called from many threads, each with a tile of its own.
class HitSource {
public:
    virtual ~HitSource() = default;

    /// Through the centres of the window's pixels that lie in the picture; false when nothing is hit. `hits` has been
    /// cleared for Tile::plane.
    virtual bool centres(const Tile& tile, Hits& hits) const = 0;

    /// Through the points of the edge pattern in some pixels, each Tile::side * y + x within the tile, ascending. Hit k
    /// of pixel i stands at i * stride + k. `hits` has been cleared; stride is a multiple of 8 and may be larger than
    /// the pattern.
    virtual void samples(const Tile& tile, std::span<const std::uint16_t> pixels, std::size_t stride,
                         Hits& hits) const = 0;
};

}  // namespace searchlight
