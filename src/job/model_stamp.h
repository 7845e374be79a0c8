// Whether a model's text is still the one that was read.
#pragma once

#include <string>

namespace searchlight {

/// Changes when a file of the model (or of a part of a sum) does; empty for what ships.
std::string modelStamp(const std::string& id);

}  // namespace searchlight
