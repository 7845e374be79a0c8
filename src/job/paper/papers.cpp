#include "job/paper/paper.h"

namespace searchlight {

std::span<const Paper> papers() {
    static const std::vector<Paper> table{frisvad2014Paper(), freude2014Paper()};
    return table;
}

}  // namespace searchlight
