// Figures 11, 14 and 15 of [Frisvad2014]: light from many directions, and variants of the directional dipole.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "job/paper/frisvad2014_pictures.h"
#include "job/paper/lit_pictures.h"

namespace searchlight::frisvad2014 {

namespace {

constexpr double scan_mm = 50;
constexpr double full_difference = 0.5;  // end of the colours, over the reference's mean

struct Variant {
    BodyModel model;
    std::string label, title;
    bool adds_single = false;  // has none of its own
};

void sayOfPictures(PaperPlate& plate, const PaperRun& run) {
    plate.choices.push_back(
        run.object == "statue"
            ? "The hare of this program in place of the scan, which is not free; --object FILE takes the scan."
            : fmt::format("The object is {}.", run.object));
    plate.choices.push_back(
        fmt::format("Its longest side has {} mm, which the text does not give. Exitance, entry and "
                    "noise are as in figures 1 and 8.",
                    prettyNumber(scan_mm)));
}

// A material's row of pictures and one of differences from the walks.
struct Row {
    std::string name;
    double exposure = 0;
    NoisyImage reference;
    double ssim_of_halves = 0;
    std::vector<NoisyImage> pictures;
    std::vector<NoisyError> errors;
};

Row rowOf(const PaperRun& run, const LitBody& body, const Subject& subject, const WalkedBody& walked,
          const std::vector<SphereExitance>& models) {
    Row row{.name = subject.name, .reference = walked.reference.picture};
    row.exposure = suitedExposure(row.reference.mean);
    row.ssim_of_halves = walked.reference.ssimOfHalves(row.exposure, run.threads);
    for (const SphereExitance& model : models) {
        row.pictures.push_back(noisyImage(body, model));
        row.errors.push_back(noisyError(row.pictures.back(), row.reference, row.exposure, run.threads));
    }
    return row;
}

double noiseOf(const Row& row, int threads) {
    return noisyError({row.reference.mean, {}}, row.reference, row.exposure, threads).noise;
}

void addRow(const PaperRun& run, PaperPlate& plate, const Row& row, const std::vector<std::string>& notes) {
    ContactSheet& sheet = *plate.sheet;
    sheet.rows.push_back(row.name);
    for (std::size_t i = 0; i < row.pictures.size(); ++i)
        sheet.cells.push_back(pictureCell(row.pictures[i].mean, row.exposure, noteOf(row.errors[i])));
    sheet.cells.push_back(
        pictureCell(row.reference.mean, row.exposure,
                    fmt::format("noise {}, SSIM {:.3f}", partText(noiseOf(row, run.threads)), row.ssim_of_halves)));
    sheet.rows.emplace_back("difference");
    for (std::size_t i = 0; i < row.pictures.size(); ++i)
        sheet.cells.push_back(differenceCell(row.pictures[i].mean, row.reference.mean, full_difference, notes[i]));
    sheet.cells.emplace_back();
}

void addNumbers(PaperPlate& plate, std::string_view material, const std::vector<Variant>& variants, const Row& row,
                double noise) {
    if (plate.csv.empty()) plate.csv = errorCsvHeader();
    Json json;
    for (std::size_t i = 0; i < variants.size(); ++i) {
        json[variants[i].label] = noisyErrorJson(row.errors[i]);
        plate.csv +=
            errorCsvRow(material, variants[i].label, variants[i].adds_single ? "walked" : "own", row.errors[i]);
    }
    json["reference"] = {{"relative_noise", noise}, {"ssim_of_two_halves", row.ssim_of_halves}};
    plate.values[std::string(material)] = json;
}

std::vector<SphereExitance> exitanceOf(const PaperRun& run, const LitBody& body, const std::vector<Variant>& variants,
                                       const FirstExitance& first) {
    std::vector<SphereExitance> exitance;
    for (const Variant& variant : variants) {
        const SphereExitance model = body.model(variant.model, run.engine, run.backend, run.observer);
        exitance.push_back(variant.adds_single ? model + first.unscattered + first.single
                                               : model + first.unscattered_similar);
    }
    return exitance;
}

ContactSheet sheetOf(std::string title, const std::vector<Variant>& variants) {
    ContactSheet sheet;
    sheet.title = std::move(title);
    sheet.caption = fmt::format(
        "Differences of luminance, model less walks: blue too dark, orange too bright, full at {} of the walks' mean. "
        "RMSE relative to that mean, without the share of noise. Each material has an exposure of its own.",
        partText(full_difference));
    for (const Variant& variant : variants) sheet.columns.push_back(variant.title);
    sheet.columns.emplace_back("Random walks");
    sheet.picture_width = sheet.picture_height = 200;
    return sheet;
}

std::vector<Light> environmentLights(const PaperRun& run) {
    if (!run.environment.empty()) return {EnvironmentLight{.path = run.environment, .occlusion = true}};
    return {DirectionalLight{.direction = {-1, 0.7, 0.2}, .irradiance = {1.5, 1.4, 1.2}, .angle_deg = 30},
            DirectionalLight{.direction = {0.8, 0.4, -0.8}, .irradiance = {0.6, 0.8, 1.1}, .angle_deg = 30}};
}

// Radiance of a picture's part whose surface looks away from the light: of walks with its standard error, and of
// models.
struct BackLit {
    double model = 0, reference = 0, error = 0;

    double difference() const { return model / reference - 1; }
    double standardError() const { return error / reference; }
};

BackLit backLitOf(const LitBody& body, Vec3 light, const SphereExitance& model, const SphereExitance& reference) {
    std::vector<double> weights(body.normals().size(), 0.0);
    for (const CellSample& sample : body.view().samples)
        if (dot(body.normals()[sample.cell], light) < 0)
            weights[sample.cell] += static_cast<double>(sample.coverage) * static_cast<double>(sample.exit);
    BackLit sum;
    double variance = 0;
    for (std::size_t c = 0; c < reference.mean.size(); ++c)
        for (std::size_t cell = 0; cell < reference.mean[c].size(); ++cell) {
            sum.model += weights[cell] * model.mean[c][cell];
            sum.reference += weights[cell] * reference.mean[c][cell];
            variance += std::pow(weights[cell] * reference.standard_error[c][cell], 2);
        }
    sum.error = std::sqrt(variance);
    return sum;
}

}  // namespace

PaperPlate figure11(const PaperRun& run) {
    const std::vector<Variant> variants{{{"quantized_diffusion"}, "qntzd", "Quantized diffusion + single", true},
                                        {{"directional_dipole"}, "ours", "Directional dipole", false}};
    const std::vector<std::string> materials{"marble", "whole_milk", "regular_chocolate_milk",
                                             "white_grapefruit_juice"};
    PaperPlate plate;
    sayOfPictures(plate, run);
    plate.choices.emplace_back(run.environment.empty()
                                   ? "Two discs of light, 30° wide, in place of the light probe, which is not free; "
                                     "--environment FILE takes a picture of all directions."
                                   : "The light is " + run.environment + ", with shadows.");
    plate.choices.emplace_back("Four of the eight materials; the paper shows no reference here.");
    plate.sheet = sheetOf("Frisvad et al. 2014, figure 11: light from many directions", variants);
    std::string found;
    int ahead = 0;
    for (const std::string& material : materials) {
        const Subject subject = subjectNamed(run, material);
        run.observer.log(LogLevel::info, fmt::format("{}, {}", subject.name, run.object));
        LitBodyOptions options = bodyOptions(run, 192, 18);
        options.points = 20'000;  // each has the light of up to 17 or 128 directions
        const LitBody body(sceneOf(run.object, scan_mm, environmentLights(run)), subject.medium, options, run.observer);
        const std::uint64_t walks = run.walks / materials.size();
        const WalkedBody walked = walkBodyTwice(run, body, walks);
        const FirstExitance first = firstExitance(run, body, walks);
        const Row row = rowOf(run, body, subject, walked, exitanceOf(run, body, variants, first));
        addRow(run, plate, row, {"", ""});
        addNumbers(plate, material, variants, row, noiseOf(row, run.threads));
        ahead += row.errors[1].bias < row.errors[0].bias;
        found += fmt::format("{}{} {} against {}", found.empty() ? "" : ", ", material, partText(row.errors[1].bias),
                             partText(row.errors[0].bias));
    }
    plate.statements.push_back(
        {"the directional dipole keeps details that the direction of light brings out, and the others lose.",
         fmt::format("RMSE of it against quantized diffusion with single scattering: {}; ahead in {} of 4", found,
                     ahead),
         ahead == 4});
    return plate;
}

PaperPlate figure14(const PaperRun& run) {
    const auto plane = [](std::string name) { return ParamValues{{"Plane", std::move(name)}}; };
    const std::vector<Variant> variants{
        {{"directional_dipole", plane("modified")}, "modified", "Modified tangent plane", false},
        {{"directional_dipole", plane("planar")}, "planar", "Strictly planar", false},
        {{"directional_dipole", plane("tangent")}, "tangent", "Tangent plane at xi", false}};
    const Vec3 light{-0.7, 0.3, -1};
    PaperPlate plate;
    sayOfPictures(plate, run);
    plate.choices.emplace_back(
        "Parallel light from behind, so that most of what is seen is back-lit: what looks away from the light counts "
        "as "
        "that. The paper shows close-ups of figure 8, and no reference beside them.");
    plate.sheet = sheetOf("Frisvad et al. 2014, figure 14: the plane in which the source is mirrored", variants);
    for (const std::string material : {"marble", "white_grapefruit_juice"}) {
        const Subject subject = subjectNamed(run, material);
        run.observer.log(LogLevel::info, fmt::format("{}, {}", subject.name, run.object));
        const LitBody body(sceneOf(run.object, scan_mm, {DirectionalLight{.direction = light}}), subject.medium,
                           bodyOptions(run, 256, 18), run.observer);
        const WalkedBody walked = walkBodyTwice(run, body, run.walks / 2);
        const FirstExitance first = firstExitance(run, body, run.walks / 2);
        const std::vector<SphereExitance> models = exitanceOf(run, body, variants, first);
        const Row row = rowOf(run, body, subject, walked, models);
        std::vector<double> back;
        std::vector<std::string> notes;
        double noise = 0;
        for (const SphereExitance& model : models) {
            const BackLit lit = backLitOf(body, light, model, walked.exitance);
            back.push_back(lit.difference());
            noise = lit.standardError();
            notes.push_back(fmt::format("back-lit {:+.1f} %", 100 * back.back()));
        }
        addRow(run, plate, row, notes);
        addNumbers(plate, material, variants, row, noiseOf(row, run.threads));
        for (std::size_t i = 0; i < variants.size(); ++i)
            plate.values[material][variants[i].label]["back_lit_difference"] = back[i];
        plate.values[material]["reference"]["back_lit_stderr"] = noise;
        plate.statements.push_back(
            {fmt::format(
                 "the modified tangent plane matters in back-lit regions: the plain one overestimates them. {}.",
                 subject.name),
             fmt::format(
                 "the back-lit part is off by {:+.1f} % with the modified plane and by {:+.1f} % with the plain "
                 "one (± {:.1f}); RMSE of the picture {} and {}",
                 100 * back[0], 100 * back[2], 100 * noise, partText(row.errors[0].bias), partText(row.errors[2].bias)),
             back[2] > back[0] + 3 * noise && std::abs(back[2]) > std::abs(back[0])});
        plate.statements.push_back(
            {fmt::format("the strictly planar variant is close, and slightly overestimates. {}.", subject.name),
             fmt::format("its back-lit part is off by {:+.1f} %, RMSE {}", 100 * back[1], partText(row.errors[1].bias)),
             back[1] > 0 && back[1] > back[0]});
    }
    return plate;
}

PaperPlate figure15(const PaperRun& run) {
    const std::vector<Variant> variants{{{"directional_dipole"}, "ours", "Directional dipole", false},
                                        {{"directional_dipole_reciprocal"}, "reciprocal", "Mean of both ways", false}};
    PaperPlate plate;
    sayOfPictures(plate, run);
    plate.choices.emplace_back(
        "Two discs of light as in figure 11, or --environment. The reciprocal model reads the direction of exit, which "
        "is that of the camera.");
    plate.sheet = sheetOf("Frisvad et al. 2014, figure 15: the reciprocal mean", variants);
    std::vector<double> changes;
    std::string found, errors;
    for (const std::string material : {"white_grapefruit_juice", "marble"}) {
        const Subject subject = subjectNamed(run, material);
        run.observer.log(LogLevel::info, fmt::format("{}, {}", subject.name, run.object));
        LitBodyOptions options = bodyOptions(run, 192, 18);
        options.points = 20'000;
        const LitBody body(sceneOf(run.object, scan_mm, environmentLights(run)), subject.medium, options, run.observer);
        const WalkedBody walked = walkBodyTwice(run, body, run.walks / 2);
        const FirstExitance first = firstExitance(run, body, run.walks / 2);
        const Row row = rowOf(run, body, subject, walked, exitanceOf(run, body, variants, first));
        // Noise of what is added to both is the same in both.
        const double change =
            noisyError({row.pictures[1].mean, {}}, {row.pictures[0].mean, {}}, row.exposure, run.threads).rmse;
        addRow(run, plate, row, {"", fmt::format("{} from the left one", partText(change))});
        addNumbers(plate, material, variants, row, noiseOf(row, run.threads));
        plate.values[material]["change"] = change;
        changes.push_back(change);
        found += fmt::format("{}{} in {}", found.empty() ? "" : ", ", partText(change), material);
        errors += fmt::format("{}{} {} against {}", errors.empty() ? "" : ", ", material, partText(row.errors[1].bias),
                              partText(row.errors[0].bias));
    }
    plate.statements.push_back(
        {"the mean of both ways changes little in highly scattering materials, and more in thinner ones.",
         fmt::format("it changes the picture by {} (RMSE over the mean); RMSE to the walks, mean against one way: {}",
                     found, errors),
         changes[0] > changes[1]});
    return plate;
}

}  // namespace searchlight::frisvad2014
