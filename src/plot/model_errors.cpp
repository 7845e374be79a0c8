#include "plot/model_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace searchlight {

namespace {

// Models stand beside each other within this part of the distance between two kinds.
constexpr double spread = 0.6;

// Percent. Far beyond the light itself, how far says nothing, and the rest would be squeezed.
constexpr double largest = 1000, smallest = 1;

std::string beyondText(int count) {
    return count == 0 ? std::string()
                      : fmt::format(" {} dot{} above {:.0f} % not drawn.", count, count == 1 ? "" : "s", largest);
}

}  // namespace

Figure modelErrorsFigure(std::span<const ModelErrors> models, const std::vector<std::string>& kinds,
                         const std::string& title) {
    Figure figure;
    figure.title = title;
    figure.caption = "Bars: ±2 standard errors, from the noise of the reference.";
    figure.x = {.label = "", .unit = "", .min = -0.5, .max = static_cast<double>(kinds.size()) - 0.5, .names = kinds};
    figure.y = {.label = "Error", .unit = "%", .scale = AxisScale::square_root};
    int beyond = 0;
    for (std::size_t m = 0; m < models.size(); ++m) {
        const ModelErrors& model = models[m];
        if (model.errors.size() != kinds.size())
            throw inputError(
                fmt::format("model '{}' has {} errors of {} kinds", model.label, model.errors.size(), kinds.size()));
        Series series{.label = model.label, .style = SeriesStyle::points, .color = static_cast<int>(m)};
        const double place = spread * ((static_cast<double>(m) + 0.5) / static_cast<double>(models.size()) - 0.5);
        for (std::size_t k = 0; k < kinds.size(); ++k) {
            const auto& [mean, error, count] = model.errors[k];
            beyond += 100 * mean > largest;
            if (!std::isfinite(mean) || 100 * mean > largest) continue;
            series.x.push_back(static_cast<double>(k) + place);
            series.y.push_back(100 * mean);
            series.lower.push_back(100 * (mean - 2 * error));
            series.upper.push_back(100 * (mean + 2 * error));
        }
        figure.series.push_back(std::move(series));
    }
    figure.caption += beyondText(beyond);
    return figure;
}

Figure errorsOverAlbedoFigure(std::span<const ErrorsOverAlbedo> models, const std::string& title) {
    Figure figure;
    figure.title = title;
    figure.caption =
        "A dot for each channel of each material. Scattering dominates at the left, absorption at the right; what is "
        "below 1 % is drawn there.";
    figure.x = {"1 − reduced albedo α′", "", AxisScale::logarithmic};
    figure.y = {"Error of R_d", "%", AxisScale::logarithmic, smallest, largest};
    int beyond = 0;
    for (std::size_t m = 0; m < models.size(); ++m) {
        Series series{.label = models[m].label, .style = SeriesStyle::points, .color = static_cast<int>(m)};
        for (std::size_t i = 0; i < models[m].albedo.size(); ++i) {
            beyond += 100 * models[m].error[i] > largest;
            if (100 * models[m].error[i] > largest) continue;
            series.x.push_back(1 - models[m].albedo[i]);
            series.y.push_back(std::max(100 * models[m].error[i], smallest));
        }
        figure.series.push_back(std::move(series));
    }
    figure.caption += beyondText(beyond);
    return figure;
}

}  // namespace searchlight
