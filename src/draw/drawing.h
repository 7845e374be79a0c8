// What a figure looks like, as shapes: SVG, PNG and PDF are written from the same list.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "draw/clip.h"

namespace searchlight {

/// Colours are "#rrggbb" literals, lengths px (1/96 inch), y grows downwards.
struct Stroke {
    std::string_view color;
    double width = 1;
    std::vector<double> dashes = {};  ///< lengths on, off, on...; empty: solid
};

struct Polyline {
    std::vector<Point> points;  ///< one point is a dot
    Stroke stroke;
};

/// Without outline.
struct Polygon {
    std::vector<Point> points;
    std::string_view color;
    double opacity = 1;
};

struct Box {
    Rect rect;
    std::string_view fill = {};     ///< empty: none
    std::string_view outline = {};  ///< empty: none
    double opacity = 1;             ///< of the fill
};

struct Circle {
    Point center;
    double radius = 1;
    std::string_view color;
};

enum class Anchor { start, middle, end };

struct Text {
    Point at;  ///< on the base line
    std::string text;
    double size = 12;
    Anchor anchor = Anchor::start;
    std::string_view color;
    bool bold = false;
    bool upwards = false;  ///< turned by 90 degrees about `at`
};

/// A picture, scaled into the box.
struct Picture {
    Rect rect;
    std::string png;  ///< the bytes of a file
};

using Shape = std::variant<Polyline, Polygon, Box, Circle, Text, Picture>;

/// Where the data of a panel stand, and their ranges.
struct PanelFrame {
    Rect rect;
    double x_min = 0, x_max = 1, y_min = 0, y_max = 1;
};

struct Drawing {
    double width = 0, height = 0;
    std::vector<Shape> shapes;       ///< later ones lie above
    std::vector<PanelFrame> frames;  ///< of a figure with panels or a map, in their order; without a hemisphere's
};

}  // namespace searchlight
