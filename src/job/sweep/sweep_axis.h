// What an axis of a sweep is called, holds and does to a cell. Included by .cpp files only, as job/json.h is.
#pragma once

#include <string>
#include <vector>

#include "job/json.h"
#include "job/sweep/sweep.h"
#include "scene/json_text.h"

namespace searchlight {

/// A cell while its axes are applied: the JSON of its scene, options and seed.
struct CellText {
    Json scene, options = Json::object(), seed = 1;
};

struct AxisValues {
    SweepAxis axis;
    std::vector<Json> values;
};

/// The options of `render` that a sweep may give: all but the turntable's.
const std::vector<Param>& sweptOptions();

/// The axis that stands at `pointer`. Throws an input Error at its place.
AxisValues readAxis(const JsonText& text, const nlohmann::json& json, const std::string& pointer);

/// Puts the value where `key` says. Throws an input Error without place for a JSON pointer that leads nowhere.
void applyValue(const std::string& key, const Json& value, CellText& cell);

/// The cell's job, without output. Throws what parseJob throws, but for places.
Job jobOf(const CellText& cell);

/// How early in a renderer's stages the key matters; 0 first.
int stageOf(const std::string& key);

}  // namespace searchlight
