// The cells of a reference's surface that a camera sees.
#pragma once

#include "render/view.h"
#include "transport/mesh/cell_picture.h"
#include "transport/mesh/closed_body.h"

namespace searchlight {

/// Nine rays through each pixel, each with the cell that it meets and the share of the cell's exitance that goes its
/// way, for a medium of that relative index.
CellView cellView(const View& camera, const Ball& ball, double eta, int threads = 0);
CellView cellView(const View& camera, const MeshBody& body, double eta, int threads = 0);

}  // namespace searchlight
