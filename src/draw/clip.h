// Cutting lines and areas to the plot's frame: not every renderer of SVG knows clip paths.
#pragma once

#include <span>
#include <vector>

namespace searchlight {

struct Point {
    double x = 0, y = 0;
    bool operator==(const Point&) const = default;
};

struct Rect {
    double left = 0, top = 0, right = 0, bottom = 0;  ///< left <= right, top <= bottom
    double width() const { return right - left; }
    double height() const { return bottom - top; }
    bool contains(Point p) const { return p.x >= left && p.x <= right && p.y >= top && p.y <= bottom; }
};

/// The pieces of an open line inside the frame. A point with NaN breaks the line; a point alone is a piece of one.
std::vector<std::vector<Point>> clipPolyline(std::span<const Point> line, const Rect& frame);

/// The closed outline cut to the frame; empty when outside. No NaN.
std::vector<Point> clipPolygon(std::vector<Point> outline, const Rect& frame);

}  // namespace searchlight
