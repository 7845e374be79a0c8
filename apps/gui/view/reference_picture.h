// The reference beside the object view's picture: walks inside the object, going on until nobody looks.
#pragma once

#include <functional>

#include "base/image.h"
#include "gui/tasks/tasks.h"
#include "scene/scene.h"

namespace searchlight::gui {

struct ReferencePicture {
    std::shared_ptr<const Image> image;  ///< the diffuse exit, linear
    std::uint64_t walks = 0;             ///< per channel
    double relative_error = 0;           ///< standard error of a pixel over the mean of the picture, root mean square
};

/// Walks, each time about twice as many, and calls shown() after each, on the task's thread; until `walks` or the task
/// is cancelled. Throws what walkBody() and MeshBody throw: the object has to be closed.
void walkPicture(const Scene& scene, int width, int height, std::uint64_t seed, std::uint64_t walks,
                 TaskContext& context, const std::function<void(ReferencePicture)>& shown);

}  // namespace searchlight::gui
