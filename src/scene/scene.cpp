#include "scene/scene.h"

#include <cassert>

#include "scene/materials.h"

namespace searchlight {

Material resolveMaterial(const SceneMaterial& material) {
    assert(!material.inverted());
    Material resolved;
    if (material.id.empty()) {
        resolved.id = resolved.name = "custom";
        resolved.medium = makeMedium(material.sigma_a, material.sigma_s, material.g, material.eta);
    } else {
        resolved = findMaterial(material.id);
    }
    resolved.medium = scaled(resolved.medium, material.scale);
    return resolved;
}

}  // namespace searchlight
