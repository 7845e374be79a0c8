// What the window shows, as a command for a terminal.
#pragma once

#include <string>
#include <vector>

#include "gui/state/state.h"

namespace searchlight::gui {

/// The file that a command writes.
struct PictureFile {
    std::string path;
    int width = 0, height = 0;
    double exposure = 0;  ///< stops
};

/// `searchlight render ...` that makes the same picture: by flags where these can say all of the scene, else with the
/// job written out behind it (for a POSIX shell).
std::string commandLine(const State& state, const PictureFile& file);

/// "--material skin1", or the flags of its coefficients, and its scale: what every command that has a material takes.
/// `inverted_by`: of Rdr and ld; null for commands whose --model does that.
std::vector<std::string> materialFlags(const SceneMaterial& material, const SceneModel* inverted_by);

/// `text` as one word of a POSIX shell.
std::string shellWord(const std::string& text);

}  // namespace searchlight::gui
