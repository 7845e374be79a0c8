#include "gui/view/view_options.h"

namespace searchlight::gui {

std::vector<Param> viewOptions() {
    return {
        {.name = "auto_exposure",
         .type = ParamType::toggle,
         .value = true,
         .doc = "the exposure that suits the picture"},
        {.name = "exposure",
         .unit = "stops",
         .min = -16,
         .max = 16,
         .value = 0.0,
         .doc = "brightness, in powers of two"},
        {.name = "curve",
         .type = ParamType::choice,
         .value = std::string("srgb"),
         .choices = {"srgb", "filmic"},
         .doc = "how bright light meets the limits of a display"},
        {.name = "gamma", .min = 0.1, .max = 10, .value = 1.0, .doc = "on top of sRGB"},
        {.name = "channel",
         .type = ParamType::choice,
         .value = std::string("color"),
         .choices = {"color", "red", "green", "blue", "luminance"},
         .doc = "which part of the light is shown"},
        {.name = "layer",
         .type = ParamType::choice,
         .value = std::string("picture"),
         .choices = {"picture", "irradiance", "points"},
         .doc = "what is shown: the light that leaves, the light that arrives, or the points that stand for it"},
        {.name = "compare",
         .type = ParamType::choice,
         .value = std::string("none"),
         .choices = {"none", "wipe", "difference"},
         .doc = "beside what it is compared with: nothing, a wipe, or their difference in false colour"},
        {.name = "against",
         .type = ParamType::text,
         .value = std::string("reference"),
         .doc = "what the picture is compared with: reference, model N, or technique ID"},
        {.name = "wipe", .min = 0, .max = 1, .value = 0.5, .doc = "where the wipe stands, from the left"},
        {.name = "difference_scale",
         .unit = "%",
         .min = 0.1,
         .max = 1000,
         .value = 20.0,
         .doc = "the difference, of the reference picture's mean, at the ends of the scale"},
    };
}

}  // namespace searchlight::gui
