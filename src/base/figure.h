// A figure as data: series with units. What computes it draws nothing; what draws it computes nothing.
#pragma once

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
};

enum class SeriesStyle {
    line,
    steps,  ///< x holds n + 1 edges of n values: a histogram
    points
};

struct Series {
    std::string label = {};
    SeriesStyle style = SeriesStyle::line;
    std::vector<double> x = {}, y = {};
    std::vector<double> lower = {}, upper = {};  ///< an uncertainty band, as long as y; or empty
    int color = -1;                              ///< index into the palette; -1: neutral (reference)
    bool dashed = false;
    bool in_legend = true;  ///< false: drawn, but without an entry
};

struct Figure {
    std::string title;
    std::string caption;  ///< conventions, what the band means
    Axis x, y;
    std::vector<Series> series;
    std::vector<Figure> below = {};  ///< lower panels, their frames flush with this one's; without panels of their own
    /// Version, job, seed, backend...: written into the file, not drawn.
    std::vector<std::pair<std::string, std::string>> metadata;
};

}  // namespace searchlight
