#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numeric>

namespace searchlight {

namespace {

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

// Levenshtein distance, upper and lower case alike.
int editDistance(std::string_view a, std::string_view b) {
    std::vector<int> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (size_t i = 1; i <= a.size(); ++i) {
        int diagonal = row[0];
        row[0] = static_cast<int>(i);
        for (size_t j = 1; j <= b.size(); ++j) {
            const int substitute = diagonal + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
        }
    }
    return row.back();
}

}  // namespace

std::string_view trim(std::string_view text) {
    constexpr std::string_view space = " \t\r\n\v\f";
    const size_t first = text.find_first_not_of(space);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(space) - first + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (size_t begin = 0;;) {
        const size_t end = text.find(separator, begin);
        parts.push_back(text.substr(begin, end - begin));
        if (end == std::string_view::npos) return parts;
        begin = end + 1;
    }
}

std::string join(const std::vector<std::string>& parts, std::string_view separator) {
    std::string joined;
    for (size_t i = 0; i < parts.size(); ++i) {
        if (i > 0) joined += separator;
        joined += parts[i];
    }
    return joined;
}

std::optional<double> parseNumber(std::string_view text) {
    text = trim(text);
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::string numberText(double value) { return fmt::format("{}", value); }

std::string prettyNumber(double value, int digits) {
    const double size = std::abs(value);
    // The general format turns to exponents as soon as the digits do not reach the point.
    if (size >= std::pow(10.0, digits) && size < 1e6) return fmt::format("{:.0f}", value);
    return fmt::format("{:.{}g}", value, digits);
}

std::string countText(double count) {
    if (count < 1e6) return fmt::format("{:.0f}", count);
    const int exponent = static_cast<int>(std::floor(std::log10(count) + 1e-12));
    static constexpr const char* superscripts[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text = fmt::format("{:.3g}", count / std::pow(10.0, exponent));
    text = text == "1" ? "10" : text + "×10";
    for (const char digit : std::to_string(exponent)) text += superscripts[digit - '0'];
    return text;
}

std::string lowerSnake(std::string_view name) {
    std::string snake;
    for (const char c : name) {
        if (std::isalnum(static_cast<unsigned char>(c)))
            snake += lower(c);
        else if (!snake.empty() && snake.back() != '_')
            snake += '_';
    }
    while (snake.ends_with('_')) snake.pop_back();
    return snake;
}

std::vector<std::string> nearestNames(std::string_view name, const std::vector<std::string>& valid, int count) {
    std::vector<std::pair<int, std::string>> ranked;
    for (const std::string& candidate : valid) {
        // Somebody who types a part of the name means it.
        const bool part = !name.empty() && candidate.find(name) != std::string::npos;
        ranked.emplace_back(part ? 0 : editDistance(name, candidate), candidate);
    }
    std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<std::string> nearest;
    for (size_t i = 0; i < ranked.size() && i < static_cast<size_t>(count); ++i) nearest.push_back(ranked[i].second);
    return nearest;
}

}  // namespace searchlight
