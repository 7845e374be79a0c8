// [Chang2007], Figures 4.2 to 4.4, 4.6 and 4.7: pictures by texture space importance sampling.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "geometry/atlas/atlas_cache.h"
#include "job/paper/chang2007.h"
#include "job/paper/paper_studio.h"
#include "job/unit_progress.h"

namespace searchlight {

namespace {

constexpr double light_azimuth_deg = 39;  // of PaperStudio's lamp

struct Named {
    const char* id;
    const char* title;
};
constexpr std::array<Named, 4> materials{
    {{"skim_milk", "Skim milk"}, {"marble", "Marble"}, {"skin1", "Skin1"}, {"cream", "Cream"}}};

struct Way {
    const char* title;
    const char* technique;
    ParamValues options;
};

PaperPlate figure42(const PaperRun& run) {
    PaperPlate plate;
    chooseScene(plate, run);
    plate.choices.emplace_back("marble, 10 mm; the camera turns away from the lamp, as seen from the object");
    plate.choices.emplace_back("1,600 samples each; every column has the exposure that suits its truth");
    const std::vector<Way> ways{
        {"Texture space", "texture-space", samplesOf(1600)},
        {"From the light (LTSM)", "tsm", {{"local_samples", 1601.0}}},
        {"Local (LSS): what the eye sees", "local", {{"samples", 1600.0}, {"global_points", 0.0}}},
        {"Local, and points for what it does not see", "local", samplesOf(1600)}};
    const std::array<double, 3> turns{0, 90, 170};
    UnitProgress progress(run.observer, "pictures", turns.size() * (ways.size() + 1));
    PaperStudio studio(run, progress);
    studio.scene.material.id = "marble";
    ContactSheet sheet = paperSheet(studio, "Three techniques from three sides, Fig. 4.2",
                                    "Below each picture its relative RMSE against the sum over all points.");
    sheet.column_title = "Camera, as turned away from the lamp";
    for (const double turn : turns) sheet.columns.push_back(fmt::format("{:.0f}°", turn));
    for (const Way& way : ways) sheet.rows.emplace_back(way.title);
    sheet.rows.emplace_back("Sum over points");
    sheet.cells.resize(sheet.rows.size() * turns.size());
    std::vector<std::array<double, 3>> errors(ways.size());
    for (std::size_t t = 0; t < turns.size(); ++t) {
        studio.scene.camera.azimuth_deg = light_azimuth_deg + turns[t];
        const PaperPicture truth = studio.truth();
        progress.finish();
        for (std::size_t w = 0; w < ways.size(); ++w) {
            const PaperPicture picture = studio.take(ways[w].technique, ways[w].options);
            errors[w][t] = errorOf(picture, truth);
            sheet.cells[w * turns.size() + t] = shownCell(picture.image, truth.exposure, percentOf(errors[w][t]));
            plate.values[ways[w].title].push_back(
                {{"turn_deg", turns[t]}, {"relative_rmse", errors[w][t]}, {"sum_cpu_ms", picture.sum_cpu_ms}});
            progress.finish();
        }
        sheet.cells[ways.size() * turns.size() + t] = shownCell(truth.image, truth.exposure);
    }
    plate.sheet = std::move(sheet);
    const auto list = [&](std::size_t w) {
        return fmt::format("{}, {} and {}", percentOf(errors[w][0]), percentOf(errors[w][1]), percentOf(errors[w][2]));
    };
    plate.statements.push_back(
        {.says = "the view from the light gives local and global effects, but errs at the borders of its map",
         .found = fmt::format("errors at 0°, 90° and 170°: {}", list(1)),
         .holds = errors[1][0] > 2 * errors[0][0]});
    plate.statements.push_back(
        {.says = "what is lit from the other side is caught poorly by samples of what the eye sees",
         .found = fmt::format("errors at 0°, 90° and 170°: {} by them, {} in texture space; with points for what is "
                              "not seen {}",
                              list(2), list(0), list(3)),
         .holds = errors[2][2] > 5 * errors[0][2] && errors[2][2] > 3 * errors[2][0]});
    return plate;
}

// Figures 4.3 and 4.4: the object of that size beside the hierarchical sum.
PaperPlate besideHierarchical(const PaperRun& run, double size_mm, const std::string& number) {
    PaperPlate plate;
    chooseScene(plate, run);
    if (size_mm != 10) chooseSizes(plate);
    plate.choices.emplace_back("the thesis' materials and numbers of samples here are not readable in its text");
    const std::array<double, 2> counts{1600, 14400};
    UnitProgress progress(run.observer, "pictures", materials.size() * 3);
    PaperStudio studio(run, progress);
    setSize(studio, size_mm);
    ContactSheet sheet = paperSheet(
        studio, fmt::format("Beside the hierarchical sum, {:.0f} mm, Fig. {}", size_mm, number),
        "Differences end at a tenth of the picture's mean. Below: relative RMSE, and mean FLIP, at which 0.05 is "
        "hard to see.");
    for (const Named& material : materials) sheet.columns.emplace_back(material.title);
    sheet.rows = {"1,600 samples", "its difference", "14,400 samples", "its difference", "Hierarchical, all points"};
    sheet.cells.resize(sheet.rows.size() * sheet.columns.size());
    std::array<double, 2> worst_flip{}, worst{};
    for (std::size_t m = 0; m < materials.size(); ++m) {
        studio.scene.material.id = materials[m].id;
        const PaperPicture truth = studio.truth();
        progress.finish();
        for (std::size_t k = 0; k < counts.size(); ++k) {
            const PaperPicture picture = studio.take("texture-space", samplesOf(counts[k]));
            const ImageError error = compareImages(picture.image, truth.image, {.exposure = truth.exposure});
            worst_flip[k] = std::max(worst_flip[k], error.flip);
            worst[k] = std::max(worst[k], error.relative_rmse);
            sheet.cells[2 * k * materials.size() + m] =
                shownCell(picture.image, truth.exposure,
                          fmt::format("{}, FLIP {:.3f}", percentOf(error.relative_rmse), error.flip));
            sheet.cells[(2 * k + 1) * materials.size() + m] = differenceCell(picture.image, truth.image, 0.1, "");
            plate.values[materials[m].id][fmt::format("{:.0f}_samples", counts[k])] = {
                {"relative_rmse", error.relative_rmse}, {"ssim", error.ssim}, {"flip", error.flip}};
            progress.finish();
        }
        sheet.cells[4 * materials.size() + m] = shownCell(truth.image, truth.exposure);
    }
    plate.sheet = std::move(sheet);
    // [Andersson2020] gives no threshold; at 0.05 differences of a flip between two pictures are hard to find.
    constexpr double hard_to_see = 0.05;
    plate.statements.push_back(
        {.says = "there is almost no difference from the hierarchical method",
         .found = fmt::format("largest mean FLIP over the materials {:.3f} with 1,600 samples, {:.3f} with 14,400; "
                              "largest error {} and {}",
                              worst_flip[0], worst_flip[1], percentOf(worst[0]), percentOf(worst[1])),
         .holds = worst_flip[0] < hard_to_see});
    return plate;
}

PaperPlate figure43(const PaperRun& run) { return besideHierarchical(run, 10, "4.3"); }
PaperPlate figure44(const PaperRun& run) { return besideHierarchical(run, 40, "4.4"); }

PaperPlate figure46(const PaperRun& run) {
    PaperPlate plate;
    chooseScene(plate, run);
    plate.choices.emplace_back(
        "skim milk, 10 mm; 6,400 samples as well, so that the texels are seen and not the noise");
    plate.choices.emplace_back("32 x 32 texels in place of the thesis' 16 x 16, which have no room for charts of ours");
    const std::array<double, 5> sides{32, 64, 128, 256, 512};
    const std::array<double, 4> shown{32, 64, 128, 256};
    UnitProgress progress(run.observer, "pictures", 2 * sides.size() + 1);
    PaperStudio studio(run, progress);
    studio.scene.material.id = "skim_milk";
    const PaperPicture truth = studio.truth();
    progress.finish();
    ContactSheet sheet = paperSheet(studio, "Texels of the irradiance, Fig. 4.6",
                                    "Differences end at a tenth of the picture's mean. Below: relative RMSE.");
    sheet.column_title = "Texels";
    sheet.rows = {"1,600 samples", "6,400 samples", "its difference"};
    plate.figure.title = "Error over the texels of the irradiance, Fig. 4.6";
    plate.figure.caption = "Skim milk, 10 mm; relative RMSE of the picture.";
    plate.figure.x = {.label = "Texels along a side", .scale = AxisScale::logarithmic};
    plate.figure.y = {.label = "Relative RMSE", .unit = "%", .scale = AxisScale::logarithmic};
    std::array<std::vector<SheetCell>, 3> rows;
    std::array<Series, 2> curves{{{.label = "1,600 samples", .color = 0}, {.label = "6,400 samples", .color = 1}}};
    for (const double side : sides) {
        const bool is_shown = std::ranges::find(shown, side) != shown.end();
        if (is_shown) sheet.columns.push_back(fmt::format("{0:.0f}²", side));
        for (std::size_t k = 0; k < 2; ++k) {
            std::string refused;
            PaperPicture picture;
            try {
                picture = studio.take("texture-space", {{"samples", k == 0 ? 1600.0 : 6400.0}, {"atlas", side}});
            } catch (const Error& error) {
                if (error.kind != ErrorKind::usage) throw;
                refused = "no room for the charts";
            }
            progress.finish();
            if (!refused.empty()) {
                if (is_shown) rows[k].push_back({"", refused});
                if (is_shown && k == 1) rows[2].push_back({});
                continue;
            }
            const double error = errorOf(picture, truth);
            curves[k].x.push_back(side);
            curves[k].y.push_back(100 * error);
            if (is_shown) rows[k].push_back(shownCell(picture.image, truth.exposure, percentOf(error)));
            if (is_shown && k == 1) rows[2].push_back(differenceCell(picture.image, truth.image, 0.1, ""));
        }
    }
    for (std::vector<SheetCell>& row : rows)
        for (SheetCell& cell : row) sheet.cells.push_back(std::move(cell));
    plate.sheet = std::move(sheet);
    const auto at = [&](std::size_t k, double side) {
        const auto found = std::ranges::find(curves[k].x, side);
        return found == curves[k].x.end() ? INFINITY
                                          : curves[k].y[static_cast<std::size_t>(found - curves[k].x.begin())];
    };
    for (std::size_t k = 0; k < 2; ++k)
        plate.values[k == 0 ? "1600_samples" : "6400_samples"] = {{"texels", curves[k].x},
                                                                  {"relative_rmse_percent", curves[k].y}};
    plate.statements.push_back(
        {.says = "128 x 128 texels are enough",
         .found = fmt::format("1,600 samples: {:.2g} % at 128 x 128, {:.2g} % at 512 x 512; 6,400 samples: {:.2g} and "
                              "{:.2g} %",
                              at(0, 128), at(0, 512), at(1, 128), at(1, 512)),
         .holds = at(0, 128) < 1.25 * at(0, 512)});
    plate.figure.series.assign(curves.begin(), curves.end());
    return plate;
}

Image atlasOf(const Object& object, bool conformal, int side, Observer& observer) {
    const AtlasOptions options{.resolution = side, .conformal = conformal, .uvs = AtlasUvs::own};
    const std::optional<CacheFolder> cache = shapeCache();
    return atlasPicture(object.mesh,
                        cache ? cachedAtlas(object.mesh, object.content_hash, options, atlasesBeside(*cache), observer)
                              : makeAtlas(object.mesh, options, observer),
                        2);
}

// A picture that has alpha, before white, in the middle of one of that size.
SheetCell chartsCell(const Image& charts, int width, int height, std::string note) {
    Image framed(width, height, {1, 1, 1, 1});
    const double scale = static_cast<double>(charts.width) / std::min(width, height);
    const int left = (width - static_cast<int>(charts.width / scale)) / 2;
    const int top = (height - static_cast<int>(charts.height / scale)) / 2;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int from_x = static_cast<int>(std::floor((x - left) * scale));
            const int from_y = static_cast<int>(std::floor((y - top) * scale));
            if (from_x < 0 || from_y < 0 || from_x >= charts.width || from_y >= charts.height) continue;
            const Rgba& p = charts.at(from_x, from_y);
            framed.at(x, y) = {p.r + 1 - p.a, p.g + 1 - p.a, p.b + 1 - p.a, 1};
        }
    return shownCell(framed, 0, std::move(note));
}

PaperPlate figure47(const PaperRun& run) {
    PaperPlate plate;
    chooseScene(plate, run);
    plate.choices.emplace_back(
        "marble, 10 mm, 1,600 samples, 128 x 128 texels; the bad map keeps angles and not areas, by few charts");
    UnitProgress progress(run.observer, "pictures", 3);
    PaperStudio studio(run, progress);
    studio.scene.material.id = "marble";
    const PaperPicture truth = studio.truth();
    progress.finish();
    ContactSheet sheet = paperSheet(studio, "A bad parameterisation and ours, Fig. 4.7",
                                    "Charts: darker where a texel stands for more surface. Differences end at a fifth "
                                    "of the picture's mean.");
    sheet.columns = {"Texture space", "Picture", "Difference"};
    sheet.rows = {"Few conformal charts", "Our charts"};
    std::array<double, 2> errors{};
    for (std::size_t k = 0; k < 2; ++k) {
        const bool conformal = k == 0;
        const PaperPicture picture =
            studio.take("texture-space",
                        {{"samples", 1600.0}, {"atlas", 128.0}, {"uvs", std::string(conformal ? "conformal" : "own")}});
        errors[k] = errorOf(picture, truth);
        const auto& numbers = picture.report.numbers;
        sheet.cells.push_back(chartsCell(
            atlasOf(*studio.stages("texture-space").object, conformal, 128, progress), studio.width, studio.height,
            fmt::format("{:.0f} charts, texel ≤ {:.0f} × mean", numbers.at("charts"), numbers.at("largest_area"))));
        sheet.cells.push_back(shownCell(picture.image, truth.exposure, percentOf(errors[k])));
        sheet.cells.push_back(differenceCell(picture.image, truth.image, 0.2, ""));
        plate.values[conformal ? "conformal" : "own"] = {{"relative_rmse", errors[k]},
                                                         {"largest_area", numbers.at("largest_area")},
                                                         {"stretch_l2", numbers.at("stretch_l2")}};
        progress.finish();
    }
    plate.sheet = std::move(sheet);
    plate.statements.push_back(
        {.says = "a parameterisation that shrinks parts of the surface harms visibly, one that keeps areas does not",
         .found =
             fmt::format("errors: {} by the conformal map, {} by ours", percentOf(errors[0]), percentOf(errors[1])),
         .holds = errors[0] > 2 * errors[1]});
    return plate;
}

}  // namespace

std::vector<PaperFigure> chang2007Figures() {
    return {{"4.2", "three techniques, from three sides", figure42},
            {"4.3", "10 mm beside the hierarchical sum", figure43},
            {"4.4", "40 mm beside the hierarchical sum", figure44},
            {"4.5", "five sizes: error, samples and time, with the hybrid", chang2007Figure45},
            {"4.6", "texels of the irradiance", figure46},
            {"4.7", "a bad parameterisation and ours", figure47},
            {"4.8", "three sizes by texture space and by the hybrid", chang2007Figure48},
            {"4.9", "three materials by texture space and by the hybrid", chang2007Figure49}};
}

}  // namespace searchlight
