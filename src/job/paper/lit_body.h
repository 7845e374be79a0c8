// A lit object by walks and by models, in the same cells of its surface: what a paper's pictures are made of.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "job/engine.h"
#include "light/light_sampler.h"
#include "render/sphere/sphere_error.h"
#include "render/view.h"
#include "scene/medium.h"
#include "scene/point_cloud.h"
#include "scene/scene.h"
#include "transport/mesh/cell_picture.h"
#include "transport/mesh/closed_body.h"

namespace searchlight {

struct LitBodyOptions {
    int width = 160, height = 160;  ///< of the picture
    double cell_pixels = 16;        ///< area of a cell in pixels
    std::size_t points = 40'000;    ///< where models read the light
    std::uint64_t seed = 1;
    int threads = 0;  ///< 0: all
};

/// A model that is to be seen on the object, as a scene names it.
struct BodyModel {
    std::string id;
    ParamValues parameters = {};
};

/// What leaves by light that scattered never or once, by channel.
struct FirstExitance {
    SphereExitance unscattered, single;
    SphereExitance unscattered_similar;  ///< of the delta-Eddington medium, sigma_s (1 - g^2) [Frisvad2014, Eq. 4]
};

/// The object of a scene in a medium. Entry is the same for walks and models (geometric normals, T12, opaque shadow
/// rays), and so is exit: a mean of exitance over each cell, seen as the diffuse exit (docs/mesh-reference.md). All of
/// them return M per cell of the body, for cells that the camera sees.
class LitBody {
public:
    /// Throws what placeObject(), LightSampler and MeshBody throw, and a usage Error without light.
    LitBody(Scene scene, const Medium& medium, const LitBodyOptions& options, Observer& observer);

    const Scene& scene() const { return scene_; }
    const LightSampler& lights() const { return lights_; }
    const CellView& view() const { return view_; }

    /// By random walks, about so many per channel.
    SphereExitance walk(std::uint64_t walks, std::uint64_t seed, Observer& observer) const;

    FirstExitance firstOrders(std::uint64_t walks, Observer& observer) const;

    /// By the hierarchical sum to half a percent, which is the standard error that is not stated here: it holds 0.
    /// Throws what loading and summing throw.
    SphereExitance model(const BodyModel& model, Engine& engine, const std::string& backend, Observer& observer) const;

    /// Mean normal of each cell that is seen; zero for the others.
    const std::vector<Vec3>& normals() const { return normals_; }

    Image picture(const SphereExitance& exitance) const;
    /// Its standard error.
    Image errorPicture(const SphereExitance& exitance) const;

private:
    Scene scene_;
    Medium medium_;
    LitBodyOptions options_;
    Object object_;
    LightSampler lights_;
    View camera_;
    RayScene rays_;
    MeshBody body_;
    CellView view_;
    PointCloud points_;
    CellPoints seen_;  ///< points of the cells that the camera sees
    std::vector<Vec3> normals_;
};

/// Sums, with errors that are independent.
SphereExitance operator+(const SphereExitance& a, const SphereExitance& b);

/// The mean of two walks of equal length.
SphereExitance meanOf(const SphereExitance& a, const SphereExitance& b);

}  // namespace searchlight
