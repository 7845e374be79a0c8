#include "base/version.h"

namespace searchlight {

std::string_view version() { return SEARCHLIGHT_VERSION; }

}  // namespace searchlight
