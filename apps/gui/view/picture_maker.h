// Makes the pictures of the object view, on the engine's thread. What stays from one to the next stays in its
// renderers.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/image.h"
#include "gui/tasks/tasks.h"
#include "job/plot/subject.h"
#include "render/renderer.h"

namespace searchlight::gui {

/// What one side of the view shows.
struct PictureRequest {
    Scene scene;
    std::optional<SceneModel> inverted_by;  ///< of Rdr and ld; none: the scene's model
    std::string technique = "hierarchical";
    ParamValues technique_options;
    std::uint64_t seed = 1;
    int width = 0, height = 0;  ///< of the whole picture, device pixels
    double preview = 1;         ///< fraction of it that is computed
    bool moving = false;        ///< fewer rays at edges, and no new points: soon rather than well
    std::string layer = "picture";
};

/// One side, done.
struct Picture {
    std::shared_ptr<const Image> image;  ///< linear, of the computed size; null: none
    /// Of each pixel, the part that shows the object; null: the image's alpha says it, as nothing stands behind.
    std::shared_ptr<const std::vector<float>> coverage;
    RenderReport report;
    Subject subject;
    double ms = 0;  ///< on the engine's thread
};

/// Lives on one lane's thread.
class PictureMaker {
public:
    /// `side`: "a", "b": each has a renderer of its own. A technique that takes its time tells `so_far` a few times a
    /// second; a picture that moves is given up where it takes longer than a moment, and is what there is by then.
    /// Throws as Renderer does.
    Picture make(const std::string& side, const PictureRequest& request, TaskContext& context,
                 const std::function<void(const Picture&)>& so_far);

    /// That side is not shown any more.
    void forget(const std::string& side) { sides_.erase(side); }

    /// The file of that model was written.
    void modelFileChanged(const std::string& id);

    /// Before the engine ends.
    void clear();

private:
    struct Side {
        Subject subject;
        std::optional<SceneModel> inverted_by;
        bool has_context = false;
        std::unique_ptr<Renderer> renderer;
        std::size_t points = 0;  ///< of the last picture
    };
    struct LoadedFile {
        Model model;
        std::shared_ptr<Evaluator> evaluator;
    };

    Picture makeOnce(const std::string& side, const PictureRequest& request, TaskContext& context,
                     const std::function<void(const Picture&)>& so_far);
    RenderMaterial materialOf(const Scene& scene, Engine& engine, Side& side);

    std::map<std::string, Side> sides_;
    std::map<std::string, LoadedFile> files_;  ///< models that OpenGL compiled, by id: a slider must not compile again
};

}  // namespace searchlight::gui
