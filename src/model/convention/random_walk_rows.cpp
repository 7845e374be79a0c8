// Conventions of renderers that walk: a surface colour is turned into a single-scattering albedo, a radius into a free
// path. Cycles, OpenPBR, standard surface, and the fit of Chiang, Kutz and Burley.
#include <numbers>

#include "base/error.h"
#include "model/convention/convention_rows.h"

namespace searchlight::convention {

namespace {

constexpr double cycles_radius = 4 * std::numbers::pi;  // bssrdf_setup_radius() divides by it

double alphaOf(const Medium& medium, int c) { return medium.sigma_s[c] / medium.sigmaT()[c]; }

Coefficients coefficients(double alpha, double sigma_t) { return {(1 - alpha) * sigma_t, alpha * sigma_t}; }

// Of [vandeHulst1980], which OpenPBR prints and Cycles uses.
double alphaOfColor(double color, double g) { return albedoOfSimilarity(vanDeHulstInverse(color), g); }
double colorOf(const Medium& medium, int c) { return vanDeHulst(similarity(alphaOf(medium, c), medium.g[c])); }

const char* const van_de_hulst =
    "colour to albedo by van de Hulst's fit for diffuse light without a boundary, whose inverse Kulla and Conty print "
    "[Kulla2017]: within 0.0051 of the exact albedo (g 0, colours 0.02 to 0.99)";
const char* const wrenninge =
    "colour to albedo by the fit of [Wrenninge2017]: within 0.0037 of the exact albedo without a boundary (g 0, "
    "colours "
    "0.02 to 0.99), and never above 0.999999";

// What the convention's colour leaves out.
void noteInterface(const Medium& medium, std::vector<std::string>& notes) {
    if (medium.eta == 1) return;
    std::string list;
    for (int c = 0; c < medium.channels; ++c)
        if (medium.scatters(c))
            list +=
                fmt::format("{}{:.3f}", list.empty() ? "" : ", ",
                            surfaceAlbedo(BurleyWidth::searchlight, similarity(medium.alphaPrime()[c], 0), medium.eta));
    notes.push_back(
        fmt::format("the colour is that of the medium without its surface; behind a surface of eta {:.4g} the share of "
                    "the entered light that leaves again is {}",
                    medium.eta, list));
}

// radius times scale, in scene units, as three factors up to 1 and one scale.
void setRadius(WrittenConvention& written, const std::vector<double>& radius, const char* factor, const char* scale) {
    const double widest = largest(radius);
    written.values[factor] = over(radius, widest);
    written.values[scale] = {widest};
}

double radiusOf(const ConventionValues& values, int c, const ConventionContext& context) {
    return context.unit_mm * one(values, "subsurface_scale") * at(values, "subsurface_radius", c);
}

std::vector<ConventionKey> cyclesKeys(const std::string& radius, double g_min, double g_max) {
    return {color("base_color", "reflectance for diffuse light, without surface reflection"),
            lengths("subsurface_radius", "", radius),
            number("subsurface_scale", 1, 1e-12, 1e12, "of subsurface_radius", "scene units"),
            number("subsurface_anisotropy", 0, g_min, g_max, "mean cosine of the phase function"), eta("ior")};
}

Medium readCycles(const ConventionValues& values, const ConventionContext& context) {
    const double g = one(values, "subsurface_anisotropy");
    return mediumFrom(values, g, one(values, "ior"), [&](int c) {
        return coefficients(alphaOfColor(at(values, "base_color", c), g), cycles_radius / radiusOf(values, c, context));
    });
}

WrittenConvention writeCycles(const Medium& given, const ConventionContext& context) {
    WrittenConvention written;
    const Medium medium = withOneG(given, -.99, .99, written.notes);
    written.values["base_color"] = perChannel(medium, [&](int c) { return colorOf(medium, c); });
    setRadius(written,
              perChannel(medium, [&](int c) { return cycles_radius / (medium.sigmaT()[c] * context.unit_mm); }),
              "subsurface_radius", "subsurface_scale");
    written.values["subsurface_anisotropy"] = {medium.g.r};
    written.values["ior"] = {medium.eta};
    noteInterface(medium, written.notes);
    return written;
}

Medium readLegacy(const ConventionValues& values, const ConventionContext& context, bool skin) {
    const double g = one(values, "subsurface_anisotropy");
    return mediumFrom(values, g, one(values, "ior"), [&](int c) {
        const double A = at(values, "base_color", c);
        // The skin's radius is a diffuse mean free path: times sqrt(3 (1 - alpha')), alpha' of the classical dipole.
        const double path = skin ? std::sqrt(3.0) * dipoleInverse(A, one(values, "ior")) : 1 / cycles_radius;
        return coefficients(wrenningeAlbedo(A, g), 1 / (path * radiusOf(values, c, context) * (1 - g)));
    });
}

WrittenConvention writeLegacy(const Medium& given, const ConventionContext& context, bool skin) {
    WrittenConvention written;
    const Medium medium = withOneG(given, 0, .9, written.notes);
    const double g = medium.g.r;
    const std::vector<double> base_color =
        perChannel(medium, [&](int c) { return wrenningeInverse(alphaOf(medium, c), g); });
    written.values["base_color"] = base_color;
    noteMissing(medium, base_color, "no base_color gives this albedo: the fit reaches 0.999999", written.notes);
    const std::vector<double> radius = perChannel(medium, [&](int c) {
        const double A = base_color[static_cast<std::size_t>(c)];
        const double path = skin ? std::sqrt(3.0) * dipoleInverse(A, medium.eta) : 1 / cycles_radius;
        return 1 / (medium.sigmaT()[c] * (1 - g) * path * context.unit_mm);
    });
    if (skin)
        for (int c = 0; c < medium.channels; ++c)
            if (medium.scatters(c) && std::isnan(radius[static_cast<std::size_t>(c)]) &&
                !std::isnan(base_color[static_cast<std::size_t>(c)]))
                written.notes.push_back(fmt::format("base_color {:.4g} is beyond the classical dipole's totals",
                                                    base_color[static_cast<std::size_t>(c)]));
    setRadius(written, radius, "subsurface_radius", "subsurface_scale");
    written.values["subsurface_anisotropy"] = {g};
    written.values["ior"] = {medium.eta};
    noteInterface(medium, written.notes);
    return written;
}

Medium readCyclesBurley(const ConventionValues& values, const ConventionContext& context) {
    return mediumFrom(values, 0, one(values, "ior"), [&](int c) {
        const double A = at(values, "base_color", c);
        const double s = surfaceAlbedoInverse(context.width, A, one(values, "ior"));
        const double path = context.width == BurleyWidth::diffuse_mean_free_path ? std::sqrt(3.0) * s : 1;
        const double d_mm = radiusOf(values, c, context) / cycles_radius;
        const double sigma_tp = 1 / (path * d_mm * burleyScale(context.width, A));
        return Coefficients{s * s * sigma_tp, (1 - s * s) * sigma_tp};
    });
}

WrittenConvention writeCyclesBurley(const Medium& medium, const ConventionContext& context) {
    WrittenConvention written;
    const auto s = [&](int c) { return similarity(medium.alphaPrime()[c], 0); };
    const std::vector<double> A =
        perChannel(medium, [&](int c) { return surfaceAlbedo(context.width, s(c), medium.eta); });
    written.values["base_color"] = A;
    const std::vector<double> radius = perChannel(medium, [&](int c) {
        const double path = context.width == BurleyWidth::diffuse_mean_free_path ? std::sqrt(3.0) * s(c) : 1;
        const double d_mm =
            1 / (path * medium.sigmaTp()[c] * burleyScale(context.width, A[static_cast<std::size_t>(c)]));
        return std::isfinite(d_mm) ? cycles_radius * d_mm / context.unit_mm : nan;
    });
    noteMissing(medium, radius, "nothing is absorbed: the diffuse mean free path is infinite", written.notes);
    setRadius(written, radius, "subsurface_radius", "subsurface_scale");
    written.values["ior"] = {medium.eta};
    return written;
}

Medium readChiang(const ConventionValues& values, const ConventionContext&) {
    return mediumFrom(values, 0, one(values, "eta"), [&](int c) {
        const double A = at(values, "A", c);
        return coefficients(chiangAlbedo(A), 1 / (at(values, "d", c) * burleyScale(BurleyWidth::diffuse, A)));
    });
}

WrittenConvention writeChiang(const Medium& given, const ConventionContext&) {
    WrittenConvention written;
    const Medium medium = withOneG(given, 0, 0, written.notes);
    const std::vector<double> A = perChannel(medium, [&](int c) { return chiangInverse(alphaOf(medium, c)); });
    written.values["A"] = A;
    written.values["d"] = perChannel(medium, [&](int c) {
        return 1 / (medium.sigmaT()[c] * burleyScale(BurleyWidth::diffuse, A[static_cast<std::size_t>(c)]));
    });
    written.values["eta"] = {medium.eta};
    for (int c = 0; c < medium.channels; ++c)
        if (medium.scatters(c) && std::isnan(A[static_cast<std::size_t>(c)]))
            written.notes.push_back(fmt::format("{}no A gives the albedo {:.6g}: the fit ends at {:.6g}",
                                                medium.channels == 1 ? "" : fmt::format("{}: ", "RGB"[c]),
                                                alphaOf(medium, c), chiangAlbedo(1)));
    noteInterface(medium, written.notes);
    return written;
}

// OpenPBR and standard surface differ in the names and in what is a colour.
struct SurfaceNames {
    const char *radius, *scale, *anisotropy, *ior;
};
constexpr SurfaceNames open_pbr{"subsurface_radius_scale", "subsurface_radius", "subsurface_scatter_anisotropy",
                                "specular_ior"};
constexpr SurfaceNames standard_surface{"subsurface_radius", "subsurface_scale", "subsurface_anisotropy",
                                        "specular_IOR"};

template <const SurfaceNames& names>
Medium readSurface(const ConventionValues& values, const ConventionContext& context) {
    const double g = one(values, names.anisotropy);
    return mediumFrom(values, g, one(values, names.ior), [&](int c) {
        const double length_mm = context.unit_mm * one(values, names.scale) * at(values, names.radius, c);
        return coefficients(alphaOfColor(at(values, "subsurface_color", c), g), 1 / length_mm);
    });
}

template <const SurfaceNames& names>
WrittenConvention writeSurface(const Medium& given, const ConventionContext& context) {
    WrittenConvention written;
    const Medium medium = withOneG(given, -1, 1, written.notes);
    written.values["subsurface_color"] = perChannel(medium, [&](int c) { return colorOf(medium, c); });
    setRadius(written, perChannel(medium, [&](int c) { return 1 / (medium.sigmaT()[c] * context.unit_mm); }),
              names.radius, names.scale);
    written.values[names.anisotropy] = {medium.g.r};
    written.values[names.ior] = {medium.eta};
    noteInterface(medium, written.notes);
    return written;
}

ConventionKey anisotropy(const char* name) { return number(name, 0, -.99, .99, "mean cosine of the phase function"); }

}  // namespace

Convention cycles() {
    return {.id = "cycles",
            .aliases = {"blender"},
            .title = "Blender 5.2 Cycles, Principled BSDF, Random Walk",
            .source = "blender/cycles 695bae3, kernel/closure/bssrdf.h and kernel/integrator/subsurface_random_walk.h",
            .relation = std::string(van_de_hulst) + "; sigma_t = 4 pi / (radius scale)",
            .keys = cyclesKeys("4 pi mean free paths 1/sigma_t, over subsurface_scale", -.99, .99),
            .read = readCycles,
            .write = writeCycles};
}

Convention cyclesLegacy() {
    return {.id = "cycles_legacy",
            .aliases = {"blender4"},
            .title = "Cycles, Random Walk (Legacy) of Blender 5.2: Random Walk of 4, Fixed Radius of 3",
            .source =
                "blender/cycles 695bae3, kernel/closure/bssrdf.h and kernel/integrator/subsurface_random_walk.h; the "
                "same in 3.0 to "
                "4.5",
            .relation = std::string(wrenninge) + "; sigma_t (1 - g) = 4 pi / (radius scale)",
            .keys = cyclesKeys("4 pi / (sigma_t (1 - g)), over subsurface_scale", 0, .9),
            .read = [](const ConventionValues& values,
                       const ConventionContext& context) { return readLegacy(values, context, false); },
            .write = [](const Medium& medium,
                        const ConventionContext& context) { return writeLegacy(medium, context, false); }};
}

Convention cyclesSkin() {
    return {.id = "cycles_skin",
            .aliases = {},
            .title = "Blender 4 and 5 Cycles, Principled BSDF, Random Walk (Skin)",
            .source = "blender/cycles 695bae3, kernel/closure/bssrdf.h, bssrdf_setup_radius",
            .relation = std::string(wrenninge) +
                        "; 1 / (sigma_t (1 - g)) = radius scale sqrt(3 (1 - alpha')), alpha' of the classical dipole "
                        "with that base_color and ior (Cycles bisects it to 2e-4)",
            .keys = cyclesKeys("diffuse mean free path of the classical dipole, over subsurface_scale", 0, .9),
            .read = [](const ConventionValues& values,
                       const ConventionContext& context) { return readLegacy(values, context, true); },
            .write = [](const Medium& medium,
                        const ConventionContext& context) { return writeLegacy(medium, context, true); }};
}

Convention cyclesBurley() {
    std::vector<ConventionKey> keys = cyclesKeys("4 pi widths d of the profile, over subsurface_scale", 0, 0);
    std::erase_if(keys, [](const ConventionKey& key) { return key.param.name == "subsurface_anisotropy"; });
    keys.front().meaning = "A, surface albedo: light that leaves again, of the light that has entered";
    return {.id = "cycles_burley",
            .aliases = {},
            .title = "Blender 3 to 5 Cycles, Principled BSDF, Christensen-Burley",
            .source =
                "blender/cycles 695bae3, kernel/closure/bssrdf.h: since 3.0 the width is radius / 4 pi whatever the "
                "colour; Eq. 6 is in the file and not called",
            .relation =
                "A from the reduced albedo by the fits of models/normalized_diffusion (0.011 of exact for eta 1 "
                "to 1.6); d from the free path by Eq. 5, 6 or 8 of [ChristensenBurley2015], as --width says; g "
                "is lost (reduced)",
            .keys = keys,
            .read = readCyclesBurley,
            .write = writeCyclesBurley};
}

Convention chiang() {
    return {.id = "chiang",
            .aliases = {"disney", "hyperion"},
            .title = "Random walk of Chiang, Kutz and Burley (also Cycles 2.8 and 2.9)",
            .source = "[Chiang2016]",
            .relation =
                "colour to albedo by alpha = 1 - exp(-5.09406 A + 2.61188 A^2 - 4.31805 A^3): within 0.0069 of "
                "exact for colours 0.02 to 0.99, at most 0.99885; sigma_t = 1 / (d s), s by Eq. 6 of "
                "[ChristensenBurley2015]; isotropic",
            .keys = {color("A", "reflectance for diffuse light, without surface reflection"),
                     lengths("d", "mm", "mean free path 1/sigma_t over s(A), Eq. 6"), eta()},
            .read = readChiang,
            .write = writeChiang};
}

Convention openPbr() {
    return {.id = "openpbr",
            .aliases = {"open_pbr", "open_pbr_surface"},
            .title = "OpenPBR 1.1",
            .source = "AcademySoftwareFoundation/OpenPBR f8d6d94, index.html, Subsurface",
            .relation = std::string(van_de_hulst) + ", as the specification suggests; sigma_t = 1 / (radius scale)",
            .keys = {color("subsurface_color",
                           "light that leaves again, of the light that has entered; by the "
                           "suggested formula without surface reflection"),
                     {{.name = "subsurface_radius",
                       .unit = "scene units",
                       .min = 0,
                       .max = unlimited,
                       .required = true,
                       .exclusive = true},
                      "mean free path 1/sigma_t of the channel with the longest"},
                     lengths("subsurface_radius_scale", "", "mean free path 1/sigma_t over subsurface_radius"),
                     anisotropy("subsurface_scatter_anisotropy"),
                     eta("specular_ior")},
            .read = readSurface<open_pbr>,
            .write = writeSurface<open_pbr>};
}

Convention standardSurface() {
    return {.id = "standard_surface",
            .aliases = {"materialx", "arnold"},
            .title = "Autodesk Standard Surface (MaterialX, Arnold)",
            .source =
                "AcademySoftwareFoundation/MaterialX, libraries/bxdf/standard_surface.mtlx; "
                "Autodesk/standard-surface, index.html: radii are mean free paths",
            .relation = std::string(van_de_hulst) +
                        "; sigma_t = 1 / (radius scale). Neither document says how the colour becomes an albedo, and "
                        "Arnold's own way is not published: OpenPBR's is used",
            .keys = {color("subsurface_color", "reflectance for diffuse light, without surface reflection"),
                     lengths("subsurface_radius", "", "mean free path 1/sigma_t over subsurface_scale"),
                     number("subsurface_scale", 1, 1e-12, 1e12, "of subsurface_radius", "scene units"),
                     anisotropy("subsurface_anisotropy"), eta("specular_IOR")},
            .read = readSurface<standard_surface>,
            .write = writeSurface<standard_surface>};
}

}  // namespace searchlight::convention
