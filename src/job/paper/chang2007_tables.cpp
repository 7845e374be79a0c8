// [Chang2007], Tables 4.1 to 4.4: what the stages of two techniques cost over the number of samples.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "job/paper/chang2007.h"
#include "job/paper/paper_studio.h"
#include "job/unit_progress.h"

namespace searchlight {

namespace {

constexpr std::array<double, 8> counts{49, 100, 169, 256, 400, 900, 1600, 2500};
using Row = std::array<double, counts.size()>;

struct PublishedRow {
    const char* model;
    Row values;
};

// Milliseconds of preprocessing, Tables 4.1 and 4.3; frames per second of integration, Tables 4.2 and 4.4.
constexpr std::array<PublishedRow, 5> table41{{{"Sphere(28K)", {5.31, 5.29, 6.47, 5.20, 5.25, 5.14, 5.12, 5.60}},
                                               {"CowHead", {5.34, 5.23, 4.86, 5.11, 5.16, 5.14, 4.86, 4.70}},
                                               {"TexHead", {5.30, 5.26, 5.10, 5.31, 5.46, 5.42, 5.14, 4.59}},
                                               {"MaxPlanck", {5.29, 5.11, 5.33, 5.19, 5.31, 5.29, 4.95, 4.65}},
                                               {"Parasaur", {5.29, 5.43, 5.17, 5.52, 5.41, 5.71, 6.25, 6.15}}}};
constexpr std::array<PublishedRow, 5> table42{{{"Sphere(28K)", {448.6, 242.3, 179.7, 101.5, 65.9, 29.8, 16.5, 10.4}},
                                               {"CowHead", {1123.0, 623.7, 393.3, 267.4, 177.3, 81.0, 45.1, 28.4}},
                                               {"TexHead", {822.6, 448.5, 277.1, 187.5, 122.5, 55.7, 30.8, 19.4}},
                                               {"MaxPlanck", {783.9, 430.1, 268.0, 180.5, 118.0, 53.4, 29.8, 18.7}},
                                               {"Parasaur", {1069.9, 602.1, 377.5, 258.6, 168.3, 76.2, 42.9, 27.0}}}};
constexpr std::array<PublishedRow, 3> table43{{{"TexHead", {6.27, 6.26, 6.12, 6.37, 6.51, 6.49, 6.73, 6.90}},
                                               {"MaxPlanck", {6.16, 6.82, 6.95, 6.18, 6.42, 6.18, 5.46, 6.26}},
                                               {"Parasaur", {5.93, 6.05, 6.04, 6.04, 6.12, 5.97, 5.86, 5.95}}}};
constexpr std::array<PublishedRow, 3> table44{{{"TexHead", {108.6, 53.3, 30.7, 20.4, 13.2, 5.7, 3.2, 2.1}},
                                               {"MaxPlanck", {100.2, 50.1, 29.1, 18.7, 11.9, 5.3, 2.9, 1.9}},
                                               {"Parasaur", {145.8, 70.0, 41.3, 27.6, 17.4, 7.7, 4.3, 2.8}}}};

struct Cost {
    std::string object;
    std::size_t triangles = 0, receivers = 0;
    Row prepare_ms{}, sum_ms{};  ///< CPU time of all threads
};

// Ours in place of the thesis' models; the one that was asked for comes last.
std::vector<std::string> subjects(const PaperRun& run) {
    std::vector<std::string> objects{"sphere", "torus_knot", "statue"};
    if (std::ranges::find(objects, run.object) == objects.end()) objects.push_back(run.object);
    return objects;
}

// The least of `repeats`, each with a light that has moved a little: what a machine that does other things as well adds
// is left out.
std::vector<Cost> measure(const PaperRun& run, const std::string& technique, ParamValues options, int repeats,
                          bool with_sum = true) {
    const std::vector<std::string> objects = subjects(run);
    UnitProgress progress(run.observer, "numbers of samples", objects.size() * counts.size());
    std::vector<Cost> costs;
    for (const std::string& object : objects) {
        PaperRun of_object = run;
        of_object.object = object;
        PaperStudio studio(of_object, progress);
        studio.width = studio.height = run.size > 0 ? run.size : 512;
        studio.scene.material.id = "skim_milk";
        Cost cost{.object = object};
        for (std::size_t i = 0; i < counts.size(); ++i) {
            options["samples"] = counts[i];
            if (i == 0) studio.prepare(technique, options);
            cost.prepare_ms[i] = cost.sum_ms[i] = INFINITY;
            for (int repeat = 0; repeat < repeats; ++repeat) {
                std::get<PointLight>(studio.scene.lights[0]).position.x += 1e-4;
                const PaperPicture picture =
                    with_sum ? studio.take(technique, options) : studio.prepare(technique, options);
                cost.prepare_ms[i] = std::min(cost.prepare_ms[i], picture.prepare_cpu_ms);
                cost.sum_ms[i] = std::min(cost.sum_ms[i], picture.sum_cpu_ms);
                cost.receivers = picture.receivers;
            }
            progress.finish();
        }
        cost.triangles = studio.stages(technique).object->mesh.triangles.size();
        costs.push_back(std::move(cost));
    }
    return costs;
}

struct Line {
    double intercept = 0, slope = 0;
    double worst = 0;  ///< largest deviation of a value from the line, relative
};

// Least squares of relative deviations: all counts weigh the same.
Line fitLine(const Row& values) {
    double s = 0, sx = 0, sxx = 0, sy = 0, sxy = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const double w = 1 / (values[i] * values[i]), x = counts[i], y = values[i];
        s += w, sx += w * x, sxx += w * x * x, sy += w * y, sxy += w * x * y;
    }
    Line line;
    line.slope = (s * sxy - sx * sy) / (s * sxx - sx * sx);
    line.intercept = (sy - line.slope * sx) / s;
    for (std::size_t i = 0; i < counts.size(); ++i)
        line.worst = std::max(line.worst, std::abs((line.intercept + line.slope * counts[i]) / values[i] - 1));
    return line;
}

Row perFrame(const Row& frames_per_second) {
    Row ms{};
    std::ranges::transform(frames_per_second, ms.begin(), [](double fps) { return 1000 / fps; });
    return ms;
}

std::string heading(std::string_view what) {
    std::string text = fmt::format("{:<26}", what);
    for (const double count : counts) text += fmt::format("{:>9}", count);
    return text + "\n";
}

std::string line(const std::string& name, const Row& values, int digits = 4) {
    std::string text = fmt::format("{:<26}", name);
    for (const double value : values) text += fmt::format("{:>9.{}g}", value, digits);
    return text + "\n";
}

std::string nameOf(const Cost& cost) {
    const std::size_t slash = cost.object.find_last_of('/');
    const std::string name = slash == std::string::npos ? cost.object : cost.object.substr(slash + 1);
    return fmt::format("{}, {}k", name, (cost.triangles + 500) / 1000);
}

Json costJson(const std::vector<Cost>& costs) {
    Json json = Json::object();
    for (const Cost& cost : costs) {
        Json& of = json[cost.object] = {{"triangles", cost.triangles},
                                        {"receivers", cost.receivers},
                                        {"samples", counts},
                                        {"preprocessing_cpu_ms", cost.prepare_ms}};
        if (cost.sum_ms[0] > 0) of["integration_cpu_ms"] = cost.sum_ms;
    }
    return json;
}

void chooseMachine(PaperPlate& plate, const PaperRun& run) {
    const int side = run.size > 0 ? run.size : 512;
    plate.choices.emplace_back(
        "Objects of the project, and --object: the thesis' meshes are not free. Skim milk, 10 mm, one point light.");
    plate.choices.push_back(fmt::format(
        "{} x {} pixels. Times are processor time of all threads in ms, the least of some repeats; the thesis' are "
        "those of a GeForce 8800 GTX. Frames per second are 1000 / ms: of one core.",
        side, side));
}

void costFigure(PaperPlate& plate, const std::string& title, const std::string& label) {
    plate.figure.title = title;
    plate.figure.x = {.label = "Samples", .scale = AxisScale::logarithmic};
    plate.figure.y = {.label = label, .unit = "ms", .scale = AxisScale::logarithmic};
}

void addCurve(PaperPlate& plate, std::string label, const Row& values, int color, bool dashed) {
    plate.figure.series.push_back({.label = std::move(label),
                                   .x = {counts.begin(), counts.end()},
                                   .y = {values.begin(), values.end()},
                                   .color = color,
                                   .dashed = dashed});
}

const ParamValues as_printed{{"sum", std::string("loop")}};
const ParamValues seen_alone{{"global_points", 0.0}};

PaperPlate preprocessing(const PaperRun& run, const std::string& technique, const ParamValues& options,
                         std::span<const PublishedRow> published, const std::string& number) {
    PaperPlate plate;
    chooseMachine(plate, run);
    const std::vector<Cost> costs = measure(run, technique, options, 2, false);
    plate.values = costJson(costs);
    costFigure(plate, "Preprocessing over samples, Table " + number, "Time of a new light");
    plate.table = heading("ms, here (CPU)");
    std::string changes;
    bool flat = true;
    int color = 0;
    for (const Cost& cost : costs) {
        plate.table += line(nameOf(cost), cost.prepare_ms, 3);
        addCurve(plate, nameOf(cost), cost.prepare_ms, color++, false);
        const double change = cost.prepare_ms.back() / cost.prepare_ms.front() - 1;
        flat = flat && std::abs(change) < 0.25;
        changes += fmt::format("{}{:+.0f} %", changes.empty() ? "" : ", ", 100 * change);
    }
    plate.table += "\n" + heading("ms, thesis (GPU)");
    double least = INFINITY, most = 0;
    for (const PublishedRow& row : published) {
        plate.table += line(row.model, row.values, 3);
        least = std::min(least, *std::ranges::min_element(row.values));
        most = std::max(most, *std::ranges::max_element(row.values));
    }
    plate.statements.push_back({.says = "the number of samples does not change what preprocessing takes",
                                .found = fmt::format("from 49 to 2,500 samples it changes by {}", changes),
                                .holds = flat});
    plate.statements.push_back({.says = "preprocessing takes around 6 to 7 ms",
                                .found = fmt::format("the thesis' own table has {:.2f} to {:.2f} ms", least, most),
                                .holds = least >= 5.5});
    return plate;
}

PaperPlate makeTable41(const PaperRun& run) {
    ParamValues options = as_printed;
    options["atlas"] = 1024.0;
    PaperPlate plate = preprocessing(run, "texture-space", options, table41, "4.1");
    plate.choices.emplace_back(
        "1024 x 1024 texels, as in the thesis. Ours has the light of every texel by a ray to the lamp, shadows "
        "included; then samples are drawn, and put in a tree.");
    return plate;
}

PaperPlate makeTable43(const PaperRun& run) {
    PaperPlate plate = preprocessing(run, "local", seen_alone, table43, "4.3");
    plate.choices.emplace_back("The light of what is seen, by a ray from every pixel to the lamp.");
    return plate;
}

PaperPlate makeTable42(const PaperRun& run) {
    PaperPlate plate;
    chooseMachine(plate, run);
    plate.choices.emplace_back("256 x 256 texels: integration does not read them.");
    const std::vector<Cost> costs = measure(run, "texture-space", as_printed, 3);
    const std::vector<Cost> trees = measure(run, "texture-space", {{"sum", std::string("tree")}}, 2);
    plate.values = costJson(costs);
    costFigure(plate, "Integration over samples, Table 4.2", "Time of the sum");
    plate.table = heading("frames/s, here (one core)");
    for (const Cost& cost : costs) plate.table += line(nameOf(cost), perFrame(cost.sum_ms));
    plate.table += "\n" + heading("frames/s, thesis (GPU)");
    for (const PublishedRow& row : table42) plate.table += line(row.model, row.values);
    plate.table += "\n" + heading("frames/s, here, by trees");
    for (const Cost& cost : trees) plate.table += line(nameOf(cost), perFrame(cost.sum_ms));
    std::string found, theirs;
    bool linear = true;
    int color = 0;
    for (const Cost& cost : costs) {
        const Line fit = fitLine(cost.sum_ms);
        linear = linear && fit.worst < 0.1;
        found += fmt::format("{}{} {:.2f} + {:.4f} n ms, within {:.1f} %, so {:.2f} ns for a receiver and a sample",
                             found.empty() ? "" : "; ", nameOf(cost), fit.intercept, fit.slope, 100 * fit.worst,
                             1e6 * fit.slope / static_cast<double>(cost.receivers));
        addCurve(plate, nameOf(cost), cost.sum_ms, color++, false);
    }
    double worst = 0;
    for (const PublishedRow& row : table42) {
        const Line fit = fitLine(perFrame(row.values));
        worst = std::max(worst, fit.worst);
        theirs += fmt::format("{}{} {:.4f}", theirs.empty() ? "" : ", ", row.model, fit.slope);
    }
    addCurve(plate, "thesis: MaxPlanck, 10k", perFrame(table42[3].values), neutral_color, true);
    plate.statements.push_back(
        {.says = "the cost of the integration is linear in the number of samples",
         .found = fmt::format("{}. The thesis' rows: {} ms a sample, within {:.0f} %", found, theirs, 100 * worst),
         .holds = linear});
    double gain = INFINITY;
    for (std::size_t i = 0; i < costs.size(); ++i)
        gain = std::min(gain, costs[i].sum_ms.back() / trees[i].sum_ms.back());
    plate.statements.push_back(
        {.says = "(not in the thesis) a tree over the samples breaks that line",
         .found = fmt::format("2,500 samples, to 0.1 %, take at least {:.1f} times less than one by one", gain),
         .holds = gain > 1});
    return plate;
}

PaperPlate makeTable44(const PaperRun& run) {
    PaperPlate plate;
    chooseMachine(plate, run);
    plate.choices.emplace_back(
        "LSS is `local` without points for what is not seen: a quarter of its samples lie in the plane that faces the "
        "eye, and all are weighed by multiple importance sampling.");
    const std::vector<Cost> local = measure(run, "local", seen_alone, 3);
    const std::vector<Cost> texture = measure(run, "texture-space", as_printed, 3);
    plate.values = {{"local", costJson(local)}, {"texture_space", costJson(texture)}};
    costFigure(plate, "Integration by samples of the picture, Table 4.4", "Time of the sum");
    plate.table = heading("frames/s, here (one core)");
    for (const Cost& cost : local) plate.table += line(nameOf(cost), perFrame(cost.sum_ms));
    plate.table += "\n" + heading("frames/s, thesis (GPU)");
    for (const PublishedRow& row : table44) plate.table += line(row.model, row.values);
    plate.table += "\n" + heading("over texture space, here");
    double least = INFINITY, most = 0, log_sum = 0;
    int color = 0;
    for (std::size_t i = 0; i < local.size(); ++i) {
        Row ratio{};
        for (std::size_t k = 0; k < counts.size(); ++k) {
            ratio[k] = local[i].sum_ms[k] / texture[i].sum_ms[k];
            log_sum += std::log(ratio[k]) / static_cast<double>(counts.size() * local.size());
        }
        least = std::min(least, *std::ranges::min_element(ratio));
        most = std::max(most, *std::ranges::max_element(ratio));
        plate.table += line(nameOf(local[i]), ratio, 2);
        addCurve(plate, nameOf(local[i]) + ", local", local[i].sum_ms, color, false);
        addCurve(plate, nameOf(local[i]) + ", texture space", texture[i].sum_ms, color++, true);
    }
    plate.table += "\n" + heading("over texture space, thesis");
    double their_least = INFINITY, their_most = 0;
    for (std::size_t i = 0; i < table44.size(); ++i) {
        Row ratio{};
        for (std::size_t k = 0; k < counts.size(); ++k) ratio[k] = table42[i + 2].values[k] / table44[i].values[k];
        their_least = std::min(their_least, *std::ranges::min_element(ratio));
        their_most = std::max(their_most, *std::ranges::max_element(ratio));
        plate.table += line(table44[i].model, ratio, 2);
    }
    plate.statements.push_back(
        {.says = "integration by the local method costs 8 to 9 times as much at the same number of samples",
         .found = fmt::format(
             "{:.1f} to {:.1f} times, {:.1f} in the mean; the thesis' own tables say {:.1f} to {:.1f}. Each sample of "
             "the local method is placed, projected and read from the picture for one receiver alone; those of texture "
             "space are the same for all, lie in a row, and cost a distance and a look into a table of R_d. On a CPU "
             "both run on the same vector lanes, and nothing waits for textures",
             least, most, std::exp(log_sum), their_least, their_most),
         .holds = std::exp(log_sum) >= their_least && std::exp(log_sum) <= their_most});
    return plate;
}

}  // namespace

std::vector<PaperFigure> chang2007Tables() {
    return {{"4.1", "texture space: preprocessing over samples", makeTable41},
            {"4.2", "texture space: integration over samples", makeTable42},
            {"4.3", "the local method: preprocessing over samples", makeTable43},
            {"4.4", "the local method: integration over samples", makeTable44}};
}

}  // namespace searchlight
