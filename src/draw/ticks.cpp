#include "draw/ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace searchlight {

namespace {

constexpr double slack = 1e-9;  // of a step: a tick that rounding moved off the end of the axis still belongs to it

// Correctly rounded for small exponents: 3 / 10 is the double 0.3, 3 * 0.1 is not.
double timesPowerOfTen(double value, int exponent) {
    return exponent < 0 ? value / std::pow(10.0, -exponent) : value * std::pow(10.0, exponent);
}

struct Step {
    int mantissa = 1;  // 1, 2 or 5
    int exponent = 0;
    double value() const { return timesPowerOfTen(mantissa, exponent); }
};

Step niceStep(double span, int target) {
    const double raw = span / target;
    Step step{1, static_cast<int>(std::floor(std::log10(raw)))};
    const double ratio = timesPowerOfTen(raw, -step.exponent);
    if (ratio > 7.07)
        ++step.exponent;
    else if (ratio > 3.16)
        step.mantissa = 5;
    else if (ratio > 1.41)
        step.mantissa = 2;
    return step;
}

// A typographic minus, and no minus zero.
std::string decimalText(double value, int decimals) {
    std::string text = fmt::format("{:.{}f}", value, decimals);
    if (!text.starts_with('-')) return text;
    text.erase(0, 1);
    return text.find_first_not_of("0.") == std::string::npos ? text : "−" + text;
}

// As many decimals as the value needs.
std::string shortestText(double value) { return (value < 0 ? "−" : "") + prettyNumber(std::abs(value), 6); }

// Decimals for readable sizes, a common power of ten for the rest.
int commonFactor(double min, double max) {
    const double largest = std::max(std::abs(min), std::abs(max));
    return largest >= 1e5 || largest < 1e-3 ? static_cast<int>(std::floor(std::log10(largest) + slack)) : 0;
}

AxisTicks linearTicks(double min, double max, int target) {
    AxisTicks axis;
    const Step step = niceStep(max - min, target);
    const int divisions = step.mantissa == 2 ? 4 : 5;
    axis.factor = commonFactor(min, max);
    const int decimals = std::max(0, axis.factor - step.exponent);
    const double minor = step.value() / divisions;
    const double first = std::ceil(min / minor - slack), last = std::floor(max / minor + slack);
    for (double i = first; i <= last; ++i) {
        Tick tick{.value = i * minor};
        if (std::fmod(i, divisions) == 0) {
            tick.value = timesPowerOfTen(i / divisions * step.mantissa, step.exponent);
            tick.major = true;
            tick.label = decimalText(timesPowerOfTen(tick.value, -axis.factor), decimals);
        }
        axis.ticks.push_back(std::move(tick));
    }
    return axis;
}

std::string plainText(int mantissa, int exponent) {
    return decimalText(timesPowerOfTen(mantissa, exponent), std::max(0, -exponent));
}

Tick powerTick(int mantissa, int exponent, bool plain) {
    Tick tick{.value = timesPowerOfTen(mantissa, exponent), .major = true};
    if (plain) {
        tick.label = plainText(mantissa, exponent);
    } else {
        tick.label = mantissa == 1 ? "10" : fmt::format("{}×10", mantissa);
        tick.superscript = decimalText(exponent, 0);
    }
    return tick;
}

AxisTicks logarithmicTicks(double min, double max, int target) {
    const double low = std::log10(min), high = std::log10(max);
    const int first = static_cast<int>(std::floor(low + slack)), last = static_cast<int>(std::floor(high + slack));
    const bool plain = min >= 0.99e-3 && max < 1.01e4;
    const auto inside = [&](int mantissa, int exponent) {
        const double position = exponent + std::log10(mantissa);
        return position >= low - slack && position <= high + slack;
    };
    AxisTicks axis;
    if (high - low <= 2) {
        int labels = 0;
        for (int exponent = first; exponent <= last; ++exponent)
            for (int mantissa = 1; mantissa <= 9; ++mantissa) {
                if (!inside(mantissa, exponent)) continue;
                const bool labelled = mantissa == 1 || mantissa == 2 || mantissa == 5;
                labels += labelled;
                axis.ticks.push_back(labelled ? powerTick(mantissa, exponent, plain)
                                              : Tick{.value = timesPowerOfTen(mantissa, exponent)});
            }
        return labels >= 3 ? axis : linearTicks(min, max, target);
    }
    const int stride = static_cast<int>(std::ceil((last - first) / (1.25 * target)));
    for (int exponent = first; exponent <= last; ++exponent) {
        // Counted from 10^0, so that the labels stay put when the range grows.
        const bool labelled = exponent % std::max(stride, 1) == 0;
        if (inside(1, exponent) && labelled) axis.ticks.push_back(powerTick(1, exponent, plain));
        if (inside(1, exponent) && !labelled && stride <= 10)
            axis.ticks.push_back({.value = timesPowerOfTen(1, exponent)});
        for (int mantissa = 2; stride <= 1 && mantissa <= 9; ++mantissa)
            if (inside(mantissa, exponent)) axis.ticks.push_back({.value = timesPowerOfTen(mantissa, exponent)});
    }
    return axis;
}

// Equal steps crowd at the top and starve the bottom of a square-root axis: below the first step come 5, 2, 1, ...
// as long as they keep a distance.
AxisTicks squareRootTicks(double min, double max, int target) {
    const double largest = std::max(std::abs(min), std::abs(max));
    const bool crosses = min <= 0 && max >= 0;
    if (!crosses && std::min(std::abs(min), std::abs(max)) > 0.1 * largest) return linearTicks(min, max, target);

    const double gap = (crosses && min < 0 ? std::sqrt(-min) + std::sqrt(max) : std::sqrt(largest)) / (2.0 * target);
    Step step = niceStep(largest, std::max(3, target / 2));
    AxisTicks axis;
    axis.factor = commonFactor(min, max);
    std::vector<double> levels;  // descending
    for (int i = static_cast<int>(std::floor(largest / step.value() + slack)); i >= 1; --i)
        levels.push_back(timesPowerOfTen(i * step.mantissa, step.exponent));
    while (std::sqrt(step.value()) > gap) {
        if (step.mantissa == 1) step = {10, step.exponent - 1};
        step.mantissa /= 2;  // 10 -> 5 -> 2 -> 1
        if (std::sqrt(step.value()) >= gap && std::sqrt(levels.back()) - std::sqrt(step.value()) >= gap)
            levels.push_back(step.value());
    }
    const auto add = [&](double value) {
        if (value < min - slack * largest || value > max + slack * largest) return;
        axis.ticks.push_back(
            {.value = value, .major = true, .label = shortestText(timesPowerOfTen(value, -axis.factor))});
    };
    for (const double level : levels) add(-level);
    add(0);
    for (auto level = levels.rbegin(); level != levels.rend(); ++level) add(*level);
    return axis;
}

}  // namespace

AxisTicks axisTicks(AxisScale scale, double min, double max, int target) {
    switch (scale) {
        case AxisScale::logarithmic: return logarithmicTicks(min, max, target);
        case AxisScale::square_root: return squareRootTicks(min, max, target);
        case AxisScale::linear: break;
    }
    return linearTicks(min, max, target);
}

AxisTicks namedTicks(const std::vector<std::string>& names) {
    AxisTicks axis;
    for (const std::string& name : names)
        axis.ticks.push_back({.value = static_cast<double>(axis.ticks.size()), .major = true, .label = name});
    return axis;
}

}  // namespace searchlight
