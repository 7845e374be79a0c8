// What the window shows, as plain data: one immutable value at a time. Undo, files, the engine and every dock read it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/param.h"
#include "job/job.h"
#include "scene/scene.h"

namespace searchlight::gui {

/// One of the models that are compared.
struct ModelSlot {
    SceneModel model;
    std::optional<SceneMaterial> material;  ///< its own; none: the scene's, which all others share
    int color = 0;                          ///< index into the palette of figures (draw/palette.h)
    bool visible = true;
};

/// Values of a section's options by the names of its Params (sections()); absent: default.
using SectionOptions = std::map<std::string, ParamValues, std::less<>>;

struct State {
    Scene scene;                    ///< its model is the active slot's; its material is what slots without one share
    std::vector<ModelSlot> models;  ///< never empty
    int active = 0;                 ///< index into models: what the object view shows and the editor edits
    int solo = -1;                  ///< index into models that plots show alone, channel by channel; -1: none
    std::string technique = "hierarchical";
    ParamValues technique_options;
    SectionOptions options;  ///< of the view and of docks
    std::uint64_t seed = 1;

    const ModelSlot& activeModel() const { return models[static_cast<std::size_t>(active)]; }
};

/// What differs between two states, as bits.
enum class Part : unsigned {
    object = 1 << 0,      ///< shape and its size in mm
    camera = 1 << 1,      //
    lights = 1 << 2,      //
    surround = 1 << 3,    ///< ground, backdrop, coat
    material = 1 << 4,    ///< of the scene or of any slot
    models = 1 << 5,      ///< which models there are, in which order; their colours, visibility, solo
    parameters = 1 << 6,  ///< of a model
    active = 1 << 7,      ///< another slot is the active one
    technique = 1 << 8,   ///< or its options
    options = 1 << 9,     ///< of a section
    seed = 1 << 10
};

/// A set of Parts.
class Change {
public:
    Change() = default;
    explicit Change(unsigned bits) : bits_(bits) {}
    bool has(Part part) const { return (bits_ & static_cast<unsigned>(part)) != 0; }
    bool any(std::initializer_list<Part> parts) const {
        for (const Part part : parts)
            if (has(part)) return true;
        return false;
    }
    void add(Part part) { bits_ |= static_cast<unsigned>(part); }
    bool empty() const { return bits_ == 0; }
    /// Everything, as when a file was opened.
    static Change all() { return Change(~0u); }

private:
    unsigned bits_ = 0;
};

/// Which parts differ. Two equal states have none.
Change difference(const State& before, const State& after);

/// Options of the window beyond the scene that are part of a workspace, undone and kept as everything else.
struct Section {
    std::string name;  ///< "view", "plot", "spheres"
    std::vector<Param> options;
};

/// Every section, each stated where it belongs: a row of sections.cpp.
const std::vector<Section>& sections();

/// The value of an option, or its default. Asserts that section and option exist.
const ParamValue& optionOf(const State& state, std::string_view section, std::string_view name);

/// What is shown at the first start: the statue of skin1, three models.
State defaultState();

/// The scene as slot `model` sees it: its model, and its material where it has one.
Scene sceneOf(const State& state, int model);

/// A slot for that model with the next unused colour.
ModelSlot newSlot(const State& state, std::string id);

/// Puts the active slot's model into the scene, and brings indices into range. Whoever edits a state calls
/// it (Workspace::edit does).
void normalise(State& state);

/// The render job that makes the picture which the window shows, with the rest of the state as its `window`: the
/// command line runs it.
Job renderJob(const State& state);

/// The job as text: a workspace file.
std::string workspaceJson(const State& state);

/// Reads a workspace, any other searchlight-job/1 that renders, or a searchlight-scene/1. Throws an input Error with
/// file, line and column. Models and shapes that it names are not opened.
State parseWorkspace(std::string_view text, std::string_view path);

}  // namespace searchlight::gui
