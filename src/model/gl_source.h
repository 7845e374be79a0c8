// The GLSL of a model, put together: what it may call, what it is given, its own text, and a main().
#pragma once

#include "gl/source.h"
#include "language/bssrdf_file.h"

namespace searchlight {

/// The programs that evaluate a model.
enum class GlStage {
    init,                 ///< one invocation: writes State
    evaluate,             ///< one invocation per query: reads State, writes R_d
    diffuse_reflectance,  ///< one invocation: DiffuseReflectance of the uniform sl_alpha_prime
    functions  ///< no main(): Bssrdf(), sl_findCut(), sl_iterations to be set to 0 before each evaluation, and for a
               ///< model that reads them the globals Ni and No; what follows may use names that start with sl_
};

/// Loops of a model are not trusted: all of them together may take so many iterations per evaluation.
struct LoopBudget {
    int iterations = 1'000'000;
    /// The driver itself ends all loops of an invocation after a number of iterations, and says nothing. Then the
    /// program finds that out and fails.
    bool driver_cuts = false;
};

/// Binding points of the buffer blocks.
struct GlBinding {
    static constexpr unsigned state = 0;    ///< sl_State: the initializer's globals
    static constexpr unsigned queries = 1;  ///< 18 floats a query: xi, wi, ni, xo, wo, no
    static constexpr unsigned values = 2;   ///< int sl_failed (0: no; n > 0: a loop of line n - 1, line 0 if unknown),
                                            ///< then 3 floats a query
};

/// Queries per work group of the evaluate stage, whose uniform sl_count says how many there are.
constexpr unsigned gl_group_size = 64;

/// Version 4.50 core, with only those functions of physics/ that the model uses. Every token keeps its place in the
/// model's file. Throws an input Error for what the model's text must not hold.
gl::Source modelShader(const BssrdfFile& file, GlStage stage, const LoopBudget& budget);

}  // namespace searchlight
