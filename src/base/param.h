// A parameter, stated once: the command line flag, the JSON key, the window's widget and the docs come from it.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/vec.h"

namespace searchlight {

enum class ParamType {
    number,   ///< one double within [min, max]
    integer,  ///< as number, whole
    toggle,   ///< bool
    color,    ///< linear RGB, each within [min, max]
    choice,   ///< one of `choices`
    text,     ///< any string
    path,     ///< a file or folder
    numbers,  ///< a list of doubles, each within [min, max]
    channels  ///< one number for all channels, or three for R, G, B, each within [min, max]
};

/// number and integer: double; toggle: bool; color: Rgb; choice, text, path: string; numbers and channels: vector.
using ParamValue = std::variant<double, bool, Rgb, std::string, std::vector<double>>;

struct Param {
    std::string name;  ///< snake_case for options, as written in the file for model parameters
    ParamType type = ParamType::number;
    std::string unit;  ///< "mm", "1/mm", "deg"; empty: dimensionless
    double min = 0, max = 0;
    ParamValue value;  ///< the default
    std::vector<std::string> choices;
    std::string doc;         ///< one line
    bool required = false;   ///< no default: the value above is not used
    bool exclusive = false;  ///< min itself is not allowed
    char letter = 0;         ///< of a short flag: 'n' for -n; 0: none
};

/// Values by parameter name; what is absent has its default.
using ParamValues = std::map<std::string, ParamValue, std::less<>>;

/// Reads a value as text ("0.5", "true", "1,0.5,0.2", "exact"). Throws a usage Error that names the valid range.
ParamValue parseValue(const Param& param, std::string_view text);

/// Throws a usage Error when the value has the wrong type or is out of range.
void checkValue(const Param& param, const ParamValue& value);

/// The text that parseValue reads back.
std::string valueText(const ParamValue& value);

/// "0 to 10", "a|b|c", "1/mm, at least 0": what a user may type.
std::string rangeText(const Param& param);

/// The parameter of that name; throws unknownName for `what` ("option", "parameter") otherwise.
const Param& findParam(const std::vector<Param>& params, std::string_view name, std::string_view what);

/// The value given, or the default.
const ParamValue& valueOf(const Param& param, const ParamValues& values);

}  // namespace searchlight
