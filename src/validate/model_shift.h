// How far a model moves light that comes at an angle.
#pragma once

#include <vector>

#include "model/plane.h"

namespace searchlight {

/// Mean exit point of what leaves, mm, per channel; the refracted beam leans towards +x. Exactly 0 for a model that
/// does not read the direction of incidence. Good to some 1e-3 relative: R_d is summed over the logarithm of r from
/// 1e-4 to 1e4 mean free paths, and over the azimuth. The evaluator has been set to the medium.
Rgb modelMeanX(Evaluator& evaluator, const Model& model, const Medium& medium, double angle_deg);

/// R_d of one channel as means over the cells of RankReference::plane, from a square of points in each: eight a side,
/// two for a model that depends on the direction of exit, which costs as much more.
std::vector<double> modelPlane(Evaluator& evaluator, const Model& model, const Medium& medium, double angle_deg,
                               int channel, int cells, double cell_mm);

}  // namespace searchlight
