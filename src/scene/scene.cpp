#include "scene/scene.h"

#include <cassert>

#include "scene/materials.h"

namespace searchlight {

Material resolveMaterial(const SceneMaterial& material) {
    assert(!material.inverted());
    if (!material.id.empty()) return findMaterial(material.id);
    Material custom;
    custom.id = "custom";
    custom.name = "custom";
    custom.medium = makeMedium(material.sigma_a, material.sigma_s, material.g, material.eta);
    return custom;
}

}  // namespace searchlight
