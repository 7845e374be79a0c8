// Error against time of techniques that draw the same picture, each at several budgets.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/figure.h"

namespace searchlight {

struct TimedErrors {
    std::string label;
    std::size_t color = 0;             ///< the same in all panels
    std::vector<double> time_ms;       ///< one per budget, from cheap to dear
    std::vector<double> error;         ///< relative; as many
    std::vector<double> lower, upper;  ///< what is known of it; as many
};

/// One kind of device.
struct TimedPanel {
    std::string title;  ///< "CPU"
    std::vector<TimedErrors> techniques;
};

/// A level to be seen beside the errors: a model's own, or a reference's noise.
struct ErrorLevel {
    std::string label;
    double error = 0;  ///< relative
};

/// Both axes logarithmic, a panel for each device. Errors of 0 are not shown. Throws an input Error when there is
/// nothing to show.
Figure errorOverTimeFigure(const std::vector<TimedPanel>& panels, const std::vector<ErrorLevel>& levels,
                           const std::string& title, const std::string& error_label);

}  // namespace searchlight
