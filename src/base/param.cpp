#include "base/param.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"

namespace searchlight {

namespace {

Error badValue(const Param& param, std::string_view shown) {
    return usageError(fmt::format("'{}' is no value for {}", shown, param.name), "expected " + rangeText(param));
}

bool inRange(const Param& param, double value) {
    if (!std::isfinite(value)) return false;
    if (param.min == 0 && param.max == 0) return true;  // no range stated
    if (param.exclusive && value == param.min) return false;
    return value >= param.min && value <= param.max;
}

std::vector<double> parseList(const Param& param, std::string_view text) {
    std::vector<double> list;
    for (const std::string_view part : split(text, ',')) {
        const std::optional<double> number = parseNumber(part);
        if (!number) throw badValue(param, text);
        list.push_back(*number);
    }
    return list;
}

}  // namespace

ParamValue parseValue(const Param& param, std::string_view text) {
    text = trim(text);
    ParamValue value;
    switch (param.type) {
        case ParamType::number:
        case ParamType::integer: {
            const std::optional<double> number = parseNumber(text);
            if (!number) throw badValue(param, text);
            value = *number;
            break;
        }
        case ParamType::toggle:
            if (text == "true" || text == "1" || text == "on" || text == "yes")
                value = true;
            else if (text == "false" || text == "0" || text == "off" || text == "no")
                value = false;
            else
                throw badValue(param, text);
            break;
        case ParamType::color: {
            const std::vector<double> list = parseList(param, text);
            if (list.size() == 1)
                value = Rgb{list[0], list[0], list[0]};
            else if (list.size() == 3)
                value = Rgb{list[0], list[1], list[2]};
            else
                throw badValue(param, text);
            break;
        }
        case ParamType::choice:
        case ParamType::text:
        case ParamType::path: value = std::string(text); break;
        case ParamType::numbers:
        case ParamType::channels: value = parseList(param, text); break;
    }
    checkValue(param, value);
    return value;
}

void checkValue(const Param& param, const ParamValue& value) {
    const auto fail = [&] { throw badValue(param, valueText(value)); };
    switch (param.type) {
        case ParamType::number:
        case ParamType::integer: {
            const double* number = std::get_if<double>(&value);
            if (!number || !inRange(param, *number)) fail();
            if (param.type == ParamType::integer && *number != std::floor(*number)) fail();
            break;
        }
        case ParamType::toggle:
            if (!std::holds_alternative<bool>(value)) fail();
            break;
        case ParamType::color: {
            const Rgb* color = std::get_if<Rgb>(&value);
            if (!color || !inRange(param, color->r) || !inRange(param, color->g) || !inRange(param, color->b)) fail();
            break;
        }
        case ParamType::choice: {
            const std::string* name = std::get_if<std::string>(&value);
            if (!name) fail();
            if (std::find(param.choices.begin(), param.choices.end(), *name) == param.choices.end())
                throw unknownName(ErrorKind::usage, "choice for " + param.name, *name, param.choices);
            break;
        }
        case ParamType::text:
        case ParamType::path: {
            const std::string* text = std::get_if<std::string>(&value);
            if (!text || (param.type == ParamType::path && text->empty())) fail();
            break;
        }
        case ParamType::numbers:
        case ParamType::channels: {
            const auto* list = std::get_if<std::vector<double>>(&value);
            if (!list || list->empty()) fail();
            if (param.type == ParamType::channels && list->size() != 1 && list->size() != 3) fail();
            for (const double number : *list)
                if (!inRange(param, number)) fail();
            break;
        }
    }
}

std::string valueText(const ParamValue& value) {
    struct Writer {
        std::string operator()(double number) const { return numberText(number); }
        std::string operator()(bool toggle) const { return toggle ? "true" : "false"; }
        std::string operator()(const Rgb& c) const { return (*this)(std::vector<double>{c.r, c.g, c.b}); }
        std::string operator()(const std::string& text) const { return text; }
        std::string operator()(const std::vector<double>& list) const {
            std::vector<std::string> parts;
            for (const double number : list) parts.push_back(numberText(number));
            return join(parts, ",");
        }
    };
    return std::visit(Writer{}, value);
}

std::string rangeText(const Param& param) {
    std::string kind;
    switch (param.type) {
        case ParamType::number: kind = "a number"; break;
        case ParamType::integer: kind = "a whole number"; break;
        case ParamType::toggle: return "true or false";
        case ParamType::color: kind = "R,G,B or one number for all, each"; break;
        case ParamType::choice: return "one of " + join(param.choices, ", ");
        case ParamType::text: return "text";
        case ParamType::path: return "a path";
        case ParamType::numbers: kind = "numbers separated by commas, each"; break;
        case ParamType::channels: kind = "one number or R,G,B, each"; break;
    }
    if (param.min == 0 && param.max == 0) {
        if (kind.ends_with(", each")) kind.resize(kind.size() - 6);
        return kind + (param.unit.empty() ? "" : " in " + param.unit);
    }
    std::string range;
    if (param.max >= 1e30)
        range = fmt::format(" {} {}", param.exclusive ? "above" : "of at least", param.min);
    else if (param.exclusive)
        range = fmt::format(" above {} and up to {:.12g}", param.min, param.max);
    else
        range = fmt::format(" from {} to {:.12g}", param.min, param.max);
    return kind + range + (param.unit.empty() ? "" : " " + param.unit);
}

const Param& findParam(const std::vector<Param>& params, std::string_view name, std::string_view what) {
    std::vector<std::string> names;
    for (const Param& param : params) {
        if (param.name == name) return param;
        names.push_back(param.name);
    }
    throw unknownName(ErrorKind::usage, what, name, names);
}

const ParamValue& valueOf(const Param& param, const ParamValues& values) {
    const auto given = values.find(param.name);
    return given == values.end() ? param.value : given->second;
}

}  // namespace searchlight
