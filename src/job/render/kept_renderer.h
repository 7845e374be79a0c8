// Pictures one after another by one renderer, so that only what changes between them is computed again.
#pragma once

#include <memory>
#include <string>

#include "job/engine.h"
#include "job/job.h"
#include "job/plot/subject.h"
#include "render/renderer.h"

namespace searchlight {

/// What a render job leaves for the next one. A model file that was edited meanwhile is not read again.
struct KeptRenderer {
    std::string backend;  ///< that the renderer's models are evaluated on
    bool has_context = false;
    Subject subject;  ///< the material of the last picture
    std::unique_ptr<Renderer> renderer;
};

/// What a render job asks of a renderer. Throws a usage Error for options that do not go together.
RenderSettings renderSettings(const Job& job);

/// Carries out a render job as run() does, with the stages that `kept` holds.
JobResult renderPicture(const Job& job, Engine& engine, KeptRenderer& kept, Observer& observer);

}  // namespace searchlight
