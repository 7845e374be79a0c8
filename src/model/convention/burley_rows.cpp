// Conventions that are a normalized diffusion profile, R(r) = A (exp(-r/d) + exp(-r/3d)) / (8 pi d r): burley, unreal,
// unity.
#include "model/convention/convention_rows.h"

namespace searchlight::convention {

namespace {

constexpr const char* one_albedo =
    "A is 1: nothing is absorbed, and the diffuse mean free path that the width is measured in is infinite";

double similarityOf(const Medium& medium, int c) { return similarity(medium.alphaPrime()[c], 0); }

// Free path that Eq. 5, 6 or 8 measures the width in, in reduced mean free paths.
double pathPerMeanFreePath(BurleyWidth width, double s) {
    return width == BurleyWidth::diffuse_mean_free_path ? 1 / (std::sqrt(3.0) * s) : 1;
}

Coefficients coefficients(double s, double sigma_tp) { return {s * s * sigma_tp, (1 - s * s) * sigma_tp}; }

// A and d of the medium; NaN for d without absorption where it is measured in diffuse mean free paths.
struct Profile {
    double A, d_mm;
};
Profile profileOf(const Medium& medium, int c, BurleyWidth width) {
    const double s = similarityOf(medium, c), A = surfaceAlbedo(width, s, medium.eta);
    const double path_mm = pathPerMeanFreePath(width, s) / medium.sigmaTp()[c];
    return {A, std::isfinite(path_mm) ? path_mm / burleyScale(width, A) : nan};
}

Coefficients mediumOf(double A, double d_mm, double index, BurleyWidth width) {
    const double s = surfaceAlbedoInverse(width, A, index);
    return coefficients(s, pathPerMeanFreePath(width, s) / (d_mm * burleyScale(width, A)));
}

std::string widthText() {
    return "A from the reduced albedo by the fits of models/normalized_diffusion (0.011 of exact for eta 1 to 1.6); d "
           "from the free path by Eq. 5, 6 or 8 of [ChristensenBurley2015], as --width says; g is lost (reduced)";
}

Medium readBurley(const ConventionValues& values, const ConventionContext& context) {
    return mediumFrom(values, 0, one(values, "eta"), [&](int c) {
        return mediumOf(at(values, "A", c), at(values, "d", c), one(values, "eta"), context.width);
    });
}

WrittenConvention writeBurley(const Medium& medium, const ConventionContext& context) {
    WrittenConvention written;
    written.values["A"] = perChannel(medium, [&](int c) { return profileOf(medium, c, context.width).A; });
    written.values["d"] = perChannel(medium, [&](int c) { return profileOf(medium, c, context.width).d_mm; });
    noteMissing(medium, written.values["d"], one_albedo, written.notes);
    written.values["eta"] = {medium.eta};
    return written;
}

// mean_free_path_distance is in cm; a world_unit_scale of 0.1 leaves it so.
double unrealUnit_mm(const ConventionValues& values) { return 10 * 10 * one(values, "world_unit_scale"); }

Medium readUnreal(const ConventionValues& values, const ConventionContext&) {
    return mediumFrom(values, 0, one(values, "ior"), [&](int c) {
        const double length_mm =
            unrealUnit_mm(values) * one(values, "mean_free_path_distance") * at(values, "mean_free_path_color", c);
        return coefficients(
            surfaceAlbedoInverse(BurleyWidth::searchlight, at(values, "surface_albedo", c), one(values, "ior")),
            1 / length_mm);
    });
}

WrittenConvention writeUnreal(const Medium& medium, const ConventionContext&) {
    WrittenConvention written;
    const auto A = [&](int c) { return surfaceAlbedo(BurleyWidth::searchlight, similarityOf(medium, c), medium.eta); };
    const std::vector<double> length_cm = perChannel(medium, [&](int c) { return 0.1 / medium.sigmaTp()[c]; });
    const double distance = largest(length_cm);
    written.values = {{"surface_albedo", perChannel(medium, A)},
                      {"mean_free_path_color", over(length_cm, distance)},
                      {"mean_free_path_distance", {distance}},
                      {"world_unit_scale", {0.1}},
                      {"ior", {medium.eta}}};
    std::string widths;
    for (int c = 0; c < medium.channels; ++c)
        if (medium.scatters(c))
            widths += fmt::format("{}{:.4g}", widths.empty() ? "" : ", ",
                                  1 / (0.6 * burleyScale(BurleyWidth::searchlight, A(c)) * medium.sigmaTp()[c]));
    written.notes.push_back(
        fmt::format("the engine blurs with d = {} mm, Eq. 5 over its own factor 0.6: wider than the paper's", widths));
    if (distance < 0.1 || distance > 50)
        written.notes.push_back(
            fmt::format("mean_free_path_distance {:.4g} cm is outside the editor's 0.1 to 50: scale both it and "
                        "world_unit_scale",
                        distance));
    for (int c = 0; c < medium.channels; ++c)
        if (medium.scatters(c) && length_cm[static_cast<std::size_t>(c)] < 0.009 * distance)
            written.notes.push_back("the engine raises mean_free_path_color to at least 0.009");
    return written;
}

Medium readUnity(const ConventionValues& values, const ConventionContext& context) {
    const double unit_mm = one(values, "multiplier") / one(values, "world_scale");
    return mediumFrom(values, 0, one(values, "index_of_refraction"), [&](int c) {
        return mediumOf(at(values, "base_color", c), unit_mm * at(values, "scattering_color", c),
                        one(values, "index_of_refraction"), context.width);
    });
}

WrittenConvention writeUnity(const Medium& medium, const ConventionContext& context) {
    WrittenConvention written;
    const std::vector<double> d = perChannel(medium, [&](int c) { return profileOf(medium, c, context.width).d_mm; });
    const double multiplier = largest(d);
    written.values = {{"base_color", perChannel(medium, [&](int c) { return profileOf(medium, c, context.width).A; })},
                      {"scattering_color", over(d, multiplier)},
                      {"multiplier", {multiplier}},
                      {"world_scale", {1}},
                      {"index_of_refraction", {medium.eta}}};
    noteMissing(medium, d, one_albedo, written.notes);
    return written;
}

}  // namespace

Convention burley() {
    return {.id = "burley",
            .aliases = {"normalized_diffusion"},
            .title = "Normalized diffusion: surface albedo and width",
            .source = "[ChristensenBurley2015] Eq. 3",
            .relation = widthText(),
            .keys = {color("A", "surface albedo: light that leaves again, of the light that has entered"),
                     lengths("d", "mm", "width of the profile (exp(-r/d) + exp(-r/3d)) / (8 pi d r)"), eta()},
            .read = readBurley,
            .write = writeBurley};
}

Convention unreal() {
    return {.id = "unreal",
            .aliases = {"unreal_engine", "ue5"},
            .title = "Unreal Engine 5, subsurface profile with mean free path",
            .source =
                "dev.epicgames.com, SubsurfaceProfileStruct; Engine, SubsurfaceProfile.cpp and "
                "BurleyNormalizedSSS: DMFP = MFP s8(A) / (0.6 s5(A)), profile width DMFP / s8(A)",
            .relation =
                "surface_albedo from the reduced albedo by the normal-beam fit of models/normalized_diffusion "
                "(0.011 of exact for eta 1 to 1.6); the mean free path is 1/sigma_t'; g is lost (reduced)",
            .keys = {color("surface_albedo", "light that leaves again, of the light that has entered"),
                     lengths("mean_free_path_color", "", "mean free path 1/sigma_t' over mean_free_path_distance"),
                     {{.name = "mean_free_path_distance",
                       .unit = "cm",
                       .min = 0,
                       .max = unlimited,
                       .required = true,
                       .exclusive = true},
                      "mean free path of the channel with the longest, 1/sigma_t'; times 10 world_unit_scale"},
                     number("world_unit_scale", 0.1, 1e-6, 1e6, "0.1: distances are in cm"),
                     eta("ior")},
            .read = readUnreal,
            .write = writeUnreal};
}

Convention unity() {
    return {
        .id = "unity",
        .aliases = {"hdrp"},
        .title = "Unity HDRP, diffusion profile",
        .source =
            "docs.unity3d.com, HDRP 17, Diffusion Profile; DiffusionProfileSettings: S = 1 / (multiplier times "
            "scattering color), profile S (exp(-S r) + exp(-S r/3)) / (8 pi r), r in mm at world scale 1",
        .relation = widthText(),
        .keys = {color("base_color", "diffuse colour of the material: A, the surface albedo"),
                 lengths("scattering_color", "", "width d of the profile over multiplier"),
                 {{.name = "multiplier", .unit = "mm", .min = 0, .max = unlimited, .required = true, .exclusive = true},
                  "width d of the widest channel, at world_scale 1"},
                 number("world_scale", 1, 1e-6, 1e6, "1: a scene unit is a metre"),
                 eta("index_of_refraction")},
        .read = readUnity,
        .write = writeUnity};
}

}  // namespace searchlight::convention
