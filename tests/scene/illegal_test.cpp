#include "illegal/messages.h"
#include "scene/materials.h"
#include "scene/scene.h"

namespace searchlight {
namespace {

TEST(Illegal, EveryMaterialTableFailsWithItsMessage) {
    expectMessages("materials", [](auto text, auto path) { parseMaterials(text, path); });
}

TEST(Illegal, EverySceneFailsWithItsMessage) {
    expectMessages("scenes", [](auto text, auto path) { parseScene(text, path); });
}

}  // namespace
}  // namespace searchlight
