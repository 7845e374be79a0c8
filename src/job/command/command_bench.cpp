// bench render: how long each stage of a picture takes on this machine.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "base/error.h"
#include "job/command_table.h"
#include "job/json.h"
#include "job/render/render_material.h"
#include "job/shared_options.h"

namespace searchlight {

namespace {

// Small and large beside the mean free path: what decides how far the sum can be grouped.
constexpr const char* bench_materials[] = {"skin1", "marble"};
constexpr double bench_radii_mm[] = {2.5, 10, 40};

struct BenchRow {
    std::string material;
    double radius_mm = 0;
    RenderReport report;                   // of the first picture
    std::map<std::string, double> sum_ms;  // of the technique, least of the repetitions
    double picture_ms = 0;                 // with everything made anew but object and points, least
};

// The camera turns for each repetition, so that what it sees is traced and summed again.
BenchRow benchRow(Scene scene, const RenderSettings& settings, int repeats, Engine& engine, Observer& observer) {
    BenchRow row{.material = scene.material.id, .radius_mm = scene.scale / 2};
    Renderer renderer(materialSource(engine, settings.gl ? "gl" : "auto"), settings.gl ? &engine.context() : nullptr);
    renderer.setSettings(settings);
    for (int i = 0; i <= repeats; ++i) {
        renderer.setScene(scene);
        const auto begin = std::chrono::steady_clock::now();
        renderer.render(observer);
        const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
        if (i == 0) {
            row.report = renderer.report();
        } else {
            row.picture_ms = i == 1 ? ms : std::min(row.picture_ms, ms);
            for (const auto& [stage, value] : renderer.report().technique.stage_ms) {
                const auto [known, first] = row.sum_ms.try_emplace(stage, value);
                if (!first) known->second = std::min(known->second, value);
            }
        }
        scene.camera.azimuth_deg += 1;
    }
    return row;
}

JobResult runBenchRender(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    RenderSettings settings;
    settings.points = static_cast<std::size_t>(options.number("points"));
    settings.technique_options["error"] = options.number("error");
    settings.threads = static_cast<int>(options.number("threads"));
    settings.gl = options.text("backend") == "gl";
    settings.seed = job.seed;

    Json document = documentJson("searchlight-bench/1", job);
    document["rows"] = Json::array();
    JobResult result;
    result.text =
        fmt::format("{:<8} {:>9}  {:>9} {:>12} {:>9} {:>9} {:>9}  {:>11}  {:>9}\n", "material", "radius mm",
                    "receivers", "irradiance ms", "visible ms", "pilot ms", "sum ms", "ns/receiver", "next picture ms");
    for (const char* material : bench_materials)
        for (const double radius_mm : bench_radii_mm) {
            Scene scene;
            scene.object = options.text("object");
            scene.scale = 2 * radius_mm;
            scene.material.id = material;
            const BenchRow row =
                benchRow(scene, settings, static_cast<int>(options.number("repeats")), engine, observer);
            const double ns = 1e6 * row.sum_ms.at("sum") / static_cast<double>(row.report.receivers);
            Json json{{"material", row.material},
                      {"radius_mm", row.radius_mm},
                      {"points", row.report.points},
                      {"receivers", row.report.receivers},
                      {"device", row.report.technique.device},
                      {"interactions", row.report.technique.interactions},
                      {"error", options.number("error")},
                      {"error_bound", row.report.technique.error_bound},
                      {"ns_per_receiver", ns}};
            for (std::size_t i = 0; i < stage_count; ++i)
                json["first_ms"][std::string(stageName(static_cast<Stage>(i)))] = row.report.stages[i].ms;
            json["next_ms"] = row.sum_ms;
            json["next_ms"]["picture"] = row.picture_ms;
            document["rows"].push_back(json);
            const auto stage = [&](const char* name) { return row.sum_ms.contains(name) ? row.sum_ms.at(name) : 0; };
            result.text +=
                fmt::format("{:<8} {:>9}  {:>9} {:>12.1f} {:>9.1f} {:>9.1f} {:>9.1f}  {:>11.0f}  {:>9.1f}\n",
                            row.material, row.radius_mm, row.report.receivers, row.report[Stage::irradiance].ms,
                            row.report[Stage::visible].ms, stage("pilot"), stage("sum"), ns, row.picture_ms);
        }
    result.json = jsonText(document);
    return result;
}

}  // namespace

Command benchRenderCommand() {
    return {.name = "bench render",
            .summary = "Time the stages of a picture: two materials, three sizes",
            .example = "searchlight bench render --points 200000 --error 0.004 --json",
            .options =
                {{.name = "object",
                  .type = ParamType::text,
                  .value = std::string("sphere"),
                  .doc = "a built-in object, or a mesh or point cloud file"},
                 {.name = "points",
                  .type = ParamType::integer,
                  .min = 16,
                  .max = 1e8,
                  .value = 200'000.0,
                  .doc = "of irradiance"},
                 {.name = "error", .min = 1e-4, .max = 0.5, .value = 0.004, .doc = "relative RMSE that is asked for"},
                 {.name = "repeats",
                  .type = ParamType::integer,
                  .min = 1,
                  .max = 1000,
                  .value = 3.0,
                  .doc = "pictures of which the fastest counts"},
                 {.name = "backend",
                  .type = ParamType::choice,
                  .value = std::string("cpu"),
                  .choices = {"cpu", "gl"},
                  .doc = "what sums"},
                 option::threads()},
            .uses_seed = true,
            .run = runBenchRender};
}

}  // namespace searchlight
