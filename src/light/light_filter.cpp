#include "light/light_filter.h"

#include <algorithm>
#include <cmath>

#include "io/image_file.h"
#include "light/picture_light.h"

namespace searchlight {

namespace {

// x and y in pixels of the level; what lies beyond the border is like the border.
Rgb bilinear(const Image& level, double x, double y) {
    x = std::clamp(x - 0.5, 0.0, level.width - 1.0);
    y = std::clamp(y - 0.5, 0.0, level.height - 1.0);
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const double s = x - x0, t = y - y0;
    Rgb sum;
    for (const int dy : {0, 1})
        for (const int dx : {0, 1}) {
            const Rgba& p = level.at(std::min(x0 + dx, level.width - 1), std::min(y0 + dy, level.height - 1));
            sum = sum + ((dx ? s : 1 - s) * (dy ? t : 1 - t)) * Rgb{p.r, p.g, p.b};
        }
    return sum;
}

}  // namespace

LightFilter::LightFilter(const std::string& path, Vec3 direction, double radius_mm)
    : LightFilter(readImage(path).image, path, direction, radius_mm) {}

LightFilter::LightFilter(const Image& picture, const std::string& name, Vec3 direction, double radius_mm) {
    checkPicture(picture, name);
    const Vec3 forward = -1.0 * normalize(direction);
    // Within a hundredth of a degree of straight down, "up" would be rounding.
    const bool vertical = std::hypot(forward.x, forward.z) < 2e-4;
    right_ = normalize(cross(forward, vertical ? Vec3{0, 0, forward.y < 0 ? -1.0 : 1.0} : Vec3{0, 1, 0}));
    up_ = cross(right_, forward);
    pixel_mm_ = 2 * radius_mm / std::min(picture.width, picture.height);

    Image passed = picture;
    for (Rgba& p : passed.pixels) {
        const float hole = std::clamp(1 - p.a, 0.0f, 1.0f);
        p = {std::max(p.r, 0.0f) + hole, std::max(p.g, 0.0f) + hole, std::max(p.b, 0.0f) + hole, 1};
    }
    levels_.push_back(std::move(passed));
    while (levels_.back().width > 1 || levels_.back().height > 1)
        levels_.push_back(
            shrunk(levels_.back(), std::max(1, levels_.back().width / 2), std::max(1, levels_.back().height / 2)));
}

Rgb LightFilter::operator()(Vec3 position, double width_mm) const {
    const Image& finest = levels_.front();
    const double x = 0.5 + dot(position, right_) / (pixel_mm_ * finest.width);
    const double y = 0.5 - dot(position, up_) / (pixel_mm_ * finest.height);
    const auto at = [&](std::size_t level) {
        return bilinear(levels_[level], x * levels_[level].width, y * levels_[level].height);
    };
    const double last = static_cast<double>(levels_.size() - 1);
    const double depth = std::clamp(std::log2(std::max(width_mm / pixel_mm_, 1.0)), 0.0, last);
    const auto level = static_cast<std::size_t>(depth);
    const double t = depth - static_cast<double>(level);
    return t > 0 ? (1 - t) * at(level) + t * at(level + 1) : at(level);
}

}  // namespace searchlight
