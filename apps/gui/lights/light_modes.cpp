#include "gui/lights/light_modes.h"

namespace searchlight::gui {

std::span<const LightMode> lightModes() {
    static constexpr LightMode modes[] = {
        {"Studio", "A key light from behind and a weak fill from the front", "lights", nullptr,
         [](const std::string&) -> std::vector<Light> {
             return {DirectionalLight{.direction = {-1.0, 0.9, -0.55}, .irradiance = {2.2, 2.05, 1.9}},
                     DirectionalLight{.direction = {0.9, 0.6, 1.0}, .irradiance = {0.55, 0.6, 0.7}}};
         }},
        {"Parallel", "One directional light", "sun_direct", nullptr,
         [](const std::string&) -> std::vector<Light> {
             return {DirectionalLight{.direction = {-1, 1, 1}, .irradiance = {2, 2, 2}}};
         }},
        {"Point", "One lamp near the object", "point", nullptr,
         [](const std::string&) -> std::vector<Light> {
             return {PointLight{.position = {-0.7, 0.7, 0.5}, .intensity = {2, 2, 2}}};
         }},
        {"Filtered", "Directional light through a picture, as through stained glass", "filter",
         "The picture that the light passes",
         [](const std::string& picture) -> std::vector<Light> {
             return {DirectionalLight{.direction = {-0.5, 0.6, 1}, .irradiance = {3, 3, 3}, .filter = picture}};
         }},
        {"Environment", "A picture of all directions, without shadows", "environment", "A picture of all directions",
         [](const std::string& picture) -> std::vector<Light> { return {EnvironmentLight{.path = picture}}; }},
        {"Occluded", "A picture of all directions; the object shadows itself", "object", "A picture of all directions",
         [](const std::string& picture) -> std::vector<Light> {
             return {EnvironmentLight{.path = picture, .occlusion = true}};
         }},
    };
    return modes;
}

int modeOf(const std::vector<Light>& lights) {
    if (lights.size() == 2 && std::holds_alternative<DirectionalLight>(lights[0]) &&
        std::holds_alternative<DirectionalLight>(lights[1]))
        return 0;
    if (lights.size() != 1) return -1;
    if (const auto* directional = std::get_if<DirectionalLight>(&lights[0])) return directional->filter.empty() ? 1 : 3;
    if (const auto* environment = std::get_if<EnvironmentLight>(&lights[0])) return environment->occlusion ? 5 : 4;
    return 2;
}

}  // namespace searchlight::gui
