// A sweep: one scene, and what changes in it from picture to picture. docs/sweep.md describes its JSON.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/image_file.h"
#include "job/job.h"

namespace searchlight {

struct SweepAxis {
    std::string key;                  ///< "material", "/camera/azimuth_deg", "technique"
    std::string title;                ///< "Azimuth (deg)"
    std::vector<std::string> labels;  ///< one per value
};

struct SweepCell {
    std::size_t number = 1;            ///< of its files; the last axis changes fastest
    std::vector<std::size_t> choices;  ///< the index of the value on each axis
    Job job;                           ///< of `render`, without output
};

/// What shares an exposure, so that its pictures can be compared.
enum class SharedExposure { sheet, row, column, cell };

/// How the contact sheet shows the cells.
struct SheetPlan {
    std::vector<std::size_t> columns, rows;  ///< indices of axes, the last changing fastest; together all of them
    SharedExposure shared = SharedExposure::sheet;
    std::optional<double> stops;  ///< in place of an exposure that suits the pictures
    ToneMap::Curve curve = ToneMap::Curve::srgb;
    int width = 0;  ///< of a picture on the sheet, px; 0: half its pixels, which is all of them in a .png
};

struct Sweep {
    std::string title;
    std::string caption;
    std::vector<SweepAxis> axes;
    std::vector<SweepCell> cells;  ///< by number
    SheetPlan sheet;
};

/// Reads "searchlight-sweep/1" and spells out its cells. Throws an input Error with file, line and column, whose
/// message starts with the JSON pointer of the value that is wrong. Files that cells name are not opened.
Sweep parseSweep(std::string_view text, std::string_view path);

/// "marble, dipole": its labels, axis by axis.
std::string cellName(const Sweep& sweep, const SweepCell& cell);

/// The cells with the indices `first`, `first + step`... in the order in which a renderer that keeps its stages has
/// least to do: object before lights before material before model before the rest.
std::vector<const SweepCell*> cellsInOrder(const Sweep& sweep, std::size_t first, std::size_t step);

}  // namespace searchlight
