// How far a model's lit sphere is from the walks', and how much of that is noise.
#pragma once

#include <array>

#include "render/sphere/sphere_integral.h"
#include "transport/mesh/cell_picture.h"

namespace searchlight {

/// Of one channel of the picture that a camera sees, relative to the reference's mean radiance there.
struct SphereError {
    double model = 0, reference = 0;  ///< mean radiance over the pixels that the sphere covers
    Estimate mean_difference;         ///< model over reference - 1, with the noise of both
    double rmse = 0;                  ///< of pixels, both noises in it
    double noise = 0;                 ///< the RMSE that two pictures of one expectation would have
    double bias = 0;                  ///< what is left: sqrt(rmse^2 - noise^2), 0 where noise is all there is
};

/// By channel; not finite where the reference sees nothing. Both hold every cell that the view shows.
std::array<SphereError, Rgb::channels> sphereErrors(const CellView& view, const SphereExitance& model,
                                                    const SphereExitance& reference);

/// The spans that pictures are made of.
CellValues cellValues(const std::array<std::vector<double>, Rgb::channels>& values);

/// Stops that bring the brightest 2 % of the covered pixels to 0.8.
double suitedExposure(const Image& image);

}  // namespace searchlight
