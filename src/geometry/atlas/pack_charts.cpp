#include "geometry/atlas/pack_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "base/error.h"

namespace searchlight {

namespace {

// Rows of bits, a texel each.
class Bits {
public:
    Bits(int width, int height)
        : width_(width), height_(height), words_((width + 63) / 64), bits_(static_cast<std::size_t>(words_ * height)) {}

    int width() const { return width_; }
    int height() const { return height_; }
    void set(int x, int y) { at(x / 64, y) |= std::uint64_t{1} << (x % 64); }
    bool get(int x, int y) const { return bits_[index(x / 64, y)] >> (x % 64) & 1; }

    bool meets(const Bits& other, int x, int y) const {
        for (int row = 0; row < other.height_; ++row)
            for (int word = 0; word < other.words_; ++word)
                if (other.bits_[other.index(word, row)] & window(x + 64 * word, y + row)) return true;
        return false;
    }

    void put(const Bits& other, int x, int y) {
        const int shift = x % 64;
        for (int row = 0; row < other.height_; ++row)
            for (int word = 0; word < other.words_; ++word) {
                const std::uint64_t bits = other.bits_[other.index(word, row)];
                const int to = x / 64 + word;
                if (to < words_) at(to, y + row) |= bits << shift;
                if (shift > 0 && to + 1 < words_) at(to + 1, y + row) |= bits >> (64 - shift);
            }
    }

private:
    std::size_t index(int word, int row) const { return static_cast<std::size_t>(row * words_ + word); }
    std::uint64_t& at(int word, int row) { return bits_[index(word, row)]; }
    // 64 bits from x on; beyond the end 0.
    std::uint64_t window(int x, int row) const {
        const int word = x / 64, shift = x % 64;
        const std::uint64_t low = word < words_ ? bits_[index(word, row)] >> shift : 0;
        return shift > 0 && word + 1 < words_ ? low | bits_[index(word + 1, row)] << (64 - shift) : low;
    }

    int width_, height_, words_;
    std::vector<std::uint64_t> bits_;
};

// Whether a triangle and the unit square with its low corner at (x, y) meet; touching counts.
bool touches(const FlatTriangle& triangle, double x, double y) {
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec2 a = triangle[k], side = triangle[(k + 1) % 3] - a;
        // The corner of the square that is farthest to the inside, which is on the left.
        const Vec2 corner{x + (side.y < 0 ? 1 : 0), y + (side.x > 0 ? 1 : 0)};
        if (cross(side, corner - a) < 0) return false;
    }
    return true;
}

// Texels that a chart touches, widened on all sides by the gutter.
Bits textureOf(std::span<const FlatTriangle> chart, double scale, int width, int height, int gutter) {
    Bits bits(width + 2 * gutter, height + 2 * gutter);
    for (FlatTriangle triangle : chart) {
        for (Vec2& p : triangle) p = scale * p;
        const auto [low_x, high_x] = std::minmax({triangle[0].x, triangle[1].x, triangle[2].x});
        const auto [low_y, high_y] = std::minmax({triangle[0].y, triangle[1].y, triangle[2].y});
        for (int y = std::max(0, static_cast<int>(low_y)); y <= std::min(height - 1, static_cast<int>(high_y)); ++y)
            for (int x = std::max(0, static_cast<int>(low_x)); x <= std::min(width - 1, static_cast<int>(high_x)); ++x)
                if (!bits.get(x + gutter, y + gutter) && touches(triangle, x, y)) bits.set(x + gutter, y + gutter);
    }
    if (gutter == 0) return bits;
    Bits wide(bits.width(), bits.height());
    for (int y = 0; y < bits.height(); ++y)
        for (int x = 0; x < bits.width(); ++x) {
            if (!bits.get(x, y)) continue;
            for (int j = std::max(0, y - gutter); j <= std::min(bits.height() - 1, y + gutter); ++j)
                for (int i = std::max(0, x - gutter); i <= std::min(bits.width() - 1, x + gutter); ++i) wide.set(i, j);
        }
    return wide;
}

struct Turned {
    FlatChart triangles;  // low corner of the box at the origin
    double width = 0, height = 0, area = 0;
};

// The turn, among 48 in a quarter, with the smallest box; lying, not standing.
Turned turned(const FlatChart& chart) {
    Turned best;
    double smallest = std::numeric_limits<double>::infinity();
    constexpr int turns = 48;
    for (int k = 0; k < turns; ++k) {
        const double angle = std::numbers::pi / 2 * k / turns;
        const Vec2 u{std::cos(angle), std::sin(angle)};
        double low_x = 1e300, high_x = -1e300, low_y = 1e300, high_y = -1e300;
        for (const FlatTriangle& triangle : chart)
            for (const Vec2 p : triangle) {
                const double x = dot(u, p), y = cross(u, p);
                low_x = std::min(low_x, x), high_x = std::max(high_x, x);
                low_y = std::min(low_y, y), high_y = std::max(high_y, y);
            }
        if ((high_x - low_x) * (high_y - low_y) >= smallest) continue;
        smallest = (high_x - low_x) * (high_y - low_y);
        const bool lying = high_x - low_x >= high_y - low_y;
        best = {.width = lying ? high_x - low_x : high_y - low_y, .height = lying ? high_y - low_y : high_x - low_x};
        for (const FlatTriangle& triangle : chart) {
            FlatTriangle& to = best.triangles.emplace_back();
            for (std::size_t i = 0; i < 3; ++i) {
                const double x = dot(u, triangle[i]) - low_x, y = cross(u, triangle[i]) - low_y;
                // A quarter turn keeps the orientation.
                to[i] = lying ? Vec2{x, y} : Vec2{high_y - low_y - y, x};
            }
        }
    }
    for (const FlatTriangle& t : best.triangles) best.area += cross(t[1] - t[0], t[2] - t[0]) / 2;
    return best;
}

struct Place {
    int x = 0, y = 0;
};

// Where each chart's texture begins, largest charts first, each at the lowest row with room; none where one has no
// room.
std::optional<std::vector<Place>> placesAt(double scale, std::span<const Turned> charts, int resolution, int gutter) {
    // The border of the square serves as a gutter: nothing wraps around.
    Bits taken(resolution + 2 * gutter, resolution + 2 * gutter);
    std::vector<Place> places(charts.size());
    int first_row = 0;  // rows below are full for the small ones
    for (std::size_t i = 0; i < charts.size(); ++i) {
        const int width = static_cast<int>(scale * charts[i].width) + 1,
                  height = static_cast<int>(scale * charts[i].height) + 1;
        if (width > resolution || height > resolution) return std::nullopt;
        const Bits texture = textureOf(charts[i].triangles, scale, width, height, gutter);
        // What is taken keeps its own texels, and the gutter comes with what is put down.
        const Bits own = textureOf(charts[i].triangles, scale, width, height, 0);
        const bool tiny = width * height <= 4;
        bool found = false;
        for (int y = tiny ? first_row : 0; y + height <= resolution && !found; ++y)
            for (int x = 0; x + width <= resolution && !found; ++x) {
                if (taken.meets(own, x + gutter, y + gutter)) continue;
                taken.put(texture, x, y);
                places[i] = {x, y};
                if (tiny) first_row = y;
                found = true;
            }
        if (!found) return std::nullopt;
    }
    return places;
}

}  // namespace

Packing packCharts(const std::vector<FlatChart>& charts, int resolution, int gutter) {
    std::vector<Turned> all;
    for (const FlatChart& chart : charts) all.push_back(turned(chart));
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return all[a].width > all[b].width; });
    std::vector<Turned> sorted;
    double area = 0;
    for (const std::size_t i : order) sorted.push_back(std::move(all[i])), area += sorted.back().area;

    // From a scale at which the charts would fill the whole square down by steps of 3 %.
    double scale = resolution * std::sqrt(1 / std::max(area, 1e-300));
    std::optional<std::vector<Place>> places;
    constexpr double step = 0.97;
    for (int k = 0; k < 220 && !places; ++k) {
        scale *= step;
        places = placesAt(scale, sorted, resolution, gutter);
    }
    if (!places)
        throw usageError(
            fmt::format("an atlas of {0} x {0} texels has no room for {1} charts", resolution, charts.size()),
            "a larger --atlas");
    Packing packing{.texels_per_unit = scale, .placed = std::vector<std::vector<FlatTriangle>>(charts.size())};
    for (std::size_t k = 0; k < sorted.size(); ++k) {
        std::vector<FlatTriangle>& to = packing.placed[order[k]];
        to = std::move(sorted[k].triangles);
        const Vec2 at{static_cast<double>((*places)[k].x), static_cast<double>((*places)[k].y)};
        for (FlatTriangle& triangle : to)
            for (Vec2& p : triangle) p = scale * p + at;
    }
    return packing;
}

}  // namespace searchlight
