// A figure as data: series with units. What computes it draws nothing; what draws it computes nothing.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace searchlight {

enum class AxisScale { linear, logarithmic, square_root };

struct Axis {
    std::string label;  ///< without unit
    std::string unit;   ///< empty: dimensionless
    AxisScale scale = AxisScale::linear;
    /// Shown range; equal ends: from the data.
    double min = 0, max = 0;
    /// Of things instead of numbers: the one at 0, at 1, ...; they are the only ticks. Linear.
    std::vector<std::string> names = {};
};

enum class SeriesStyle {
    line,
    steps,  ///< x holds n + 1 edges of n values: a histogram
    points
};

inline constexpr int neutral_color = -1;  ///< the reference
inline constexpr int outline_color = -2;  ///< light, to be seen on a false-colour map

struct Series {
    std::string label = {};
    SeriesStyle style = SeriesStyle::line;
    std::vector<double> x = {}, y = {};
    std::vector<double> lower = {}, upper = {};  ///< an uncertainty band, as long as y; or empty
    int color = -1;                              ///< index into the palette; or one of the two below
    bool dashed = false;
    bool in_legend = true;  ///< false: drawn, but without an entry
};

/// Values of cells, shown in false colour below the series.
struct FalseColor {
    std::vector<double> x_edges, y_edges;  ///< of the cells, ascending: columns + 1, rows + 1
    std::vector<double> values;            ///< row by row from the lowest y; NaN: nothing is known
    std::vector<double> standard_error;    ///< as long, or empty; written, not drawn
    /// The hemisphere seen from above: x is the azimuth from 0 to 360 degrees, counted from the right towards the top,
    /// y the polar angle in degrees from the middle. Otherwise both axes of the plane have one scale.
    bool hemisphere = false;
    double scale_bar = 0;  ///< its length in units of x; 0: none
};

/// One plot; or, with `panels`, several small ones under one title, caption and legend.
struct Figure {
    std::string title;
    std::string caption;  ///< conventions, what the band means
    Axis x, y;
    std::vector<Series> series;
    std::optional<FalseColor> map;
    Axis color;  ///< of the map, or of the maps of all panels; the linear or logarithmic scale of their values

    std::vector<Figure> panels;  ///< row by row; their captions, metadata and colour axes are not used
    int columns = 1;             ///< of panels
    /// Version, job, seed, backend...: written into the file, not drawn.
    std::vector<std::pair<std::string, std::string>> metadata;
};

}  // namespace searchlight
