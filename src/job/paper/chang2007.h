// The plates of [Chang2007], by files.
#pragma once

#include <vector>

#include "job/paper/paper.h"
#include "job/paper/paper_studio.h"

namespace searchlight {

std::vector<PaperFigure> chang2007Tables();   ///< 4.1 to 4.4
std::vector<PaperFigure> chang2007Figures();  ///< 4.2 to 4.9

/// Those with the hybrid technique.
PaperPlate chang2007Figure45(const PaperRun& run);
PaperPlate chang2007Figure48(const PaperRun& run);
PaperPlate chang2007Figure49(const PaperRun& run);

/// What stands in for the thesis' scene, and how errors are meant.
void chooseScene(PaperPlate& plate, const PaperRun& run);

/// Another size is another scale of the medium: an object of 70 mm has the picture of one of 10 mm in a medium seven
/// times as dense, and all but the sum stays as it is.
void setSize(PaperStudio& studio, double size_mm);
void chooseSizes(PaperPlate& plate);

ParamValues samplesOf(double count);

}  // namespace searchlight
