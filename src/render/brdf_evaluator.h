// Evaluates a .brdf file on OpenGL, in batches.
#pragma once

#include <memory>
#include <span>

#include "base/vec.h"
#include "model/evaluator.h"
#include "render/brdf_file.h"

namespace searchlight {

namespace gl {
class Context;
}

/// Unit vectors of one space: towards the light and the viewer, the normal, tangent and bitangent.
struct BrdfQuery {
    Vec3 light, view, normal, tangent, bitangent;
};

/// Not thread-safe.
class BrdfEvaluator {
public:
    /// Compiles the file and sets its parameters as brdfValues() has them; throws what that throws, and an input Error
    /// with file, line and column when it does not compile. `context` outlives the evaluator.
    BrdfEvaluator(const BrdfFile& file, const ParamValues& parameters, gl::Context& context);

    /// What BRDF() returns, 1/sr. As many values as queries. Throws an input Error for a loop that does not end.
    void evaluate(std::span<const BrdfQuery> queries, std::span<Rgb> values);

private:
    std::unique_ptr<Evaluator> evaluator_;
};

}  // namespace searchlight
