// What the window shows, as a command for a terminal.
#pragma once

#include <string>
#include <vector>

#include "gui/state/state.h"

namespace searchlight::gui {

/// `searchlight render ...` that makes the same picture: by flags where these can say all of the scene, else with the
/// job written out behind it (for a POSIX shell).
std::string commandLine(const State& state, const std::string& output, int width, int height);

/// "--material skin1", or the flags of its coefficients, and its scale: what every command that has a material takes.
std::vector<std::string> materialFlags(const SceneMaterial& material);

/// `text` as one word of a POSIX shell.
std::string shellWord(const std::string& text);

}  // namespace searchlight::gui
