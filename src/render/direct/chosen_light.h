// Light at points that a technique chose, new random numbers each time.
#pragma once

#include <memory>
#include <vector>

#include "light/environment.h"
#include "light/environment_irradiance.h"
#include "light/irradiance.h"
#include "render/technique.h"

namespace searchlight {

/// The lights of a scene as computeIrradiance() sees them, but for environments: each call draws directions of its own
/// from them, in which they are as parallel light. The mean over calls with different seeds is their light without the
/// error of a fixed number of directions. An environment that nothing shadows is known for every normal at once where
/// no beams are asked for.
class ChosenLight {
public:
    /// Keeps what `input` points to. Throws what Environment throws.
    explicit ChosenLight(const RenderInput& input);

    /// Whether some environment is drawn from, so that each point costs as many rays as there are directions.
    bool draws() const { return !drawn_.empty(); }

    /// `directions`: per environment, at least 1. Throws interruptedError() when cancelled.
    Irradiance at(const SurfacePoints& points, int directions, std::uint64_t seed, Observer& observer) const;

private:
    /// An environment by drawn directions.
    struct Drawn {
        Environment environment;
        bool shadows;
    };

    const Object* object_;
    const RayScene* rays_;
    IrradianceOptions options_;
    Scene still_;  ///< the lights that are no environments
    std::vector<Drawn> drawn_;
    std::vector<EnvironmentIrradiance> by_normal_;
};

}  // namespace searchlight
