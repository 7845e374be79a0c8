// A sum of random points over receivers by the model itself, block by block: points are chosen where the model's radial
// mean says that they matter.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/observer.h"
#include "model/evaluator.h"
#include "model/profile.h"
#include "render/direct/block_sum.h"
#include "render/technique.h"

namespace searchlight {

/// Light of one direction at a point: flux, not per area.
struct ModelSource {
    Vec3f position, normal, wi;
    Rgbf flux;
};

/// Evaluators of one model, one for each thread where it has native ones.
class ModelEvaluators {
public:
    explicit ModelEvaluators(const RenderInput& input);

    std::size_t count() const { return evaluators_.size(); }
    Evaluator& operator[](std::size_t i) const { return *evaluators_[i]; }

private:
    std::vector<std::unique_ptr<Evaluator>> own_;
    std::vector<Evaluator*> evaluators_;
};

struct ModelChoice {
    std::size_t sources = 512;  ///< that a block takes, about
    std::uint64_t seed = 1;
};

/// Sets `sums` to the sum of Q(xi, wi; xo) weight(|xo - xi|) flux per receiver of input.visible, of which the
/// expectation over seeds is exact. For each block of 64 receivers a source at the distance d from its box is taken
/// with a probability in proportion to its flux times the envelope at d, the mean over channels of |R_d| of `mean` over
/// its total; a tenth of the probability goes by flux alone, so that nothing is missed where the mean is 0. What is
/// taken counts one over that probability times. Does not depend on the number of threads. Returns the pairs that were
/// evaluated. Throws interruptedError().
std::uint64_t sumModelBlocks(const RenderInput& input, const ModelEvaluators& evaluators,
                             std::span<const ModelSource> sources, const Profile& mean,
                             const std::function<double(double r_mm)>& weight, const ModelChoice& choice,
                             const Observer& observer, std::vector<Rgb>& sums);

}  // namespace searchlight
