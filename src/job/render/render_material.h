// A scene's material and model for a renderer.
#pragma once

#include <string>

#include "job/engine.h"
#include "job/plot/subject.h"
#include "render/renderer.h"

namespace searchlight {

/// Resolves materials as every command does (job/subject.h) and loads models on that backend. `engine` outlives it.
/// `subject`, where given, receives the material's name, source and notes.
MaterialSource materialSource(Engine& engine, std::string backend, Subject* subject = nullptr);

}  // namespace searchlight
