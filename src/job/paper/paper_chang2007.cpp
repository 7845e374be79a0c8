#include "job/paper/chang2007.h"

namespace searchlight {

Paper chang2007Paper() {
    return {.id = "chang2007",
            .citation =
                "C.-W. Chang, Real-Time Translucent Rendering using Texture Space Importance Sampling, "
                "National Chiao Tung University, 2007",
            .figures = chang2007Figures(),
            .tables = chang2007Tables()};
}

}  // namespace searchlight
