// The lit spheres of a window: a model and the walks on one sphere, both growing while one looks.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "base/error.h"
#include "base/observer.h"
#include "job/engine.h"
#include "render/sphere/sphere_error.h"

namespace searchlight {

struct SphereRequest {
    Scene scene;                    ///< its model, material, lights, camera; its scale is the sphere's diameter
    int width = 256, height = 256;  ///< of one picture, pixels
    int cells = 12'000;             ///< of the sphere, about
    double samples = 256;           ///< of the model, per cell
    double walks = 4e6;             ///< of the reference, per channel
    std::uint64_t seed = 1;
};

struct SpherePictures {
    Image model, reference;  ///< diffuse exit; empty: none yet
    std::array<SphereError, Rgb::channels> errors;
    std::uint64_t samples = 0, walks = 0;
    double exposure = 0;         ///< stops that suit both
    std::optional<Error> error;  ///< why there is no model
    bool done = false;           ///< samples and walks are all there
};

/// One thread at a time. A move of the camera computes nothing anew.
class LiveSpheres {
public:
    explicit LiveSpheres(Engine& engine) : engine_(engine) {}

    /// A step for both sides, the first ones short. False: there is nothing left to do. Throws interruptedError() when
    /// cancelled, keeping what there is; input Errors of the scene. What the model does wrong is in the pictures.
    bool improve(const SphereRequest& request, Observer& observer);

    SpherePictures pictures(const SphereRequest& request);

    /// Forgets the model: the context is gone, or the file has changed.
    void forgetModel();

private:
    void prepare(const SphereRequest& request);

    Engine& engine_;
    std::string key_;
    struct Stage;
    std::shared_ptr<Stage> stage_;
};

}  // namespace searchlight
