// The keys of a scene file, each stated once; read_scene.cpp and write_scene.cpp follow these tables.
#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/param.h"
#include "scene/scene.h"

namespace searchlight::scene_format {

inline constexpr std::string_view format_name = "searchlight-scene/";
inline constexpr int format_version = 1;
inline constexpr double unlimited = 1e30;  // as rangeText() understands it

/// A key of the format, as a Param, tied to a member.
template <class T>
struct Field {
    Param param;
    std::variant<double T::*, bool T::*, Vec3 T::*, Rgb T::*, std::string T::*, std::vector<double> T::*> member;
};

// The member's default is the Param's: it is stated once, in scene.h.
template <class T, class Value>
Field<T> field(const char* name, Value T::*member, ParamType type, const char* unit, double min, double max,
               const char* doc) {
    const Value value = T{}.*member;
    Param param{name, type, unit, min, max, {}, {}, doc};
    if constexpr (std::is_same_v<Value, Vec3>)
        param.value = std::vector<double>{value.x, value.y, value.z};
    else
        param.value = value;
    return {std::move(param), member};
}

// A text that is one of `choices`.
template <class T>
Field<T> choiceField(const char* name, std::string T::*member, std::vector<std::string> choices, const char* doc) {
    Field<T> chosen = field(name, member, ParamType::choice, "", 0, 0, doc);
    chosen.param.choices = std::move(choices);
    return chosen;
}

inline const std::vector<Field<Scene>> scene_fields{
    field("object", &Scene::object, ParamType::path, "", 0, 0, "a built-in object, or a mesh or point cloud file"),
    field("scale", &Scene::scale, ParamType::number, "mm", 1e-6, 1e6, "length of the object's longest side"),
};

inline const std::vector<Field<Camera>> camera_fields{
    field("azimuth_deg", &Camera::azimuth_deg, ParamType::number, "deg", -360, 360, "about +y, from +z towards +x"),
    field("elevation_deg", &Camera::elevation_deg, ParamType::number, "deg", -90, 90, "above the horizon"),
    field("distance", &Camera::distance, ParamType::number, "", 0, 1e3,
          "from the target, in longest sides; 0: the object fills 70 % of the picture's height"),
    field("field_of_view_deg", &Camera::field_of_view_deg, ParamType::number, "deg", 1, 170, "vertical"),
    field("target", &Camera::target, ParamType::numbers, "", 0, 0,
          "x, y, z looked at, in longest sides from the centre of the bounding box"),
};

inline constexpr double least_ld_mm = 1e-9;

inline const std::vector<Field<SceneMaterial>> material_fields{
    field("id", &SceneMaterial::id, ParamType::path, "", 0, 0, "a measured material, in place of the numbers below"),
    field("sigma_a", &SceneMaterial::sigma_a, ParamType::channels, "1/mm", 0, unlimited, "absorption coefficient"),
    field("sigma_s", &SceneMaterial::sigma_s, ParamType::channels, "1/mm", 0, unlimited,
          "scattering coefficient, not reduced"),
    field("g", &SceneMaterial::g, ParamType::channels, "", -1, 1, "mean cosine of the phase function"),
    field("Rdr", &SceneMaterial::Rdr, ParamType::channels, "", 0, 1,
          "total diffuse reflectance, inverted by the model"),
    field("ld", &SceneMaterial::ld, ParamType::channels, "mm", least_ld_mm, unlimited,
          "diffuse mean free path, beside Rdr"),
    field("eta", &SceneMaterial::eta, ParamType::number, "", 0.25, 4, "refractive index, inside over outside"),
    field("scale", &SceneMaterial::scale, ParamType::number, "", 1e-6, 1e6,
          "lengths of the medium times this, so coefficients divided by it"),
};

inline const std::vector<Field<SceneModel>> model_fields{
    field("id", &SceneModel::id, ParamType::path, "", 0, 0, "a shipped model, or a .bssrdf or measured .csv file"),
};

inline const std::vector<Field<DirectionalLight>> directional_fields{
    field("direction", &DirectionalLight::direction, ParamType::numbers, "", 0, 0, "x, y, z towards the light"),
    field("irradiance", &DirectionalLight::irradiance, ParamType::color, "", 0, unlimited,
          "on a surface that faces it"),
    field("angle_deg", &DirectionalLight::angle_deg, ParamType::number, "deg", 0, 180,
          "diameter of the disc it is (the sun: 0.53); 0 is parallel light"),
    field("filter", &DirectionalLight::filter, ParamType::text, "", 0, 0,
          "picture that the light passes, across the object's bounding sphere"),
};

inline const std::vector<Field<EnvironmentLight>> environment_fields{
    field("path", &EnvironmentLight::path, ParamType::path, "", 0, 0, "a picture of all directions"),
    field("intensity", &EnvironmentLight::intensity, ParamType::color, "", 0, unlimited,
          "times the picture's radiance"),
    field("rotation_deg", &EnvironmentLight::rotation_deg, ParamType::number, "deg", -360, 360,
          "about +y, from +z towards +x"),
    field("occlusion", &EnvironmentLight::occlusion, ParamType::toggle, "", 0, 0, "the object shadows itself"),
    choiceField("layout", &EnvironmentLight::layout, {"latlong", "mirror_ball", "angular"},
                "how the picture shows all directions"),
};

inline const std::vector<Field<PointLight>> point_fields{
    field("position", &PointLight::position, ParamType::numbers, "", 0, 0,
          "x, y, z in longest sides from the centre of the bounding box"),
    field("intensity", &PointLight::intensity, ParamType::color, "", 0, unlimited,
          "irradiance on a facing surface at distance 1"),
};

inline const std::vector<Field<Ground>> ground_fields{
    field("height", &Ground::height, ParamType::number, "", -1e3, 1e3,
          "of the plane above the object's lowest point, in longest sides"),
    field("albedo", &Ground::albedo, ParamType::color, "", 0, 1, "of a diffuse surface"),
};

inline const std::vector<Field<Coat>> coat_fields{
    field("roughness", &Coat::roughness, ParamType::number, "", 0, 1, "of a dielectric with the material's eta"),
    field("brdf", &Coat::brdf, ParamType::text, "", 0, 0, "a .brdf file in place of the dielectric"),
};

// Keys whose values are sections of their own, lists, or have two shapes.
inline const std::vector<std::string> scene_extra_keys{"format", "camera", "material", "model",
                                                       "lights", "ground", "backdrop", "coat"};

inline const Param backdrop_param{
    "backdrop", ParamType::color, "", 0, unlimited, Rgb{}, {}, "radiance behind everything"};

}  // namespace searchlight::scene_format
