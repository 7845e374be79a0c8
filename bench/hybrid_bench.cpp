// Translucent shadow maps and the hybrid technique: their error, against all the light summed, and their price.
//
//   hybrid_bench [--object NAME] [--material ID] [--scale MM] [--size WIDTHxHEIGHT] [--only
//   bands|sizes|split|samples|local]
//
// Errors are relative, in % of the worst channel: RMSE is the root of the mean squared error over that of the mean
// square, mean the difference of the sums over the picture. ms: CPU time of all threads for a new camera.
//
// bands:   objects of several kinds, lit from the front and from behind
// sizes:   an object of 10 to 70 mm by texture-space, tsm and hybrid, each with the same samples throughout
// split:   the same by hybrid, over where R_d is split
// local:   hybrid with its two kinds of local samples, at several numbers of them
// samples: tsm and hybrid over their local samples and the texels of light maps
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "render/renderer.h"
#include "scene/materials.h"

namespace searchlight {
namespace {

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
    return 1e3 * static_cast<double>(usage.ru_utime.tv_sec) + 1e-3 * static_cast<double>(usage.ru_utime.tv_usec);
}

struct Setup {
    Scene scene;
    int width = 640, height = 360;
};

using Pixels = std::vector<Rgb>;

struct Error {
    double rmse = 0, mean = 0, ms = 0;
};

class Pictures {
public:
    Pictures(const Setup& setup, std::string technique, std::size_t points = 0)
        : scene_(setup.scene), renderer_(shippedMaterials()) {
        settings_ = {.width = setup.width, .height = setup.height, .points = points, .technique = std::move(technique)};
        settings_.points_cache = CacheFolder{std::filesystem::temp_directory_path() / "searchlight-bench", ".points"};
    }

    Pixels take(ParamValues options) {
        settings_.technique_options = std::move(options);
        renderer_.setScene(scene_);
        renderer_.setSettings(settings_);
        Pixels pixels;
        for (const Rgba& p : renderer_.render(observer_).pixels) pixels.push_back({p.r, p.g, p.b});
        return pixels;
    }

    Error error(const ParamValues& options, const Pixels& truth) {
        const Pixels found = take(options);
        Error error;
        for (int c = 0; c < Rgb::channels; ++c) {
            double errors = 0, squares = 0, off = 0, sum = 0;
            for (std::size_t i = 0; i < truth.size(); ++i) {
                const double difference = found[i][c] - truth[i][c];
                errors += difference * difference;
                squares += truth[i][c] * truth[i][c];
                off += difference;
                sum += truth[i][c];
            }
            if (!(squares > 0)) continue;
            error.rmse = std::max(error.rmse, std::sqrt(errors / squares));
            if (std::abs(off / sum) > std::abs(error.mean)) error.mean = off / sum;
        }
        scene_.camera.azimuth_deg += 1;
        const double before = userMs();
        take(options);
        error.ms = userMs() - before;
        scene_.camera.azimuth_deg -= 1;
        return error;
    }

    const RenderReport& report() const { return renderer_.report(); }

private:
    Scene scene_;
    RenderSettings settings_;
    Renderer renderer_;
    Observer observer_;
};

Pixels truthOf(const Setup& setup) { return Pictures(setup, "hierarchical", 800'000).take({{"error", 0.001}}); }

void row(const std::string& name, const Setup& setup, const char* technique, const ParamValues& options,
         const Pixels& truth) {
    Pictures pictures(setup, technique);
    const Error error = pictures.error(options, truth);
    fmt::print("{:<34} {:<34} {:>8.3f} {:>8.3f} {:>8.0f}", name, technique, 100 * error.rmse, 100 * error.mean,
               error.ms);
    const auto& numbers = pictures.report().technique.numbers;
    if (numbers.contains("split_mm_r"))
        fmt::print("   R_p {:.3g} {:.3g} {:.3g}, local {:.2f} {:.2f} {:.2f}", numbers.at("split_mm_r"),
                   numbers.at("split_mm_g"), numbers.at("split_mm_b"), numbers.at("local_share_r"),
                   numbers.at("local_share_g"), numbers.at("local_share_b"));
    fmt::print("\n");
    std::fflush(stdout);
}

void bands(Setup setup) {
    const std::string mesh = setup.scene.object;
    const auto each = [&](const std::string& object, double scale, const char* material, Vec3 from, const char* side) {
        setup.scene.object = object;
        setup.scene.scale = scale;
        setup.scene.material.id = material;
        setup.scene.lights = {DirectionalLight{.direction = from}};
        const Pixels truth = truthOf(setup);
        const std::string name =
            fmt::format("{} {} {} {}", std::filesystem::path(object).stem().string(), scale, material, side);
        row(name, setup, "tsm", {}, truth);
        row(name, setup, "hybrid", {}, truth);
    };
    const Vec3 front{1, 1, 1}, back{-0.3, 0.2, -1};
    each("slab", 30, "marble", front, "front");
    each("slab", 30, "skin1", back, "back");
    each("sphere", 20, "marble", front, "front");
    each("sphere", 20, "marble", back, "back");
    each("torus_knot", 20, "skin1", front, "front");
    each(mesh, 50, "marble", front, "front");
    each(mesh, 50, "skin1", front, "front");
    each(mesh, 10, "marble", back, "back");
}

void sizes(Setup setup) {
    for (const double size : {10.0, 20.0, 30.0, 40.0, 55.0, 70.0}) {
        setup.scene.scale = size;
        const Pixels truth = truthOf(setup);
        const std::string name = fmt::format("{} mm", size);
        row(name, setup, "texture-space", {{"samples", 900.0}}, truth);
        row(name, setup, "tsm", {}, truth);
        row(name, setup, "hybrid", {}, truth);
    }
}

void split(Setup setup) {
    for (const double size : {10.0, 30.0, 70.0}) {
        setup.scene.scale = size;
        const Pixels truth = truthOf(setup);
        for (const double share : {0.4, 0.2, 0.1, 0.05, 0.02, 0.01})
            row(fmt::format("{} mm, split {}", size, share), setup, "hybrid", {{"split", share}}, truth);
    }
}

void samples(const Setup& setup) {
    const Pixels truth = truthOf(setup);
    for (const char* technique : {"tsm", "hybrid"}) {
        for (const double count : {26.0, 101.0, 401.0, 1601.0, 6401.0})
            row(fmt::format("{} local samples", count), setup, technique, {{"local_samples", count}}, truth);
        for (const double side : {64.0, 128.0, 256.0, 512.0, 1024.0})
            row(fmt::format("{} texels", side), setup, technique, {{"light_map", side}}, truth);
    }
}

void local(Setup setup) {
    for (const double size : {10.0, 70.0}) {
        setup.scene.scale = size;
        const Pixels truth = truthOf(setup);
        for (const char* kind : {"light", "tangent"})
            for (const double count : {17.0, 101.0, 401.0})
                row(fmt::format("{} mm, {} {}", size, kind, count), setup, "hybrid",
                    {{"local", std::string(kind)}, {"local_samples", count}}, truth);
    }
}

}  // namespace
}  // namespace searchlight

int main(int argc, char** argv) {
    using namespace searchlight;
    Setup setup;
    setup.scene.object = "statue";
    setup.scene.scale = 10;
    std::string only;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string flag = argv[i], value = argv[i + 1];
        if (flag == "--object") setup.scene.object = value;
        if (flag == "--material") setup.scene.material.id = value;
        if (flag == "--scale") setup.scene.scale = std::atof(value.c_str());
        if (flag == "--only") only = value;
        if (flag == "--size") std::sscanf(value.c_str(), "%dx%d", &setup.width, &setup.height);
    }
    const auto wanted = [&](const char* name) { return only.empty() || only == name; };
    fmt::print("{:<34} {:<34} {:>8} {:>8} {:>8}\n", "", "", "RMSE %", "mean %", "CPU ms");
    if (wanted("bands")) bands(setup);
    if (wanted("sizes")) sizes(setup);
    if (wanted("split")) split(setup);
    if (wanted("samples")) samples(setup);
    if (wanted("local")) local(setup);
}
