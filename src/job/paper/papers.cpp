#include "job/paper/paper.h"

namespace searchlight {

std::span<const Paper> papers() {
    static const std::vector<Paper> table{mertens2003Paper(), chang2007Paper(), frisvad2014Paper(), freude2014Paper()};
    return table;
}

}  // namespace searchlight
