// The plates of [Chang2007], by files.
#pragma once

#include <vector>

#include "job/paper/paper.h"

namespace searchlight {

std::vector<PaperFigure> chang2007Tables();   ///< 4.1 to 4.4
std::vector<PaperFigure> chang2007Figures();  ///< 4.2 to 4.9

}  // namespace searchlight
