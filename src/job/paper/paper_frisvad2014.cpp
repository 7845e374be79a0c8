// [Frisvad2014]: directional dipole model for subsurface scattering. Figures 4, 5, 6, 12 and 13 are about planar
// half-spaces with matched indices, isotropic scattering and sigma_s = 1/cm.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/text.h"
#include "job/paper/frisvad2014_pictures.h"
#include "job/paper/paper.h"
#include "job/plot/plane_views.h"

namespace searchlight {

namespace {

constexpr double sigma_s = 0.1;  // 1/mm
constexpr int strip_cells = 96;
constexpr double strip_half_width = 0.5;  // mm, a twentieth of the mean free path
constexpr std::string_view ours = "directional_dipole";

Subject mediumOf(double sigma_a, double eta = 1) {
    Subject subject;
    subject.name = fmt::format("sigma_a {} / cm", prettyNumber(10 * sigma_a));
    subject.medium = makeMedium({sigma_a}, {sigma_s}, {0}, eta);
    return subject;
}

bool isShipped(std::string_view id) {
    return std::ranges::any_of(shippedModels(), [&](const Model& model) { return model.id == id; });
}

// The paper's models, in its order, as far as this build has them.
std::vector<std::string> paperModels(PaperPlate& plate) {
    std::vector<std::string> ids{"dipole", "better_dipole"};
    if (isShipped("quantized_diffusion"))
        ids.emplace_back("quantized_diffusion");
    else
        plate.choices.emplace_back("Quantized diffusion is not among the models here and is left out.");
    ids.emplace_back(ours);
    return ids;
}

ReferenceRun walkStrip(const PaperRun& run, const Subject& subject, double angle_deg, const Strip& strip) {
    ReferenceOptions options;
    options.walks = run.walks;
    options.seed = run.seed;
    options.threads = run.threads;
    options.angle_deg = angle_deg;
    options.edges_mm = {0, strip.edges_mm.back()};
    options.strip_edges_mm = strip.edges_mm;
    options.strip_half_width_mm = strip.half_width_mm;
    options.estimator = Estimator::analogue;
    return runReference(subject.medium, options, run.observer);
}

std::vector<Rgb> sum(std::vector<Rgb> a, const std::vector<Rgb>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = a[i] + b[i];
    return a;
}

// The strip of one medium under one beam: the models, with the walks' own single scattering added to those that have
// none, beside the walks.
StripPanel stripPanel(const PaperRun& run, const Subject& subject, double angle_deg, const Strip& strip,
                      const std::vector<std::string>& ids, bool add_single) {
    StripPanel panel{.edges_mm = strip.edges_mm, .half_width_mm = strip.half_width_mm};
    const ReferenceRun walked = walkStrip(run, subject, angle_deg, strip);
    const std::vector<Rgb> single = tallyValues(walked, &HalfSpaceResult::single, &HalfSpaceTally::strip);
    for (LoadedModel& model : loadModels(ids, run.backend, subject, run.engine)) {
        StripCurve curve{modelLabel(model), incidentCellMeans(model, angle_deg, strip.cells())};
        if (add_single && !model.model.file.single_scattering) {
            curve.means = sum(std::move(curve.means), single);
            curve.label += " + single";
        }
        panel.models.push_back(std::move(curve));
    }
    panel.reference.push_back(stripReference(walked));
    return panel;
}

// Of the flux within the strip beyond `from`, how much more leaves on the side that the beam leans to: ln(right/left).
double lean(const StripPanel& panel, const std::vector<Rgb>& means, double from_mm) {
    double right = 0, left = 0;
    for (std::size_t i = 0; i < means.size(); ++i) {
        const double x = 0.5 * (panel.edges_mm[i] + panel.edges_mm[i + 1]);
        const double flux = means[i].r * (panel.edges_mm[i + 1] - panel.edges_mm[i]);
        if (std::abs(x) >= from_mm) (x > 0 ? right : left) += flux;
    }
    return std::log(right / left);
}

double leanError(const StripPanel& panel, double from_mm) {
    const StripReference& reference = panel.reference[0];
    double flux[2] = {0, 0}, variance[2] = {0, 0};
    for (std::size_t i = 0; i < reference.Rd.size(); ++i) {
        const double x = 0.5 * (panel.edges_mm[i] + panel.edges_mm[i + 1]);
        const double width = panel.edges_mm[i + 1] - panel.edges_mm[i];
        if (std::abs(x) < from_mm) continue;
        flux[x > 0] += reference.Rd[i].r * width;
        variance[x > 0] += std::pow(reference.standard_error[i].r * width, 2);
    }
    return std::sqrt(variance[0] / (flux[0] * flux[0]) + variance[1] / (flux[1] * flux[1]));
}

double peakOf(const StripPanel& panel, const std::vector<Rgb>& means) {
    return stripShape(means, panel.edges_mm, PlotChannel::red).peak;
}

// In order of the models; and of the walks, last.
Json panelJson(const StripPanel& panel, double from_mm) {
    Json json = Json::array();
    const auto add = [&](const std::string& label, const std::vector<Rgb>& means) -> Json& {
        const StripShape shape = stripShape(means, panel.edges_mm, PlotChannel::red);
        json.push_back({{"label", label},
                        {"peak", shape.peak},
                        {"peak_x_mm", shape.peak_x_mm},
                        {"mean_x_mm", shape.mean_x_mm},
                        {"lean", lean(panel, means, from_mm)}});
        return json.back();
    };
    for (const StripCurve& curve : panel.models) add(curve.label, curve.means);
    add(panel.reference[0].label, panel.reference[0].Rd)["lean_stderr"] = leanError(panel, from_mm);
    return json;
}

const StripCurve& curveOf(const StripPanel& panel, std::string_view title) {
    return *std::ranges::find_if(panel.models, [&](const StripCurve& c) { return c.label.starts_with(title); });
}

constexpr std::string_view our_title = "Directional dipole";

void sayPathTracedSingle(PaperPlate& plate) {
    plate.choices.emplace_back(
        "\"+ single\" is the single scattering of the same random walks that give the reference, as in the paper, "
        "where it "
        "was path traced.");
}

PaperPlate figure4(const PaperRun& run) {
    PaperPlate plate;
    const std::vector<std::string> ids = paperModels(plate);
    plate.choices.emplace_back("Extents of the abscissa: 6, 4 and 2 cm for sigma_a 0.01, 0.1 and 1 / cm.");
    sayPathTracedSingle(plate);
    struct Case {
        double sigma_a, extent;
    };
    std::vector<StripPanel> panels;
    bool over = true, tail_small = true;
    std::string excesses, tails;
    for (const auto [sigma_a, extent] : {Case{0.001, 60}, Case{0.01, 40}, Case{0.1, 20}}) {
        const Subject subject = mediumOf(sigma_a);
        const Strip strip = stripOf(subject.medium, extent, strip_half_width, strip_cells);
        StripPanel panel = stripPanel(run, subject, 0, strip, ids, true);
        panel.heading = "σa = " + prettyNumber(10 * sigma_a) + " / cm";

        std::vector<LoadedModel> model = loadModels({std::string(ours)}, run.backend, subject, run.engine);
        const double total = planeMoments(*model[0].evaluator, model[0].model, subject.medium, 0).total.r;
        ReferenceOptions options;
        options.walks = run.walks;
        options.seed = run.seed;
        options.threads = run.threads;
        options.edges_mm = {0, 1};
        const Estimate walked = runReference(subject.medium, options, run.observer).channels[0]->all.total;
        over = over && total > walked.mean + 4 * walked.standard_error;
        excesses += fmt::format("{}{:.2f} against {:.4f} ± {:.4f} at {} / cm", excesses.empty() ? "" : ", ", total,
                                walked.mean, walked.standard_error, prettyNumber(10 * sigma_a));
        // The tail: beyond half the extent, against the peak.
        const StripCurve& curve = curveOf(panel, our_title);
        const double peak = peakOf(panel, panel.reference[0].Rd);
        double worst = 0;
        for (std::size_t i = 0; i < curve.means.size(); ++i) {
            const double x = 0.5 * (panel.edges_mm[i] + panel.edges_mm[i + 1]);
            if (std::abs(x) >= 0.5 * extent)
                worst = std::max(worst, std::abs(curve.means[i].r - panel.reference[0].Rd[i].r) / peak);
        }
        constexpr double very_small = 0.01;
        if (sigma_a == 0.1) tail_small = worst < very_small;
        tails += fmt::format("{}{:.2f} %", tails.empty() ? "" : ", ", 100 * worst);
        plate.values[fmt::format("sigma_a_{}_per_cm", prettyNumber(10 * sigma_a))] = {
            {"total_directional_dipole", total},
            {"total_reference", {{"mean", walked.mean}, {"stderr", walked.standard_error}}},
            {"curves", panelJson(panel, 0)}};
        panels.push_back(std::move(panel));
    }
    plate.statements.push_back(
        {"the directional dipole gives curves similar to those of the other models, with a slight overestimation.",
         "it lies above the reference in total, by more than slightly: " + excesses, over});
    plate.statements.push_back(
        {"the deviation in the tail for highly absorbing media (1 / cm) is very small in its scale.",
         "beyond half the extent the largest deviation is, relative to the peak of the reference: " + tails,
         tail_small});
    plate.figure = obliqueFigure(
        panels,
        {.title = "Frisvad et al. 2014, figure 4: normal incidence, η = 1, σs = 1 / cm", .shared_ordinate = false});
    return plate;
}

constexpr double lean_from = 2;        // mm: beyond the peak, which is a cell or two wide
constexpr double mean_free_path = 10;  // mm, but for absorption

PaperPlate figure5(const PaperRun& run) {
    PaperPlate plate;
    const std::vector<std::string> ids = paperModels(plate);
    plate.choices.emplace_back("Angles of incidence: 30°, 45° and 60°; the text names 60° alone.");
    plate.choices.emplace_back("Extent of the abscissa: 4 cm; the pictures of figure 6 end at 2 cm.");
    sayPathTracedSingle(plate);
    const Subject subject = mediumOf(0.001);
    const Strip strip = stripOf(subject.medium, 40, strip_half_width, strip_cells);
    std::vector<StripPanel> panels;
    for (const double angle_deg : {30.0, 45.0, 60.0}) {
        panels.push_back(stripPanel(run, subject, angle_deg, strip, ids, true));
        panels.back().heading = prettyNumber(angle_deg) + "°";
        plate.values[fmt::format("angle_{}_deg", prettyNumber(angle_deg))] = panelJson(panels.back(), lean_from);
    }
    const StripPanel& last = panels.back();
    const double truth = lean(last, last.reference[0].Rd, lean_from), error = leanError(last, lean_from);
    const double our_lean = lean(last, curveOf(last, our_title).means, lean_from);
    double others = 0;
    std::string list;
    for (const StripCurve& curve : last.models) {
        const double value = lean(last, curve.means, lean_from);
        if (!curve.label.starts_with(our_title)) others = std::max(others, value);
        list += fmt::format("{}{} {:.2f}", list.empty() ? "" : ", ", curve.label, value);
    }
    plate.statements.push_back(
        {"only the directional dipole captures the characteristic distortion of the curve, especially at 60°.",
         fmt::format("ln(flux on the leaning side / flux on the other) within the strip beyond 2 mm at 60°: reference "
                     "{:.2f} ± {:.2f}; {}",
                     truth, error, list),
         our_lean > others + 4 * error && std::abs(our_lean - truth) < std::abs(others - truth)});
    double far = 0;
    for (const StripCurve& curve : last.models)
        if (!curve.label.starts_with(our_title)) far = std::max(far, lean(last, curve.means, mean_free_path));
    const double far_truth = lean(last, last.reference[0].Rd, mean_free_path);
    plate.statements.push_back(
        {"single scattering has minor directional effects.",
         fmt::format(
             "with it, the symmetric models reach {:.2f} of the reference's {:.2f} at 60°; beyond one mean free path, "
             "1 cm, {:.2f} of {:.2f}. It counts as minor here when it is below half in both",
             others, truth, far, far_truth),
         others < 0.5 * truth && far < 0.5 * far_truth});
    plate.figure = obliqueFigure(
        panels, {.title = "Frisvad et al. 2014, figure 5: oblique incidence, η = 1, σs = 1 / cm, σa = 0.01 / cm"});
    return plate;
}

// Change of a picture against another, relative to what it holds.
double change(const std::vector<Rgb>& from, const std::vector<Rgb>& to) {
    double difference = 0, whole = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        difference += std::abs(to[i].r - from[i].r);
        whole += from[i].r;
    }
    return difference / whole;
}

constexpr double picture_extent = 20;  // mm
constexpr int picture_cells = 64;

ReferenceRun walkPicture(const PaperRun& run, const Subject& subject, double angle_deg) {
    ReferenceOptions options;
    options.walks = run.walks;
    options.seed = run.seed;
    options.threads = run.threads;
    options.angle_deg = angle_deg;
    options.edges_mm = {0, picture_extent};
    options.grid = picture_cells;
    options.grid_extent_mm = picture_extent;
    options.estimator = Estimator::analogue;
    return runReference(subject.medium, options, run.observer);
}

PaperPlate figure6(const PaperRun& run) {
    PaperPlate plate;
    plate.choices.emplace_back("Angles of incidence: 0°, 30°, 45° and 60°; the text names 60° alone.");
    sayPathTracedSingle(plate);
    std::string other = "quantized_diffusion";
    if (!isShipped(other)) {
        other = "better_dipole";
        plate.choices.emplace_back(
            "Quantized diffusion is not among the models here: the first row is the better dipole.");
    }
    const Subject subject = mediumOf(0.001);
    std::vector<LoadedModel> models = loadModels({other, std::string(ours)}, run.backend, subject, run.engine);
    std::array<std::vector<SlicePanel>, 3> rows;
    double lowest = INFINITY;
    for (const double angle_deg : {0.0, 30.0, 45.0, 60.0}) {
        const ReferenceRun walked = walkPicture(run, subject, angle_deg);
        std::vector<SlicePanel> column = slicePanels(models, angle_deg, picture_extent, picture_cells, &walked);
        for (const Rgb& value : column[1].unclamped) lowest = std::min(lowest, value.r);
        column[0].means =
            sum(std::move(column[0].means), tallyValues(walked, &HalfSpaceResult::single, &HalfSpaceTally::grid));
        column[0].heading += " + single";
        column[2].heading = "Monte Carlo";
        for (std::size_t row = 0; row < 3; ++row) {
            column[row].heading += fmt::format(", {}°", prettyNumber(angle_deg));
            rows[row].push_back(std::move(column[row]));
        }
    }
    const double others = change(rows[0].front().means, rows[0].back().means);
    const double our_change = change(rows[1].front().means, rows[1].back().means);
    const double truth = change(rows[2].front().means, rows[2].back().means);
    plate.values = {
        {"change_0_to_60_deg", {{other + "+single", others}, {std::string(ours), our_change}, {"reference", truth}}},
        {"lowest_unclamped_per_mm2", lowest}};
    plate.statements.push_back(
        {"the directional dipole varies significantly with the angle; the other model varies with its single "
         "scattering "
         "alone.",
         fmt::format("between 0° and 60° the picture changes by {:.0f} % (directional dipole), {:.0f} % ({} + single), "
                     "{:.0f} % (reference)",
                     100 * our_change, 100 * others, other, 100 * truth),
         our_change > 1.5 * others});
    plate.statements.push_back({"no configuration of figure 6 has a clamped region.",
                                fmt::format("the lowest mean over a cell is {:.1e} / mm²", lowest), lowest >= 0});
    std::vector<SlicePanel> panels;
    for (std::vector<SlicePanel>& row : rows)
        for (SlicePanel& panel : row) panels.push_back(std::move(panel));
    plate.figure = sliceFigure(panels, {.title = "Frisvad et al. 2014, figure 6: σs = 1 / cm, σa = 0.01 / cm, η = 1",
                                        .extent_mm = picture_extent,
                                        .columns = 4});
    return plate;
}

PaperPlate figure12(const PaperRun& run) {
    PaperPlate plate;
    const std::vector<std::string> ids = paperModels(plate);
    plate.choices.emplace_back("The medium is that of figure 5: σa = 0.01 / cm.");
    plate.choices.emplace_back("Extent of the abscissa: 4 cm.");
    const Subject subject = mediumOf(0.001);
    const Strip strip = stripOf(subject.medium, 40, strip_half_width, strip_cells);
    StripPanel panel = stripPanel(run, subject, 45, strip, ids, false);
    const double truth = peakOf(panel, panel.reference[0].Rd);
    const auto peakRatio = [&](std::string_view title) { return peakOf(panel, curveOf(panel, title).means) / truth; };
    plate.values["curves"] = panelJson(panel, lean_from);
    plate.statements.push_back(
        {"without single scattering the standard and the better dipole miss a sharp peak at the "
         "origin.",
         fmt::format("their peaks reach {:.3f} and {:.3f} of the reference's, averaged over a cell of "
                     "{} by {} mm; that of the directional dipole {:.2f}",
                     peakRatio("Classical dipole"), peakRatio("Better dipole"),
                     prettyNumber(strip.edges_mm[strip_cells / 2 + 1], 2), prettyNumber(2 * strip.half_width_mm, 2),
                     peakRatio(our_title)),
         peakRatio("Classical dipole") < 0.2 && peakRatio("Better dipole") < 0.2});
    if (isShipped("quantized_diffusion")) {
        const std::string title = loadModel("quantized_diffusion").file.title;
        const double shift = lean(panel, curveOf(panel, title).means, lean_from);
        plate.statements.push_back(
            {"quantized diffusion keeps the sharp peak, but does not shift with the angle.",
             fmt::format("its peak is {:.2f} of the reference's, ln(leaning side / other) {:.1e}", peakRatio(title),
                         shift),
             peakRatio(title) > 2 * peakRatio("Classical dipole") && std::abs(shift) < 1e-9});
    }
    plate.figure =
        obliqueFigure({&panel, 1}, {.title = "Frisvad et al. 2014, figure 12: 45°, single scattering left out"});
    return plate;
}

// The smallest whole angle at which the model is negative on the plane, on a disc of eight mean free paths; 90: none.
int firstNegativeAngle(LoadedModel& model) {
    std::vector<Vec3> points;
    const double mfp = 1 / model.medium.sigmaTp().r;
    for (double r = 0.02 * mfp; r < 8 * mfp; r *= 1.15)
        for (int k = 0; k <= 24; ++k) {
            const double phi = std::numbers::pi * k / 24;
            points.push_back({r * std::cos(phi), r * std::sin(phi), 0});
        }
    for (int angle = 0; angle < 90; ++angle)
        for (const Rgb& value : planeRd(*model.evaluator, model.model, model.medium, angle, points))
            if (value.r < 0) return angle;
    return 90;
}

PaperPlate figure13(const PaperRun& run) {
    PaperPlate plate;
    plate.choices.emplace_back(
        "Absorption and angles of the pictures, which the text leaves to the figure: σa = 0.01, 0.1 and 1 / cm, each "
        "10° "
        "beyond the angle at which negative values begin, but 85° at most.");
    std::vector<SlicePanel> panels;
    std::vector<int> first, first_refractive;
    bool all_outlined = true;
    for (const double sigma_a : {0.001, 0.01, 0.1}) {
        const auto firstAt = [&](double eta) {
            const Subject subject = mediumOf(sigma_a, eta);
            std::vector<LoadedModel> model =
                loadModels({std::string(ours) + ":ClampNegative=false"}, run.backend, subject, run.engine);
            return firstNegativeAngle(model[0]);
        };
        first.push_back(firstAt(1));
        first_refractive.push_back(firstAt(1.3));
        const double angle_deg = std::min(first.back() + 10, 85);
        const Subject subject = mediumOf(sigma_a);
        std::vector<LoadedModel> model = loadModels({std::string(ours)}, run.backend, subject, run.engine);
        const ReferenceRun walked = walkPicture(run, subject, angle_deg);
        std::vector<SlicePanel> pair = slicePanels(model, angle_deg, picture_extent, picture_cells, &walked);
        double negative = 0;
        for (const Rgb& value : pair[0].unclamped) negative += value.r < 0;
        negative /= static_cast<double>(pair[0].unclamped.size());
        all_outlined = all_outlined && negative > 0;
        const std::string place = fmt::format("σa {} / cm, {}°", prettyNumber(10 * sigma_a), prettyNumber(angle_deg));
        plate.values["pictures"].push_back({{"sigma_a_per_cm", 10 * sigma_a},
                                            {"angle_deg", angle_deg},
                                            {"clamped_part_of_the_picture", negative},
                                            {"first_negative_angle_deg", first.back()},
                                            {"first_negative_angle_deg_eta_1.3", first_refractive.back()}});
        pair[0].heading = "Directional dipole, " + place;
        pair[1].heading = "Monte Carlo, " + place;
        for (SlicePanel& panel : pair) panels.push_back(std::move(panel));
    }
    // Models above, walks below.
    std::vector<SlicePanel> ordered;
    for (const std::size_t i : {0, 2, 4, 1, 3, 5}) ordered.push_back(std::move(panels[i]));
    plate.statements.push_back(
        {"negative values appear at grazing incidence with matched indices.",
         fmt::format("they begin at {}°, {}° and {}° for σa = 0.01, 0.1 and 1 / cm", first[0], first[1], first[2]),
         all_outlined && first[0] > 60 && first[0] < 90});
    plate.statements.push_back({"for highly absorbing media they appear at even smaller angles.",
                                "see above: the angle falls with absorption",
                                first[2] < first[1] && first[1] < first[0]});
    plate.statements.push_back(
        {"they rarely occur when the medium is the denser one.",
         fmt::format("at η = 1.3 they begin at {}, {} and {} (90: nowhere)", first_refractive[0], first_refractive[1],
                     first_refractive[2]),
         first_refractive[0] > first[0] && first_refractive[1] > first[1] && first_refractive[2] > first[2]});
    plate.figure =
        sliceFigure(ordered, {.title = "Frisvad et al. 2014, figure 13: where the directional dipole is clamped",
                              .extent_mm = picture_extent,
                              .columns = 3,
                              .decades = 6});
    return plate;
}

}  // namespace

Paper frisvad2014Paper() {
    return {.id = "frisvad2014",
            .citation =
                "Frisvad, Hachisuka, Kjeldsen: Directional dipole model for subsurface scattering. ACM Transactions "
                "on Graphics 34(1), 2014",
            .figures = {
                {"1", "a scan in white grapefruit juice, four models", frisvad2014::figure1},
                {"4", "diffuse reflectance at normal incidence, three absorptions", figure4},
                {"5", "diffuse reflectance along the plane of incidence, three angles", figure5},
                {"6", "R_d over the surface in false colour, four angles", figure6},
                {"7", "simple shapes in eight materials, four models", frisvad2014::figure7},
                {"8", "the scan of figure 1 in marble", frisvad2014::figure8},
                {"9", "RMSE and SSIM of the pictures of figure 7", frisvad2014::figure9},
                {"10", "squared differences of figures 1 and 8", frisvad2014::figure10},
                {"11", "light from many directions, four materials", frisvad2014::figure11},
                {"12", "the curves at 45 degrees without single scattering", figure12},
                {"13", "where the directional dipole is negative, and clamped", figure13},
                {"14", "the plane in which the source is mirrored", frisvad2014::figure14},
                {"15", "the reciprocal mean", frisvad2014::figure15},
            }};
}

}  // namespace searchlight
