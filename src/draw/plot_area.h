// Inside the frame: grid, axes, curves and their bands.
#pragma once

#include <string>
#include <vector>

#include "base/figure.h"
#include "draw/axis_map.h"
#include "draw/clip.h"
#include "draw/drawing.h"
#include "draw/legend.h"
#include "draw/ticks.h"

namespace searchlight {

inline constexpr std::string_view ink = "#1a1a1a";
inline constexpr double tick_size = 12, superscript_size = 9;

/// By palette colour, or neutral for the reference.
SeriesLook lookOf(const Series& series);

/// Width of a tick's label with its exponent, px.
double labelWidth(const Tick& tick);

/// "10" and its exponent meet at `joint`, so that no font's width can pull them apart.
void drawPower(std::vector<Shape>& shapes, Point joint, std::string_view base, std::string_view exponent);

class PlotArea {
public:
    PlotArea(const Figure& figure, const Rect& frame, const FigureRange& range, const AxisTicks& x_ticks,
             const AxisTicks& y_ticks);

    void drawGrid(std::vector<Shape>& shapes) const;
    /// Frame, ticks and their labels, which stand outside.
    void drawAxes(std::vector<Shape>& shapes) const;
    /// Every band, then every curve, the neutral ones above the others; `data` learns where they run.
    void drawSeries(std::vector<Shape>& shapes, DrawnData& data) const;

private:
    struct Extent {
        double left, right;
    };

    Extent extent(const Series& series, size_t i) const;
    void drawBand(std::vector<Shape>& shapes, const Series& series, DrawnData& data) const;
    void drawErrorBars(std::vector<Shape>& shapes, const Series& series) const;
    void drawCurve(std::vector<Shape>& shapes, const Series& series, DrawnData& data) const;
    void drawMarkers(std::vector<Shape>& shapes, const Series& series, DrawnData& data) const;

    const Figure& figure_;
    const AxisTicks &x_ticks_, &y_ticks_;
    Rect frame_;
    AxisMap x_, y_;
};

}  // namespace searchlight
