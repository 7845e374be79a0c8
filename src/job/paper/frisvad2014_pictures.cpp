#include "job/paper/frisvad2014_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>

#include "base/text.h"
#include "job/paper/lit_pictures.h"

namespace searchlight::frisvad2014 {

namespace {

// The models in the paper's order, by the names of its figure 7; ours last.
struct Shown {
    BodyModel model;
    std::string_view label, title;
};
const std::array<Shown, 4>& shownModels() {
    static const std::array<Shown, 4> models{Shown{{"dipole"}, "dipole", "Standard dipole"},
                                             Shown{{"better_dipole"}, "btpole", "Better dipole"},
                                             Shown{{"quantized_diffusion"}, "qntzd", "Quantized diffusion"},
                                             Shown{{"directional_dipole"}, "ours", "Directional dipole"}};
    return models;
}
constexpr std::size_t ours = 3;

constexpr double full_difference = 0.5;  // end of the colours, over the reference's mean
constexpr double full_root = 1.5;        // the same of squared differences, before they are squared

// Of the text marble and white grapefruit juice are known, and that the first four scatter isotropically.
struct Sample {
    std::string_view material;
    bool forward;
};
constexpr std::array<Sample, 8> samples{{{"apple", false},
                                         {"marble", false},
                                         {"skin1", false},
                                         {"whole_milk", false},
                                         {"lowfat_milk", true},
                                         {"lowfat_soy_milk", true},
                                         {"regular_chocolate_milk", true},
                                         {"white_grapefruit_juice", true}}};

// A material's pictures; without[m] lacks the single scattering that with[m] has.
struct Pictures {
    ReferencePicture reference;
    std::array<NoisyImage, 4> with, without;
};

void addPictures(const PaperRun& run, const LitBody& body, std::uint64_t walks, Pictures& to) {
    const ReferencePicture reference = walkBodyTwice(run, body, walks).reference;
    appendRight(to.reference.picture, reference.picture);
    for (std::size_t i = 0; i < 2; ++i) appendRight(to.reference.halves[i], reference.halves[i]);
    const FirstExitance first = firstExitance(run, body, walks);
    for (std::size_t m = 0; m < shownModels().size(); ++m) {
        const SphereExitance model = body.model(shownModels()[m].model, run.engine, run.backend, run.observer);
        const SphereExitance plain = model + (m == ours ? first.unscattered_similar : first.unscattered);
        appendRight(to.without[m], noisyImage(body, plain));
        appendRight(to.with[m], noisyImage(body, m == ours ? plain : plain + first.single));
    }
}

struct Judged {
    double exposure = 0;
    double ssim_of_halves = 0;
    double noise = 0;  // of the reference, relative
    std::array<NoisyError, 4> with, without;
};

Judged judge(const PaperRun& run, const Pictures& pictures) {
    Judged judged;
    const NoisyImage& reference = pictures.reference.picture;
    judged.exposure = suitedExposure(reference.mean);
    judged.ssim_of_halves = pictures.reference.ssimOfHalves(judged.exposure, run.threads);
    judged.noise = noisyError({reference.mean, {}}, reference, judged.exposure, run.threads).noise;
    for (std::size_t m = 0; m < judged.with.size(); ++m) {
        judged.with[m] = noisyError(pictures.with[m], reference, judged.exposure, run.threads);
        judged.without[m] = noisyError(pictures.without[m], reference, judged.exposure, run.threads);
    }
    return judged;
}

// The numbers of one material into the plate: JSON, CSV, and lines for people.
void addNumbers(PaperPlate& plate, std::string_view material, const Judged& judged) {
    if (plate.csv.empty()) plate.csv = errorCsvHeader();
    if (plate.table.empty())
        plate.table = fmt::format("{:<24}{:>24}{:>24}{:>24}{:>24}{:>20}\n", "RMSE / SSIM", "dipole", "btpole", "qntzd",
                                  "ours", "noise / SSIM");
    const auto both = [](const NoisyError& e) { return fmt::format("{} / {:.3f}", partText(e.bias), e.ssim); };
    Json json;
    std::string with = fmt::format("{:<24}", material), without = fmt::format("{:<24}", "  without single");
    for (std::size_t m = 0; m < judged.with.size(); ++m) {
        const std::string label(shownModels()[m].label);
        json[label] = noisyErrorJson(judged.with[m]);
        with += fmt::format("{:>24}", both(judged.with[m]));
        plate.csv += errorCsvRow(material, label, m == ours ? "own" : "walked", judged.with[m]);
        if (m == ours) continue;
        json[label]["without_single_scattering"] = noisyErrorJson(judged.without[m]);
        without += fmt::format("{:>24}", both(judged.without[m]));
        plate.csv += errorCsvRow(material, label, "none", judged.without[m]);
    }
    json["reference"] = {{"relative_noise", judged.noise}, {"ssim_of_two_halves", judged.ssim_of_halves}};
    plate.values[std::string(material)] = json;
    plate.table += with +
                   fmt::format("{:>20}\n", fmt::format("{} / {:.3f}", partText(judged.noise), judged.ssim_of_halves)) +
                   without + "\n";
}

void sayWhatIsCompared(PaperPlate& plate, const PaperRun& run) {
    plate.choices.emplace_back(
        "Walks and models share entry and exit: geometric normals, opaque shadows, and the mean exitance over each "
        "cell of the surface, shown as it would leave if it left like diffuse light. The paper compares radiance.");
    plate.choices.emplace_back(
        "Models other than the directional dipole have the single scattering of walks added; without it they are "
        "\"without single\". Unscattered light is added to all, to the directional dipole attenuated as in Eq. 4.");
    plate.choices.emplace_back(
        "RMSE is relative to the reference's mean; the share of noise (from two halves of the walks) is taken out of "
        "its square. "
        "SSIM is of PU21 luminance and has the noise in it: two references of half the walks have the SSIM of the "
        "last column, which is a bound for what can be told apart.");
    plate.choices.emplace_back(
        "Models are summed hierarchically to 0.5 %, not by direct Monte Carlo: both have one expectation.");
    if (run.object != "statue") plate.choices.push_back(fmt::format("The object is {}.", run.object));
}

void sayOfObject(PaperPlate& plate, const PaperRun& run) {
    if (run.object == "statue")
        plate.choices.emplace_back(
            "The hare of this program in place of the scan, which is not free; --object FILE takes the scan.");
}

std::vector<std::string> sheetColumns(bool single) {
    std::vector<std::string> columns;
    for (std::size_t m = 0; m < shownModels().size(); ++m)
        columns.push_back(std::string(shownModels()[m].title) + (single && m != ours ? " + single" : ""));
    columns.emplace_back("Random walks");
    return columns;
}

// A row of pictures and one of signed differences, or of squares.
void addRows(PaperPlate& plate, const std::string& name, const Pictures& pictures, const Judged& judged, bool shows,
             bool squares) {
    ContactSheet& sheet = *plate.sheet;
    const Image& reference = pictures.reference.picture.mean;
    if (shows) {
        sheet.rows.push_back(name);
        for (std::size_t m = 0; m < pictures.with.size(); ++m)
            sheet.cells.push_back(pictureCell(pictures.with[m].mean, judged.exposure, noteOf(judged.with[m])));
        sheet.cells.push_back(
            pictureCell(reference, judged.exposure,
                        fmt::format("noise {}, SSIM {:.3f}", partText(judged.noise), judged.ssim_of_halves)));
    }
    sheet.rows.push_back(shows ? (squares ? "squared difference" : "difference") : name);
    for (const NoisyImage& image : pictures.with)
        sheet.cells.push_back(squares ? squareCell(image.mean, reference, full_root, "")
                                      : differenceCell(image.mean, reference, full_difference, ""));
    sheet.cells.emplace_back();
}

std::string captionOf(bool squares) {
    return squares ? fmt::format("Squared difference of each channel, full at the square of {} of the walks' mean.",
                                 partText(full_root))
                   : fmt::format(
                         "Difference of luminance, model less walks: blue too dark, orange too bright, full at "
                         "{} of the walks' mean. RMSE without the share of noise.",
                         partText(full_difference));
}

ContactSheet sheetOf(std::string title, bool squares, int width, int height) {
    ContactSheet sheet;
    sheet.title = std::move(title);
    sheet.caption = captionOf(squares);
    sheet.columns = sheetColumns(true);
    sheet.picture_width = width;
    sheet.picture_height = height;
    return sheet;
}

// Simple shapes under one light, from the side, so that a part of them is lit from within alone.
constexpr double shape_mm = 20;
const std::array<std::string, 2> shapes{"sphere", "slab"};
const Vec3 side_light{-1, 0.8, 0.3};

Pictures shapePictures(const PaperRun& run, const Subject& subject) {
    Pictures pictures;
    for (const std::string& shape : shapes) {
        run.observer.log(LogLevel::info, fmt::format("{}, {}", subject.name, shape));
        const LitBody body(sceneOf(shape, shape_mm, {DirectionalLight{.direction = side_light}}), subject.medium,
                           bodyOptions(run, 160, 24), run.observer);
        addPictures(run, body, run.walks / samples.size(), pictures);
    }
    return pictures;
}

void sayOfShapes(PaperPlate& plate) {
    plate.choices.push_back(fmt::format(
        "Shapes: a sphere and an upright slab 1 × 1 × 0.2, {} mm, under parallel light from the side; the paper's "
        "light is large. The text names neither shapes, sizes nor all materials.",
        prettyNumber(shape_mm)));
    plate.choices.emplace_back(
        "Walks are shared among the eight materials: --reference-walks / 8 per channel and shape.");
}

double bestOfOthers(const std::array<NoisyError, 4>& errors) {
    return std::min({errors[0].bias, errors[1].bias, errors[2].bias});
}

// What figures 7 and 9 state, from all materials.
void judgeShapes(PaperPlate& plate, const std::vector<Judged>& all) {
    std::string forward, isotropic, singles;
    int ahead = 0, ssim_ahead = 0;
    bool comparable = true;
    double with = 0, without = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double other = bestOfOthers(all[i].with), own = all[i].with[ours].bias;
        std::string& list = samples[i].forward ? forward : isotropic;
        list += fmt::format("{}{} {} against {}", list.empty() ? "" : ", ", samples[i].material, partText(own),
                            partText(other));
        if (samples[i].forward) {
            ahead += own < other;
            ssim_ahead += std::ranges::all_of(std::array{0, 1, 2}, [&](int m) {
                return all[i].with[ours].ssim > all[i].with[static_cast<std::size_t>(m)].ssim;
            });
            continue;
        }
        comparable = comparable && other < 1.5 * own && own < 1.5 * other;
        for (std::size_t m = 0; m < ours; ++m) {
            with += all[i].with[m].bias;
            without += all[i].without[m].bias;
        }
    }
    plate.statements.push_back(
        {"the directional dipole is significantly closer where the material scatters forward.",
         fmt::format("RMSE of it against the best of the others with single scattering: {}; ahead in {} of 4 by RMSE, "
                     "in {} by SSIM",
                     forward, ahead, ssim_ahead),
         ahead == 4});
    plate.statements.push_back({"on isotropic materials the others are comparable, with walked single scattering.",
                                fmt::format("RMSE as before: {}. Comparable is within a factor of 1.5", isotropic),
                                comparable});
    plate.statements.push_back(
        {"without single scattering the others' error nearly doubles there.",
         fmt::format("their RMSE on the four is {:.2f} times as large on average", without / with),
         without / with > 1.5});
}

PaperPlate shapesPlate(
    const PaperRun& run,
    const std::function<void(const Sample&, const Subject&, const Pictures&, const Judged&, PaperPlate&)>& add) {
    PaperPlate plate;
    sayWhatIsCompared(plate, run);
    sayOfShapes(plate);
    std::vector<Judged> all;
    for (const Sample& sample : samples) {
        const Subject subject = subjectNamed(run, sample.material);
        const Pictures pictures = shapePictures(run, subject);
        all.push_back(judge(run, pictures));
        addNumbers(plate, sample.material, all.back());
        add(sample, subject, pictures, all.back(), plate);
    }
    judgeShapes(plate, all);
    return plate;
}

// The scan, lit from behind and above, in one material.
constexpr double scan_mm = 50;
const Vec3 rim_light{-0.9, 0.8, -0.6};

Pictures scanPictures(const PaperRun& run, const Subject& subject, std::uint64_t walks) {
    run.observer.log(LogLevel::info, fmt::format("{}, {}", subject.name, run.object));
    const LitBody body(sceneOf(run.object, scan_mm, {DirectionalLight{.direction = rim_light}}), subject.medium,
                       bodyOptions(run, 256, 18), run.observer);
    Pictures pictures;
    addPictures(run, body, walks, pictures);
    return pictures;
}

void sayOfScan(PaperPlate& plate, const PaperRun& run) {
    sayWhatIsCompared(plate, run);
    sayOfObject(plate, run);
    plate.choices.push_back(
        fmt::format("Its longest side has {} mm; parallel light from behind and above, from the "
                    "left. The text gives neither.",
                    prettyNumber(scan_mm)));
}

PaperPlate scanPlate(const PaperRun& run, std::string_view material, std::string title,
                     PaperStatement (*said)(const Judged&)) {
    PaperPlate plate;
    sayOfScan(plate, run);
    const Subject subject = subjectNamed(run, material);
    const Pictures pictures = scanPictures(run, subject, run.walks);
    const Judged judged = judge(run, pictures);
    addNumbers(plate, material, judged);
    plate.sheet = sheetOf(std::move(title), false, 200, 200);
    addRows(plate, subject.name, pictures, judged, true, false);
    plate.statements.push_back(said(judged));
    return plate;
}

PaperStatement closest(std::string says, const Judged& judged) {
    const double own = judged.with[ours].bias, other = bestOfOthers(judged.with);
    return {
        std::move(says),
        fmt::format("RMSE {} against {} of the best other one with single scattering", partText(own), partText(other)),
        own < other};
}

}  // namespace

PaperPlate figure7(const PaperRun& run) {
    return shapesPlate(run, [&](const Sample&, const Subject& subject, const Pictures& pictures, const Judged& judged,
                                PaperPlate& plate) {
        if (!plate.sheet)
            plate.sheet = sheetOf("Frisvad et al. 2014, figure 7: simple shapes in eight materials", false, 240, 120);
        addRows(plate, subject.name, pictures, judged, true, false);
    });
}

PaperPlate figure9(const PaperRun& run) {
    Figure rmse, ssim;
    rmse.title = "RMSE, relative";
    ssim.title = "SSIM";
    rmse.y = {"RMSE over the mean", "%"};
    ssim.y = {"SSIM of perceived luminance", ""};
    rmse.x.min = ssim.x.min = -0.6;
    rmse.x.max = ssim.x.max = static_cast<double>(samples.size()) - 0.4;
    for (std::size_t m = 0; m < shownModels().size(); ++m)
        for (const bool single : {true, false}) {
            if (m == ours && !single) continue;
            Series series{.label = std::string(shownModels()[m].title) + (m == ours ? ""
                                                                          : single  ? " + single"
                                                                                    : ", without"),
                          .style = SeriesStyle::points,
                          .color = static_cast<int>(m),
                          .dashed = !single};
            rmse.series.push_back(series);
            ssim.series.push_back(series);
        }
    Series ceiling{.label = "Two references of half the walks", .style = SeriesStyle::points, .color = neutral_color};
    ssim.series.push_back(ceiling);
    PaperPlate plate = shapesPlate(
        run, [&](const Sample&, const Subject& subject, const Pictures&, const Judged& judged, PaperPlate&) {
            const double at = static_cast<double>(rmse.x.names.size());
            rmse.x.names.push_back(subject.name);
            std::size_t next = 0;
            for (std::size_t m = 0; m < shownModels().size(); ++m)
                for (const bool single : {true, false}) {
                    if (m == ours && !single) continue;
                    const NoisyError& error = single ? judged.with[m] : judged.without[m];
                    const double x = at + 0.11 * (static_cast<double>(next) - 3);
                    rmse.series[next].x.push_back(x);
                    rmse.series[next].y.push_back(100 * error.bias);
                    ssim.series[next].x.push_back(x);
                    ssim.series[next].y.push_back(error.ssim);
                    ++next;
                }
            ssim.series.back().x.push_back(at + 0.44);
            ssim.series.back().y.push_back(judged.ssim_of_halves);
        });
    ssim.x.names = rmse.x.names;
    plate.figure.title = "Frisvad et al. 2014, figure 9: errors of the pictures of figure 7";
    plate.figure.caption =
        "RMSE of linear pictures, relative to the walks' mean, without the share of noise. SSIM has the noise in it: "
        "two references of half the walks show how much.";
    plate.figure.panels = {std::move(rmse), std::move(ssim)};
    plate.figure.columns = 1;
    plate.csv.clear();
    return plate;
}

PaperPlate figure1(const PaperRun& run) {
    return scanPlate(run, "white_grapefruit_juice", "Frisvad et al. 2014, figure 1: a scan in white grapefruit juice",
                     [](const Judged& judged) {
                         return closest("the directional dipole is closer to the reference in white grapefruit juice.",
                                        judged);
                     });
}

PaperPlate figure8(const PaperRun& run) {
    return scanPlate(run, "marble", "Frisvad et al. 2014, figure 8: the scan in marble", [](const Judged& judged) {
        return closest("in marble the others work well, and the directional dipole is still closer.", judged);
    });
}

PaperPlate figure10(const PaperRun& run) {
    PaperPlate plate;
    sayOfScan(plate, run);
    plate.sheet = sheetOf("Frisvad et al. 2014, figure 10: squared differences of figures 1 and 8", true, 200, 200);
    plate.sheet->columns.pop_back();
    for (const std::string_view material : {"white_grapefruit_juice", "marble"}) {
        const Subject subject = subjectNamed(run, material);
        const Pictures pictures = scanPictures(run, subject, run.walks / 2);
        const Judged judged = judge(run, pictures);
        addNumbers(plate, material, judged);
        addRows(plate, subject.name, pictures, judged, false, true);
        plate.sheet->cells.pop_back();
        for (std::size_t m = 0; m < judged.with.size(); ++m)
            plate.sheet->cells[plate.sheet->cells.size() - 4 + m].note = noteOf(judged.with[m]);
        plate.statements.push_back(
            closest(fmt::format("squared differences are smallest for the directional dipole: {}.", material), judged));
    }
    return plate;
}

}  // namespace searchlight::frisvad2014
