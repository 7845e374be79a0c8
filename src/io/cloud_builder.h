// Points from the attributes of a particle file, whatever its layout.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "io/shape_formats.h"

namespace searchlight {

/// One attribute of the points of a particle file.
struct CloudAttribute {
    std::string name;
    std::size_t size = 1;  ///< numbers per point
};

class CloudBuilder {
public:
    /// Takes "position" or "P", "normal" or "N", and the best of areaRule's names: an area says more than a radius, a
    /// radius more than a width.
    explicit CloudBuilder(std::span<const CloudAttribute> attributes);

    bool hasPositions() const { return position_.has_value(); }

    /// Adds a point; number(a, k) is number k of attribute a. Returns what is wrong with it, if anything is. Requires
    /// hasPositions().
    template <class Number>
    std::optional<std::string_view> add(const Number& number) {
        const auto vector = [&](std::size_t a) { return Vec3f{number(a, 0), number(a, 1), number(a, 2)}; };
        cloud_.positions.push_back(vector(*position_));
        if (!isFinite(cloud_.positions.back())) return "a position is not finite";
        if (normal_) cloud_.normals.push_back(vector(*normal_));
        if (!area_) return std::nullopt;
        const std::optional<float> area = areaOf(rule_, number(*area_, 0));
        if (!area) return "an area or radius is negative or not finite";
        cloud_.areas.push_back(*area);
        return std::nullopt;
    }

    PointCloud finish();

private:
    std::optional<std::size_t> position_, normal_, area_;
    AreaRule rule_ = AreaRule::area;
    PointCloud cloud_;
};

}  // namespace searchlight
