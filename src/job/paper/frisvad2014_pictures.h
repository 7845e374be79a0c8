// The pictures of [Frisvad2014]: lit objects by four models and by walks.
#pragma once

#include "job/paper/paper.h"

namespace searchlight::frisvad2014 {

PaperPlate figure1(const PaperRun& run);   ///< a scan in white grapefruit juice
PaperPlate figure7(const PaperRun& run);   ///< simple shapes in eight materials
PaperPlate figure8(const PaperRun& run);   ///< the scan in marble
PaperPlate figure9(const PaperRun& run);   ///< RMSE and SSIM of figure 7
PaperPlate figure10(const PaperRun& run);  ///< squared differences of figures 1 and 8
PaperPlate figure11(const PaperRun& run);  ///< light from many directions
PaperPlate figure14(const PaperRun& run);  ///< planes that the image is mirrored in
PaperPlate figure15(const PaperRun& run);  ///< the reciprocal mean

}  // namespace searchlight::frisvad2014
