// The medium itself, and what describes it without a renderer's own fit: physical, albedo, reflectance, pbrt,
// renderman.
#include "base/error.h"
#include "model/convention/convention_rows.h"
#include "model/inversion.h"
#include "model/plane.h"

namespace searchlight::convention {

namespace {

ConventionKey g(std::string name = "g") {
    return number(std::move(name), 0, -.99, .99, "mean cosine of the phase function");
}

ConventionKey coefficient(std::string name, std::string meaning) {
    return {{.name = std::move(name),
             .type = ParamType::channels,
             .unit = "1/mm",
             .min = 0,
             .max = unlimited,
             .required = true},
            std::move(meaning)};
}

// Which g the medium has where a convention allows one per channel.
ConventionKey gPerChannel() {
    ConventionKey key = g();
    key.param.type = ParamType::channels;
    key.param.value = std::vector<double>{0};
    return key;
}

Medium readPhysical(const ConventionValues& values, const ConventionContext&) {
    Medium medium = mediumFrom(values, 0, one(values, "eta"), [&](int c) {
        return Coefficients{at(values, "sigma_a", c), at(values, "sigma_s", c)};
    });
    for (int c = 0; c < Rgb::channels; ++c) medium.g[c] = at(values, "g", c);
    return medium;
}

std::vector<double> listOf(const Rgb& value, const Medium& medium) {
    return medium.channels == 1 ? std::vector{value.r} : std::vector{value.r, value.g, value.b};
}

WrittenConvention writePhysical(const Medium& medium, const ConventionContext&) {
    return {{{"sigma_a", listOf(medium.sigma_a, medium)},
             {"sigma_s", listOf(medium.sigma_s, medium)},
             {"g", listOf(medium.g, medium)},
             {"eta", {medium.eta}}}};
}

Medium readAlbedo(const ConventionValues& values, const ConventionContext&) {
    Medium medium = mediumFrom(values, 0, one(values, "eta"), [&](int c) {
        const double alpha = at(values, "albedo", c), sigma_t = 1 / at(values, "mean_free_path", c);
        return Coefficients{(1 - alpha) * sigma_t, alpha * sigma_t};
    });
    for (int c = 0; c < Rgb::channels; ++c) medium.g[c] = at(values, "g", c);
    return medium;
}

WrittenConvention writeAlbedo(const Medium& medium, const ConventionContext&) {
    const Rgb alpha = medium.sigma_s / medium.sigmaT(), length = Rgb{1, 1, 1} / medium.sigmaT();
    return {{{"albedo", listOf(alpha, medium)},
             {"mean_free_path", listOf(length, medium)},
             {"g", listOf(medium.g, medium)},
             {"eta", {medium.eta}}}};
}

Medium readReflectance(const ConventionValues& values, const ConventionContext& context) {
    InversionTarget target;
    for (int c = 0; c < Rgb::channels; ++c) {
        target.Rdr[c] = at(values, "Rdr", c);
        target.ld_mm[c] = at(values, "ld", c);
    }
    target.eta = one(values, "eta");
    target.g = one(values, "g");
    target.channels = channelsOf(values);
    const Inversion inversion = invert(*context.evaluator, *context.model, context.parameters, target);
    for (int c = 0; c < target.channels; ++c)
        if (!inversion.reached[static_cast<std::size_t>(c)])
            throw usageError(
                fmt::format("Rdr {} cannot be reached by {} at eta {}", target.Rdr[c], context.model->id, target.eta),
                fmt::format("it goes from {:.4g} to {:.4g}", inversion.reachable_min[c], inversion.reachable_max[c]));
    return inversion.medium;
}

WrittenConvention writeReflectance(const Medium& given, const ConventionContext& context) {
    WrittenConvention written;
    const Medium medium = withOneG(given, -.99, .99, written.notes);
    context.evaluator->set(medium, context.parameters);
    const Rgb total = !context.model->measured && context.model->file.diffuse_reflectance.present()
                          ? context.evaluator->diffuseReflectance(medium.alphaPrime())
                          : totalRd(*context.evaluator, *context.model, medium);
    const bool grosjean = context.model->file.grosjean;
    written.values["Rdr"] = perChannel(medium, [&](int c) { return total[c]; });
    written.values["ld"] = perChannel(medium, [&](int c) {
        const double tp = medium.sigmaTp()[c], a = medium.sigma_a[c];
        // Grosjean's D is larger by (sigma_a + sigma_t') / sigma_t'.
        return a > 0 ? std::sqrt((grosjean ? (a + tp) / tp : 1) / (3 * a * tp)) : nan;
    });
    noteMissing(medium, written.values["ld"], "without absorption the diffuse mean free path is infinite",
                written.notes);
    if (!readsMedium(*context.model))
        written.notes.push_back(fmt::format("{} does not read the medium: its Rdr is its own", context.model->id));
    written.values["g"] = {medium.g.r};
    written.values["eta"] = {medium.eta};
    return written;
}

Medium readPbrt(const ConventionValues& values, const ConventionContext& context) {
    const double scale = one(values, "scale") / context.unit_mm;
    return mediumFrom(values, one(values, "g"), one(values, "eta"), [&](int c) {
        return Coefficients{scale * at(values, "sigma_a", c), scale * at(values, "sigma_s", c)};
    });
}

WrittenConvention writePbrt(const Medium& given, const ConventionContext& context) {
    WrittenConvention written;
    const Medium medium = withOneG(given, -1, 1, written.notes);
    written.values = {{"sigma_a", listOf(medium.sigma_a, medium)},
                      {"sigma_s", listOf(medium.sigma_s, medium)},
                      {"scale", {context.unit_mm}},
                      {"g", {medium.g.r}},
                      {"eta", {medium.eta}}};
    return written;
}

Medium readRenderMan(const ConventionValues& values, const ConventionContext& context) {
    const double unit_mm = one(values, "unit_length") * context.unit_mm;
    return mediumFrom(values, 0, one(values, "ior"), [&](int c) {
        const double s = dipoleInverse(at(values, "color", c), one(values, "ior"));
        // ld = 1 / sigma_tr, and sigma_tr = sqrt(3) s sigma_t'.
        const double sigma_tp = 1 / (std::sqrt(3.0) * s * unit_mm * at(values, "radius", c));
        return Coefficients{s * s * sigma_tp, (1 - s * s) * sigma_tp};
    });
}

WrittenConvention writeRenderMan(const Medium& medium, const ConventionContext& context) {
    WrittenConvention written;
    const auto s = [&](int c) { return similarity(medium.alphaPrime()[c], 0); };
    written.values["color"] = perChannel(medium, [&](int c) { return dipoleReflectance(s(c), medium.eta); });
    written.values["radius"] =
        perChannel(medium, [&](int c) { return s(c) > 0 ? 1 / (std::sqrt(3.0) * s(c) * medium.sigmaTp()[c]) : nan; });
    noteMissing(medium, written.values["radius"], "without absorption the diffuse mean free path is infinite",
                written.notes);
    written.values["unit_length"] = {1 / context.unit_mm};
    written.values["ior"] = {medium.eta};
    return written;
}

}  // namespace

Convention physical() {
    return {.id = "physical",
            .aliases = {},
            .title = "The medium",
            .source = "docs/conventions.md",
            .relation = "none",
            .keys = {coefficient("sigma_a", "absorption coefficient"),
                     coefficient("sigma_s", "scattering coefficient, not reduced"), gPerChannel(), eta()},
            .read = readPhysical,
            .write = writePhysical};
}

Convention albedoAndMeanFreePath() {
    return {.id = "albedo",
            .aliases = {"albedo_mfp"},
            .title = "Single-scattering albedo and mean free path",
            .source = "docs/conventions.md",
            .relation = "exact",
            .keys = {color("albedo", "single-scattering albedo, sigma_s / sigma_t"),
                     lengths("mean_free_path", "mm", "mean free path, 1 / sigma_t"), gPerChannel(), eta()},
            .read = readAlbedo,
            .write = writeAlbedo};
}

Convention reflectance() {
    return {.id = "reflectance",
            .aliases = {"Rdr"},
            .title = "Total diffuse reflectance and diffuse mean free path, of one model",
            .source = "[JensenBuhler2002]; docs/conventions.md",
            .relation =
                "the model's own total, inverted by bisection; ld = 1/sigma_tr with the model's diffusion "
                "coefficient",
            .keys = {color("Rdr",
                           "light that leaves again, of the light of a normal beam that has entered, according "
                           "to --model"),
                     lengths("ld", "mm", "diffuse mean free path, 1 / sigma_tr"), g(), eta()},
            .read = readReflectance,
            .write = writeReflectance};
}

Convention pbrt() {
    return {.id = "pbrt",
            .aliases = {},
            .title = "pbrt-v4, material subsurface",
            .source = "mmp/pbrt-v4, src/pbrt/materials.{h,cpp}: coefficients times scale, per scene unit",
            .relation = "exact",
            .keys = {coefficient("sigma_a", "absorption coefficient; times scale, per scene unit"),
                     coefficient("sigma_s", "scattering coefficient, not reduced; times scale, per scene unit"),
                     number("scale", 1, 1e-9, 1e9, "of both coefficients: mm in a scene unit"), g(), eta()},
            .read = readPbrt,
            .write = writePbrt};
}

Convention renderMan() {
    return {
        .id = "renderman",
        .aliases = {"lama"},
        .title = "RenderMan, LamaSSS: albedo and diffuse mean free path",
        .source = "rmanwiki.pixar.com, LamaSubsurface, whose table of materials is (Rdr, ld) of the classical dipole",
        .relation =
            "closed form of the classical dipole's total [JensenBuhler2002], inverted by bisection; sigma_tr "
            "with the classical D",
        .keys = {color("color", "total diffuse reflectance of the classical dipole"),
                 lengths("radius", "mm", "diffuse mean free path, 1 / sigma_tr"),
                 number("unit_length", 1, 1e-9, 1e9, "scene units in a mm"), eta("ior")},
        .read = readRenderMan,
        .write = writeRenderMan};
}

}  // namespace searchlight::convention
