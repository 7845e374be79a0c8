// A picture of a scene in stages, each redone only when what it reads has changed.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/cache_folder.h"
#include "base/image.h"
#include "render/technique.h"

namespace searchlight {

/// A scene's model, set to the scene's medium.
struct RenderMaterial {
    Model model;
    Medium medium;
    std::unique_ptr<Evaluator> evaluator;
};

/// Resolves a scene's material and model; called when one of the two changed. Whoever owns models and devices gives it.
using MaterialSource = std::function<RenderMaterial(const Scene& scene)>;

struct RenderSettings {
    int width = 1280, height = 720;
    double preview = 1;      ///< fraction of width and height that is computed: 0.5 while something moves
    std::size_t points = 0;  ///< of irradiance on a mesh; 0: chosen from the object and the material
    std::string technique = "hierarchical";
    ParamValues technique_options;  ///< by the names of its Params; absent: default
    int edge_samples = 8;           ///< rays through a pixel that an edge crosses
    int light_samples = 512;        ///< of an occluded environment
    bool gl = false;                ///< irradiance, visible surface and technique on the renderer's context
    std::uint64_t seed = 1;
    int threads = 0;                          ///< 0: all
    std::optional<CacheFolder> points_cache;  ///< where points of a mesh are kept
};

/// In the order in which they run.
enum class Stage { object, rays, material, points, visible, irradiance, exitance, background, coat, shade };
inline constexpr std::size_t stage_count = 10;
std::string_view stageName(Stage stage);

struct StageReport {
    std::uint64_t runs = 0;  ///< since the renderer was made
    double ms = 0;           ///< of the last render(); 0: nothing to do
    bool gl = false;         ///< the last run was on OpenGL
};

struct RenderReport {
    std::array<StageReport, stage_count> stages;
    std::size_t points = 0, receivers = 0;
    double point_spacing_mm = 0;
    Camera camera;        ///< with the distance that was used
    double exposure = 0;  ///< stops that suit a display
    TechniqueReport technique;
    std::vector<std::string> notes;  ///< what a user should know

    const StageReport& operator[](Stage stage) const { return stages[static_cast<std::size_t>(stage)]; }
};

/// Results of stages, for pictures of something else than the light that leaves. Valid until the next start().
struct RenderStages {
    const Object* object = nullptr;
    const PointCloud* points = nullptr;      ///< of irradiance
    const Irradiance* irradiance = nullptr;  ///< at those points
    const VisibleSurface* visible = nullptr;
};

/// Keeps every stage's result. One thread at a time.
class Renderer {
public:
    /// `context`: for techniques on OpenGL and coats in a file, and outlives the renderer; null: neither.
    explicit Renderer(MaterialSource materials, gl::Context* context = nullptr);
    ~Renderer();

    void setScene(Scene scene);
    void setSettings(RenderSettings settings);

    /// The final picture: start(), step() until true, image(). It stays until the next call that draws. Throws Error; a
    /// stage that threw is redone next time. After a device Error of a context that is lost() the renderer is of no
    /// more use: another takes its place.
    const Image& render(Observer& observer);

    /// Brings every stage before the exitance up to date and begins that one.
    void start(Observer& observer);
    /// A slice of the exitance. True when it is final. Requires start().
    bool step(Observer& observer);
    /// The picture so far. Requires start().
    const Image& image(Observer& observer);

    /// The standard error of image() in every channel, alpha 1 where there is an object, for a technique that knows
    /// it; else empty. Samples of a pixel count as if they erred together: no less than the error. Requires start().
    Image standardError() const;

    const RenderReport& report() const;

    /// Requires start().
    RenderStages stages() const;

    /// What the MaterialSource would give has changed though the scene has not: a model's file was edited.
    void forgetMaterial();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Points of irradiance for a surface of that area, so that they stand closer than the medium blurs, a transport mean
/// free path of its densest channel: 100,000, 200,000, 400,000 or 800,000, so that a slider seldom changes it; the last
/// also where it is too few.
std::size_t defaultPointCount(double area_mm2, const Medium& medium);

/// What a user should know where it is too few.
std::optional<std::string> noteOfFewPoints(double area_mm2, const Medium& medium);

}  // namespace searchlight
