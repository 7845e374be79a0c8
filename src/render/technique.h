// How the integral of a BSSRDF over a surface is evaluated. One file per technique, one row in technique.cpp.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/cache_folder.h"
#include "base/image.h"
#include "base/observer.h"
#include "base/param.h"
#include "geometry/object.h"
#include "light/irradiance.h"
#include "model/evaluator.h"
#include "model/plane.h"
#include "render/view.h"

namespace searchlight {

namespace gl {
class Context;
}

/// Everything that a technique reads. What a change makes stale is recomputed, and nothing else: each part has a
/// version that its owner counts up.
struct RenderInput {
    const Scene* scene = nullptr;
    const Object* object = nullptr;
    const RayScene* rays = nullptr;      ///< of object->mesh
    const PointCloud* points = nullptr;  ///< of irradiance; null unless LightPlace::points
    const Irradiance* irradiance =
        nullptr;  ///< at those points, or at the samples of visible; null for LightPlace::own
    const VisibleSurface* visible = nullptr;  ///< receivers
    const View* view = nullptr;               ///< what they were seen with
    const Model* model = nullptr;
    Evaluator* evaluator = nullptr;  ///< set to the medium
    const Medium* medium = nullptr;
    const Profile* profile = nullptr;  ///< of a radial model, or of one that is taken for radial; null otherwise
    IrradianceOptions light;           ///< with these computeIrradiance() gives the light at any points of the object
    const CacheFolder* points_cache = nullptr;  ///< where points of a mesh are kept; null: nowhere
    int threads = 0;                            ///< 0: all
    struct Versions {
        std::uint64_t points = 0, light = 0, view = 0, material = 0;
    } versions;
};

/// What a step cost and promises, by names that the JSON output uses.
struct TechniqueReport {
    std::map<std::string, double> stage_ms;  ///< "tree", "sum"
    std::uint64_t interactions = 0;
    double error_bound = 0;     ///< relative RMSE that is promised; 0: none
    double standard_error = 0;  ///< relative, a RMS over the receivers, of noise that is measured; 0: there is none
    std::string approximates;   ///< one sentence: what it leaves out
    std::string device;
    std::map<std::string, double> numbers;  ///< what else can be said of it, by names that the JSON output uses
    std::vector<std::string> notes;         ///< what a user should know; known after start()
};

/// The parameters that the scene gives to the model, for another evaluator of it.
ParamValues modelParameters(const RenderInput& input);

/// Progressive: start, then step until done. Holds its caches from one start to the next.
class Technique {
public:
    virtual ~Technique() = default;

    /// Takes what changed. `input` and what it points to stay alive and unchanged until the next start.
    virtual void start(const RenderInput& input, const ParamValues& options, Observer& observer) = 0;

    /// A slice of work. Returns true when the answer is final.
    virtual bool step(Observer& observer) = 0;

    /// Exitance M per sample of input.visible so far, flux per mm^2 that left after scattering, before T21: the picture
    /// is T21(wo) M / (pi 4 C_phi(1/eta)). For a model that reads wo it is the sum of Q(wo) over the transmitted flux,
    /// wo being the direction to input.visible->eye.
    virtual std::span<const Rgbf> exitance() const = 0;

    /// Standard error of exitance(), where a technique knows it from its own scatter; else empty.
    virtual std::span<const Rgbf> standardError() const { return {}; }

    virtual TechniqueReport report() const = 0;
};

/// Where a technique reads the light.
enum class LightPlace {
    points,   ///< at points that the renderer spreads over the object
    visible,  ///< at the visible samples
    own,      ///< where it asks for it itself, by RenderInput::light: the renderer makes neither points nor light
};

/// What a technique's accuracy is bought with.
struct Budget {
    std::string_view option;     ///< of the technique or of the picture ("points"); empty: it has one price
    std::vector<double> values;  ///< worth a comparison, from cheap to dear
};

/// A row of the table: id and one line, options as Params, and how to make one.
struct TechniqueEntry {
    std::string_view id;  ///< "hierarchical"
    std::string_view summary;
    std::vector<Param> options;
    Budget budget;
    bool directional = false;  ///< takes models that are not radial
    LightPlace light_at = LightPlace::points;
    bool gl = false;  ///< has a version on OpenGL, which make() gives for a context; null makes the CPU's
    std::unique_ptr<Technique> (*make)(gl::Context* context);
};

/// The option of techniques by which a model that is not radial stands in a picture with its azimuthal mean under a
/// normal beam. Whoever gives the technique its profile obeys it.
inline constexpr std::string_view normal_beam_option = "normal_beam";

/// In menu order.
std::span<const TechniqueEntry> techniques();

/// Throws unknownName.
const TechniqueEntry& findTechnique(std::string_view id);

/// Whether the model is a function of distance alone, so that its profile says all of it.
bool isRadial(const Model& model);

}  // namespace searchlight
