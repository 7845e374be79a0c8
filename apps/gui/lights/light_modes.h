// The ways to light an object that a person chooses among, each a list of lights.
#pragma once

#include <span>
#include <vector>

#include "scene/scene.h"

namespace searchlight::gui {

struct LightMode {
    const char* title;
    const char* doc;
    const char* icon;
    const char* needs;  ///< a picture, and what for; null: none
    /// `picture`: its path.
    std::vector<Light> (*make)(const std::string& picture);
};

/// In menu order.
std::span<const LightMode> lightModes();

/// Of the mode that the lights are like; -1: none.
int modeOf(const std::vector<Light>& lights);

}  // namespace searchlight::gui
