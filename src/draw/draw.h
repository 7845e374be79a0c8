// A Figure on paper: SVG always, PNG and PDF through Qt, CSV of its numbers.
#pragma once

#include <filesystem>
#include <string>

#include "base/figure.h"

namespace searchlight {

/// The figure as a self-contained SVG document: axes with units, legend, bands, caption; metadata inside.
std::string figureSvg(const Figure& figure);

/// The numbers: a '#' header with caption and metadata, then one row per x of each series; with panels or a map, a table
/// panel, series, x, x_end, y, y_end, value, lower, upper.
std::string figureCsv(const Figure& figure);

/// Chooses by ending: .svg, .csv, .png, .pdf. Throws a usage Error for another ending, or for .png and .pdf in a
/// build without Qt.
void drawFigure(const Figure& figure, const std::filesystem::path& path);

/// The endings that drawFigure takes in this build.
std::vector<std::string> figureFormats();

}  // namespace searchlight
