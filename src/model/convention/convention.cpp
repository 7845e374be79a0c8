#include "model/convention/convention.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "model/convention/convention_rows.h"

namespace searchlight {

namespace {

const ConventionKey* findKey(const Convention& convention, std::string_view name) {
    for (const ConventionKey& key : convention.keys)
        if (key.param.name == name) return &key;
    return nullptr;
}

// The numbers as the key's own Param takes them.
void checkNumbers(const ConventionKey& key, const std::vector<double>& numbers) {
    if (key.param.type == ParamType::channels) return checkValue(key.param, numbers);
    if (numbers.size() != 1)
        throw usageError(fmt::format("'{}' is no value for {}", valueText(numbers), key.param.name),
                         "expected one number");
    checkValue(key.param, numbers.front());
}

std::vector<double> defaultOf(const Param& param) {
    if (param.type == ParamType::channels) return std::get<std::vector<double>>(param.value);
    return {std::get<double>(param.value)};
}

}  // namespace

const std::vector<Convention>& conventions() {
    static const std::vector<Convention> table{
        convention::physical(),        convention::albedoAndMeanFreePath(),
        convention::reflectance(),     convention::burley(),
        convention::chiang(),          convention::cycles(),
        convention::cyclesLegacy(),    convention::cyclesSkin(),
        convention::cyclesBurley(),    convention::openPbr(),
        convention::standardSurface(), convention::unreal(),
        convention::unity(),           convention::pbrt(),
        convention::renderMan(),
    };
    return table;
}

const Convention& findConvention(std::string_view name) {
    std::vector<std::string> names;
    for (const Convention& convention : conventions()) {
        if (convention.id == name || std::ranges::find(convention.aliases, name) != convention.aliases.end())
            return convention;
        names.push_back(convention.id);
        names.insert(names.end(), convention.aliases.begin(), convention.aliases.end());
    }
    throw unknownName(ErrorKind::usage, "convention", name, names);
}

Medium readConvention(const Convention& convention, const ConventionValues& given, const ConventionContext& context) {
    std::vector<std::string> keys;
    for (const ConventionKey& key : convention.keys) keys.push_back(key.param.name);
    for (const auto& [name, numbers] : given)
        if (!findKey(convention, name))
            throw unknownName(ErrorKind::usage, fmt::format("value of {}", convention.id), name, keys);
    ConventionValues values;
    for (const ConventionKey& key : convention.keys) {
        const auto found = given.find(key.param.name);
        if (found == given.end() && key.param.required)
            throw usageError(fmt::format("{} needs {}", convention.id, key.param.name), key.meaning);
        values[key.param.name] = found == given.end() ? defaultOf(key.param) : found->second;
        checkNumbers(key, values[key.param.name]);
    }
    const Medium medium = convention.read(values, context);
    for (int c = 0; c < medium.channels; ++c)
        if (!std::isfinite(medium.sigma_a[c]) || !std::isfinite(medium.sigma_s[c]))
            throw usageError(fmt::format("no medium has these values{}",
                                         medium.channels == 1 ? "" : fmt::format(" in channel {}", "RGB"[c])),
                             "a colour of 1 absorbs nothing, and one beyond what the fit reaches has no albedo");
    checkMedium(medium);
    return medium;
}

WrittenConvention writeConvention(const Convention& convention, const Medium& medium,
                                  const ConventionContext& context) {
    return convention.write(medium, context);
}

double readBackError(const Convention& convention, const Medium& medium, const WrittenConvention& written,
                     const ConventionContext& context) {
    for (const auto& [name, numbers] : written.values)
        for (const double number : numbers)
            if (!std::isfinite(number)) return std::numeric_limits<double>::quiet_NaN();
    Medium back;
    try {
        back = readConvention(convention, written.values, context);
    } catch (const Error&) {  // such as an Rdr above 1, of a model that makes light
        return std::numeric_limits<double>::quiet_NaN();
    }
    double error = 0;
    for (int c = 0; c < medium.channels; ++c) {
        const auto relative = [&](double was, double is) { return was == is ? 0 : std::abs(is - was) / was; };
        error = std::max(
            {error, relative(medium.sigma_a[c], back.sigma_a[c]), relative(medium.sigmaSp()[c], back.sigmaSp()[c])});
    }
    return error;
}

}  // namespace searchlight
