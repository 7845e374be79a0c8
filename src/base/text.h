// Text without locale: numbers, names, lists.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace searchlight {

std::string_view trim(std::string_view text);
std::vector<std::string_view> split(std::string_view text, char separator);
std::string join(const std::vector<std::string>& parts, std::string_view separator);

/// A finite number that takes the whole text ("1e6", "-.5"); nothing otherwise.
std::optional<double> parseNumber(std::string_view text);

/// The shortest text that reads back as the same double.
std::string numberText(double value);

/// For people: `digits` significant digits, no exponent between 1e-4 and 1e6.
std::string prettyNumber(double value, int digits = 4);

/// A count for labels: "20000", and "4×10⁶" from a million on.
std::string countText(double count);

/// "White Grapefruit Juice" -> "white_grapefruit_juice".
std::string lowerSnake(std::string_view name);

/// The `count` names nearest to `name` by edit distance, nearest first.
std::vector<std::string> nearestNames(std::string_view name, const std::vector<std::string>& valid, int count);

}  // namespace searchlight
