// What every program that runs a model's GLSL is given, and how it fails.
#pragma once

#include "base/error.h"
#include "base/param.h"
#include "gl/context.h"
#include "gl/program.h"
#include "model/gl_source.h"
#include "scene/medium.h"

namespace searchlight {

/// The iterations that the device lets an evaluation take.
LoopBudget loopBudget(const gl::ContextInfo& device);

/// Sets medium and parameters of a program of modelShader(). Absent parameters have their defaults.
void setModelUniforms(gl::Program& program, const BssrdfFile& file, const Medium& medium,
                      const ParamValues& parameters);

/// What a program that left sl_failed at a value other than 0 has to say.
Error loopError(const BssrdfFile& file, const LoopBudget& budget, int failed);

}  // namespace searchlight
