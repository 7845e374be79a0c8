// What is looked at, as plain data: object, camera, lights, material, model. docs/scene.md describes its JSON.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/param.h"
#include "base/vec.h"
#include "scene/medium.h"

namespace searchlight {

// Positions in a scene are in multiples of the object's longest side, from the centre of its bounding box, y up: so
// `scale` changes how deep light goes, never the framing.

/// Looks at `target` from a sphere around it.
struct Camera {
    double azimuth_deg = 30;        ///< about +y, from +z towards +x
    double elevation_deg = 15;      ///< above the horizon
    double distance = 0;            ///< from the target; 0: the object fills 70 % of the picture's height
    double field_of_view_deg = 35;  ///< vertical
    Vec3 target;
};

struct DirectionalLight {
    Vec3 direction{-1, 1, 1};  ///< towards the light
    Rgb irradiance{1, 1, 1};   ///< on a surface that faces the light
    double angle_deg = 0;      ///< diameter of the disc that it is (the sun: 0.53); 0: parallel light
    std::string filter;        ///< a picture the light passes, across the object's bounding sphere; empty: none
};

struct EnvironmentLight {
    std::string path;                ///< a picture of all directions; docs/light.md says which way is where
    Rgb intensity{1, 1, 1};          ///< times the picture's radiance
    double rotation_deg = 0;         ///< about +y, from +z towards +x
    bool occlusion = false;          ///< the object shadows itself
    std::string layout = "latlong";  ///< or "mirror_ball", "angular"
};

struct PointLight {
    Vec3 position{1, 1, 1};
    Rgb intensity{1, 1, 1};  ///< irradiance on a facing surface at distance 1 (one longest side)
};

using Light = std::variant<DirectionalLight, EnvironmentLight, PointLight>;

/// One of: an id for findMaterial(); sigma_a and sigma_s; Rdr and ld, to be inverted by the model. Lists hold one
/// number or three.
struct SceneMaterial {
    std::string id = "skin1";              ///< empty: one of the other two
    std::vector<double> sigma_a, sigma_s;  ///< 1/mm, sigma_s not reduced
    std::vector<double> g{0};              ///< mean cosine; beside either pair
    std::vector<double> Rdr;               ///< total diffuse reflectance
    std::vector<double> ld;                ///< diffuse mean free path, mm
    double eta = 1.3;
    double scale = 1;  ///< lengths of the medium times this, so coefficients divided by it

    /// True when the medium has to be found from Rdr and ld.
    bool inverted() const { return !Rdr.empty(); }
};

struct SceneModel {
    std::string id = "dipole";  ///< for loadModel()
    /// Its parameters as written: numbers, toggles, text or lists. valueText() and parseValue() make them fit a Param.
    ParamValues parameters;
};

/// A plane below the object.
struct Ground {
    double height = 0;  ///< above the object's lowest point, which 0 touches
    Rgb albedo{0.5, 0.5, 0.5};
};

/// A rough dielectric of the material's eta on top; or a .brdf file in its place.
struct Coat {
    double roughness = 0.3;
    std::string brdf;
    ParamValues parameters;  ///< of the .brdf file, as written: as in SceneModel
};

struct Scene {
    std::string object = "sphere";  ///< a built-in object, or a path to a mesh or a point cloud
    double scale = 10;              ///< mm along the longest side of the object
    Camera camera;
    SceneMaterial material;
    SceneModel model;
    std::vector<Light> lights{DirectionalLight{}};
    std::optional<Ground> ground;
    std::optional<Rgb> backdrop;  ///< radiance behind everything; none: transparent, or the environment
    std::optional<Coat> coat;
};

/// A JSON object of the format and its keys: what a reference page, a form or a command line needs to know.
struct SceneSection {
    std::string name;  ///< "camera", "directional light"
    std::string doc;   ///< one line
    std::vector<Param> keys;
};

/// Every section, in the order of the format.
const std::vector<SceneSection>& sceneSections();

/// Reads "searchlight-scene/1"; absent keys have their defaults. Throws an input Error with file, line and column,
/// whose message starts with the JSON pointer of the value that is wrong. Files that the scene names are not opened.
Scene parseScene(std::string_view text, std::string_view path);

/// The JSON text that parseScene reads back exactly, every key written, indented by two.
std::string sceneJson(const Scene& scene);

/// The material named or spelled out. Requires !material.inverted(). Throws as findMaterial and checkMedium.
Material resolveMaterial(const SceneMaterial& material);

}  // namespace searchlight
