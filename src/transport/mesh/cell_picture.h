// Pictures of what left a surface: each pixel is the mean of the cells behind it, for walks and for models alike.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/image.h"

namespace searchlight {

/// One of the rays through a pixel that meet the surface.
struct CellSample {
    std::uint32_t pixel = 0;  ///< y * width + x
    std::uint32_t cell = 0;
    float coverage = 0;  ///< of the pixel: one over its rays
    float exit = 0;      ///< T21 / (pi 4 C_phi(1/eta)) towards the camera: radiance over exitance, 1/sr
};

/// Which cells a camera sees; samples of one pixel are neighbours in the list.
struct CellView {
    int width = 0, height = 0;
    std::vector<CellSample> samples;
};

/// Values per cell for three channels; an empty list is a channel without values, which stays black.
using CellValues = std::array<std::span<const double>, 3>;

/// T21(wo) M / (pi 4 C_phi(1/eta)), "diffuse exit": what a model's picture is compared with.
Image pictureOfRadiance(const CellView& view, const CellValues& exitance);

/// The standard error of that picture. Cells of a pixel count as independent; their rays share the cell's error.
Image pictureOfError(const CellView& view, const CellValues& standard_error);

/// The mean exitance behind each pixel, premultiplied by coverage.
Image pictureOfExitance(const CellView& view, const CellValues& exitance);

/// In r the cell behind the pixel's middle sample, from 1; 0 where nothing is seen.
Image pictureOfCells(const CellView& view);

/// 1 / (pi 4 C_phi(1/eta)) times T21 for a direction outside under this cosine.
double exitFactor(double eta, double cosine);

}  // namespace searchlight
