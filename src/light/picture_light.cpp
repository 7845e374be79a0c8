#include "light/picture_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace searchlight {

namespace {

constexpr double pi = std::numbers::pi;

Rgba blend(double s, const Rgba& a, double t, const Rgba& b) {
    const auto mix = [&](float x, float y) { return static_cast<float>(s * x + t * y); };
    return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b), mix(a.a, b.a)};
}

// x and y in pixels; clamped at the border.
Rgba bilinear(const Image& picture, double x, double y) {
    x = std::clamp(x - 0.5, 0.0, picture.width - 1.0);
    y = std::clamp(y - 0.5, 0.0, picture.height - 1.0);
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const int x1 = std::min(x0 + 1, picture.width - 1), y1 = std::min(y0 + 1, picture.height - 1);
    const double s = x - x0, t = y - y0;
    return blend(1 - t, blend(1 - s, picture.at(x0, y0), s, picture.at(x1, y0)), t,
                 blend(1 - s, picture.at(x0, y1), s, picture.at(x1, y1)));
}

// Where in the unit square, y downwards, a round picture shows `direction` (unit).
std::array<double, 2> placeOnBall(Vec3 direction, const std::string& layout) {
    double x = 0, y = 0;
    if (layout == "mirror_ball") {
        // Photographed from +z, far away: the mirror's normal is halfway between the photographer and the light.
        const double z = direction.z + 1;
        const double size = std::sqrt(direction.x * direction.x + direction.y * direction.y + z * z);
        if (size < 1e-9) return {0.5, 0};  // straight behind the ball: all of the rim
        x = direction.x / size, y = direction.y / size;
    } else {
        const double sine = std::hypot(direction.x, direction.y);
        const double radius = std::atan2(sine, -direction.z) / pi;
        if (sine > 0) x = radius * direction.x / sine, y = radius * direction.y / sine;
    }
    return {0.5 * (x + 1), 0.5 * (1 - y)};
}

Image unwrapped(const Image& ball, const std::string& layout) {
    // As many rows as the ball has: its middle, where a pixel covers least, is then hardly enlarged.
    const int height = std::max(ball.height, 2), width = 2 * height;
    constexpr int parts = 3;  // across a pixel: the ball's rim is compressed and would alias
    Image picture(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            Rgba sum{0, 0, 0, 0};
            for (int part = 0; part < parts * parts; ++part) {
                const double u = (x + (part % parts + 0.5) / parts) / width;
                const double v = (y + (part / parts + 0.5) / parts) / height;
                const double phi = 2 * pi * (u - 0.5), theta = pi * v;
                const Vec3 direction{std::sin(theta) * std::sin(phi), std::cos(theta),
                                     -std::sin(theta) * std::cos(phi)};
                const auto [bx, by] = placeOnBall(direction, layout);
                sum = blend(1, sum, 1.0 / (parts * parts), bilinear(ball, bx * ball.width, by * ball.height));
            }
            picture.at(x, y) = sum;
        }
    return picture;
}

}  // namespace

void checkPicture(const Image& picture, const std::string& name) {
    if (picture.empty()) throw inputError("a picture without pixels").at(name);
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const Rgba& p = picture.at(x, y);
            if (!std::isfinite(p.r + p.g + p.b + p.a))
                throw inputError(fmt::format("pixel {}, {} is infinite or not a number: no light", x, y),
                                 "counted from the top left, from 0")
                    .at(name);
        }
}

Image latitudeLongitude(Image picture, const std::string& layout, const std::string& name) {
    checkPicture(picture, name);
    for (Rgba& p : picture.pixels) p = {std::max(p.r, 0.0f), std::max(p.g, 0.0f), std::max(p.b, 0.0f), 1};
    const std::string size = fmt::format("{} x {} pixels", picture.width, picture.height);
    const auto off = [&](int ratio) { return std::abs(picture.width - ratio * picture.height) > 0.01 * picture.width; };
    if (layout == "latlong") {
        if (off(2))
            throw inputError(size + " are no latitude-longitude picture", "expected twice as wide as high").at(name);
        return picture;
    }
    if (off(1)) throw inputError(size + " are no picture of a ball", "expected a square").at(name);
    return unwrapped(picture, layout);
}

Image shrunk(const Image& picture, int width, int height) {
    width = std::min(width, picture.width), height = std::min(height, picture.height);
    // One direction after the other: source pixels by how much of them lies within the target's.
    const auto reduce = [](int from, int to, const auto& add) {
        for (int target = 0; target < to; ++target) {
            const double begin = static_cast<double>(target) * from / to;
            const double end = static_cast<double>(target + 1) * from / to;
            for (int source = static_cast<int>(begin); source < from && source < end; ++source)
                add(target, source, (std::min(end, source + 1.0) - std::max(begin, source + 0.0)) / (end - begin));
        }
    };
    Image narrow(width, picture.height);
    reduce(picture.width, width, [&](int target, int source, double weight) {
        for (int y = 0; y < picture.height; ++y)
            narrow.at(target, y) = blend(1, narrow.at(target, y), weight, picture.at(source, y));
    });
    Image small(width, height);
    reduce(picture.height, height, [&](int target, int source, double weight) {
        for (int x = 0; x < width; ++x)
            small.at(x, target) = blend(1, small.at(x, target), weight, narrow.at(x, source));
    });
    return small;
}

}  // namespace searchlight
