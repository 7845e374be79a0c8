// What a frame costs while something moves: the camera, the light, the material. 1280 x 720, hierarchical, CPU.
//
//   frames_bench [--frames N] [--meshes FOLDER] [--changes camera|light|material]
//   frames_bench --visible FILE       the visible surface alone, drawn and by rays, one thread, CPU time
//
// Median of the frames after the first of each kind: wall time, CPU time of all threads, wall time by stage. With the
// folder of meshes also the objects of the table in [Bitterli2013], with as many points; the light is kept while the
// camera moves, as there.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>

#include "model/plane.h"
#include "render/renderer.h"
#include "render/visible_raster.h"
#include "scene/materials.h"

namespace searchlight {
namespace {

struct Row {
    const char* file;
    std::size_t points;
    double thesis_ms;
};

// [Bitterli2013, Table 3.1], on a GTX 480. The cow is another one here.
constexpr Row thesis_rows[] = {{"armadillo_100k.ply", 339'679, 138},   {"happy_buddha_100k.ply", 301'986, 149},
                               {"bunny_70k_closed.ply", 489'088, 143}, {"spot_25k.ply", 203'355, 45},
                               {"dragon_100k.ply", 88'551, 121},       {"lucy_100k.ply", 202'801, 84},
                               {"xyzrgb_dragon_28k.ply", 199'174, 102}};

MaterialSource shippedMaterials() {
    return [](const Scene& scene) {
        RenderMaterial material{loadModel(scene.model.id), resolveMaterial(scene.material).medium, nullptr};
        material.evaluator = makeNativeEvaluator(material.model);
        material.evaluator->set(material.medium, {});
        return material;
    };
}

double userMs() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1e3 * static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-3 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

using Times = std::map<std::string, double>;

class Frames {
public:
    Frames(Scene scene, std::size_t points) : scene_(std::move(scene)), renderer_(shippedMaterials()) {
        renderer_.setSettings(
            {.points = points,
             .points_cache = CacheFolder{std::filesystem::temp_directory_path() / "searchlight-bench", ".points"}});
    }

    Times frame() {
        renderer_.setScene(scene_);
        const double cpu = userMs();
        const auto begin = std::chrono::steady_clock::now();
        renderer_.render(observer_);
        Times times;
        times["all"] = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
        times["cpu"] = userMs() - cpu;
        const RenderReport& report = renderer_.report();
        for (std::size_t i = 0; i < stage_count; ++i)
            times[std::string(stageName(static_cast<Stage>(i)))] = report.stages[i].ms;
        for (const auto& [name, ms] : report.technique.stage_ms) times[name] = ms;
        times["bound"] = 100 * report.technique.error_bound;
        return times;
    }

    template <class Change>
    Times median(int frames, Change change) {
        std::map<std::string, std::vector<double>> all;
        for (int i = 0; i < frames; ++i) {
            change(scene_);
            for (const auto& [name, ms] : frame()) all[name].push_back(ms);
        }
        Times times;
        for (auto& [name, values] : all) {
            std::ranges::sort(values);
            times[name] = values[values.size() / 2];
        }
        return times;
    }

    const RenderReport& report() const { return renderer_.report(); }

private:
    Scene scene_;
    Renderer renderer_;
    Observer observer_;
};

void head() {
    fmt::print("{:<14} {:<9} {:>8}", "object", "changes", "samples");
    for (const char* name : {"all", "cpu", "light", "visible", "backgr", "tree", "pilot", "sum", "shade", "bound %"})
        fmt::print(" {:>8}", name);
    fmt::print("\n");
}

void line(const std::string& object, const char* what, const Frames& frames, Times times) {
    fmt::print("{:<14} {:<9} {:>8}", object, what, frames.report().receivers);
    for (const char* name :
         {"all", "cpu", "irradiance", "visible", "background", "tree", "pilot", "sum", "shade", "bound"})
        fmt::print(" {:>8.2f}", times[name]);
    fmt::print("\n");
    std::fflush(stdout);
}

void run(const std::string& name, const Scene& scene, std::size_t points, int count, const std::string& only) {
    Frames frames(scene, points);
    line(name, "first", frames, frames.frame());
    const auto wanted = [&](const char* change) { return only.empty() || only == change; };
    if (wanted("camera"))
        line(name, "camera", frames, frames.median(count, [](Scene& s) { s.camera.azimuth_deg += 1; }));
    if (wanted("light"))
        line(name, "light", frames, frames.median(count, [angle = 0.0](Scene& s) mutable {
            angle += 0.02;
            s.lights = {DirectionalLight{.direction = {std::sin(angle), 1, std::cos(angle)}}};
        }));
    if (wanted("material"))
        line(name, "material", frames, frames.median(count, [](Scene& s) { s.material.scale *= 1.01; }));
}

void compareVisible(const std::string& file, int count) {
    Scene scene;
    scene.object = file;
    const Object object = placeObject(scene);
    const RayScene rays(object.mesh);
    VisibleRaster raster;
    VisibleSurface visible;
    Observer observer;
    std::vector<double> drawn, traced;
    for (int i = 0; i < count; ++i) {
        scene.camera.azimuth_deg += 7;
        const View view = makeView(scene.camera, object, 1280, 720);
        const double begin = userMs();
        raster.find(view, object, {.threads = 1}, observer, visible);
        const double between = userMs();
        traceVisible(view, object, rays, {.threads = 1}, observer);
        drawn.push_back(between - begin);
        traced.push_back(userMs() - between);
    }
    std::ranges::sort(drawn);
    std::ranges::sort(traced);
    fmt::print("{}: {} triangles, {} samples; drawn {:.1f} ms, by rays {:.1f} ms\n", file, object.mesh.triangles.size(),
               visible.pixels.size(), drawn[drawn.size() / 2], traced[traced.size() / 2]);
}

int main(int argc, char** argv) {
    int count = 9;
    std::string folder, only;
    for (int i = 1; i + 1 < argc; i += 2) {
        if (!std::strcmp(argv[i], "--frames")) count = std::atoi(argv[i + 1]);
        if (!std::strcmp(argv[i], "--meshes")) folder = argv[i + 1];
        if (!std::strcmp(argv[i], "--changes")) only = argv[i + 1];
        if (!std::strcmp(argv[i], "--visible")) return compareVisible(argv[i + 1], count), 0;
    }
    head();
    for (const char* material : {"skin1", "marble"}) {
        Scene scene;
        scene.material.id = material;
        run(fmt::format("sphere {}", material), scene, 0, count, only);
    }
    if (folder.empty()) return 0;
    for (const Row& row : thesis_rows) {
        if (!std::filesystem::exists(std::filesystem::path(folder) / row.file)) continue;
        Scene scene;
        scene.object = (std::filesystem::path(folder) / row.file).string();
        scene.scale = 50;
        run(fmt::format("{} {}", std::string(row.file).substr(0, 8), row.thesis_ms), scene, row.points, count, only);
    }
    return 0;
}

}  // namespace
}  // namespace searchlight

int main(int argc, char** argv) { return searchlight::main(argc, argv); }
