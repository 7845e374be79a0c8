// The key to a figure's series, and the place where it hides least.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/figure.h"
#include "draw/clip.h"
#include "draw/drawing.h"

namespace searchlight {

/// How a series looks; also used for its curve.
struct SeriesLook {
    std::string_view color;
    double width = 1.8;
    std::vector<double> dashes;
    double band_opacity = 0.16;
};

/// A point of a series: hollow where its line would be dashed.
void drawMarker(std::vector<Shape>& shapes, Point center, double radius, const SeriesLook& look);

struct LegendEntry {
    std::string label;
    SeriesStyle style = SeriesStyle::line;
    SeriesLook look;
    bool band = false;
};

struct LegendSize {
    double width = 0, height = 0;
};

LegendSize legendSize(std::span<const LegendEntry> entries);

/// Points every few px on what a legend should leave free.
struct DrawnData {
    std::vector<Point> lines;  ///< curves and markers
    std::vector<Point> bands;  ///< outlines of bands: may be covered, if it must be
};

struct LegendPlace {
    Rect box;
    int covered = 0;  ///< points of lines under the box
};

/// The box of that size within `plot` that covers the fewest lines, then bands; corners are preferred.
LegendPlace placeLegend(const LegendSize& size, const Rect& plot, const DrawnData& data);

void drawLegend(std::vector<Shape>& shapes, std::span<const LegendEntry> entries, const Rect& box);

/// Entries in columns without a box, as wide as `width` lets them; starts at `at`. Returns the height.
double drawLegendRows(std::vector<Shape>& shapes, std::span<const LegendEntry> entries, Point at, double width);

}  // namespace searchlight
