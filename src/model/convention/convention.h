// What artists and renderers call a translucent material, and the medium that each of them means.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/param.h"
#include "model/convention/albedo_fits.h"
#include "model/evaluator.h"

namespace searchlight {

/// Numbers by key: one, or three for R, G, B. NaN: the convention has no such number.
using ConventionValues = std::map<std::string, std::vector<double>, std::less<>>;

struct ConventionKey {
    Param param;          ///< name, number or channels, unit, range; what is not required has a default
    std::string meaning;  ///< what it stands for
};

/// What a convention leaves to the scene or to the user.
struct ConventionContext {
    double unit_mm = 1;  ///< length of a scene unit
    BurleyWidth width = BurleyWidth::diffuse_mean_free_path;
    Evaluator* evaluator = nullptr;  ///< of `model`: what (Rdr, ld) are a statement about
    const Model* model = nullptr;
    ParamValues parameters;
};

struct WrittenConvention {
    ConventionValues values;
    std::vector<std::string> notes;  ///< what cannot be said, and why
};

struct Convention {
    std::string id;
    std::vector<std::string> aliases;
    std::string title;
    std::string source;    ///< where its meaning was read
    std::string relation;  ///< fits and inversions between its numbers and the medium, and how accurate they are
    std::vector<ConventionKey> keys;
    Medium (*read)(const ConventionValues& values, const ConventionContext& context);
    WrittenConvention (*write)(const Medium& medium, const ConventionContext& context);
};

/// In menu order.
const std::vector<Convention>& conventions();

/// By id or alias. Throws a usage Error with the nearest names.
const Convention& findConvention(std::string_view name);

/// The medium that the numbers mean. Throws a usage Error for a key of another convention, for one that is missing or
/// out of range, and for numbers that no medium has.
Medium readConvention(const Convention& convention, const ConventionValues& given, const ConventionContext& context);

/// The convention's numbers for a medium; NaN and a note where there is none, never a clamped one.
WrittenConvention writeConvention(const Convention& convention, const Medium& medium, const ConventionContext& context);

/// The largest relative difference in sigma_a and sigma_s' between `medium` and what the numbers just written mean; NaN
/// when one of them is missing or is no value to read.
double readBackError(const Convention& convention, const Medium& medium, const WrittenConvention& written,
                     const ConventionContext& context);

}  // namespace searchlight
