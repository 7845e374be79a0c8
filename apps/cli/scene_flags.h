// The flags that write into a scene: object, camera, lights and what else a picture needs.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace searchlight {

struct SceneFlag {
    std::string_view name;  ///< snake_case, as options are
    std::string_view doc;
    bool value_optional = false;  ///< may stand without a value
};

std::span<const SceneFlag> sceneFlags();

/// Values by a flag's name, as typed, in the order given; a flag without a value gives an empty text.
using TypedFlags = std::map<std::string, std::vector<std::string>, std::less<>>;

/// Writes what was typed into the scene. Lights that are given replace the scene's. Throws a usage Error that names
/// what is valid.
void applySceneFlags(const TypedFlags& typed, Scene& scene);

}  // namespace searchlight
