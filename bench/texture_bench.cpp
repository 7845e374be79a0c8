// Texture space importance sampling: its error, against all the light summed, and its price.
//
//   texture_bench [--object NAME] [--material ID] [--size WIDTHxHEIGHT] [--seeds N] [--only samples|sizes|atlas|time]
//
// samples: relative RMSE over the picture (root of the mean squared error over that of the mean square, worst channel)
//          of one picture, and of the mean of N seeds: what is left when the noise averages out
// sizes:   the same for objects of 10 to 70 mm, and how many samples 2 % would take
// atlas:   the same over the texels along a side, for light of texels and of samples, for charts of our own and for few
//          conformal ones
// time:    CPU time of all threads for a new camera, the sum alone in ms of wall time, beside the hierarchical
// technique
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "model/plane.h"
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
    int width = 640, height = 360, seeds = 8;
};

using Pixels = std::vector<Rgb>;

Pixels pixelsOf(const Image& image) {
    Pixels pixels;
    for (const Rgba& p : image.pixels) pixels.push_back({p.r, p.g, p.b});
    return pixels;
}

double rmse(const Pixels& found, const Pixels& truth) {
    double worst = 0;
    for (int c = 0; c < Rgb::channels; ++c) {
        double errors = 0, squares = 0;
        for (std::size_t i = 0; i < truth.size(); ++i) {
            errors += std::pow(found[i][c] - truth[i][c], 2);
            squares += truth[i][c] * truth[i][c];
        }
        if (squares > 0) worst = std::max(worst, std::sqrt(errors / squares));
    }
    return worst;
}

class Pictures {
public:
    explicit Pictures(const Setup& setup) : setup_(setup), renderer_(shippedMaterials()) {
        settings_ = {.width = setup.width, .height = setup.height, .technique = "texture-space"};
    }

    Pixels take(ParamValues options, std::uint64_t seed = 1) {
        settings_.technique_options = std::move(options);
        settings_.seed = seed;
        renderer_.setScene(setup_.scene);
        renderer_.setSettings(settings_);
        return pixelsOf(renderer_.render(observer_));
    }

    struct Error {
        double single = 0, mean = 0;
    };
    Error error(const ParamValues& options, const Pixels& truth) {
        Error error;
        Pixels sum(truth.size());
        for (int seed = 1; seed <= setup_.seeds; ++seed) {
            const Pixels picture = take(options, static_cast<std::uint64_t>(seed));
            const double one = rmse(picture, truth);
            error.single += one * one / setup_.seeds;
            for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = sum[i] + (1.0 / setup_.seeds) * picture[i];
        }
        return {std::sqrt(error.single), rmse(sum, truth)};
    }

    void technique(std::string id, std::size_t points) {
        settings_.technique = std::move(id);
        settings_.points = points;
        settings_.points_cache = CacheFolder{std::filesystem::temp_directory_path() / "searchlight-bench", ".points"};
    }

    Scene& scene() { return setup_.scene; }
    const RenderReport& report() const { return renderer_.report(); }

private:
    Setup setup_;
    RenderSettings settings_;
    Renderer renderer_;
    Observer observer_;
};

Pixels truthOf(const Setup& setup) {
    Pictures pictures(setup);
    pictures.technique("hierarchical", 800'000);
    return pictures.take({{"error", 0.001}});
}

void samples(const Setup& setup) {
    fmt::print("{:>9} {:>8} {:>9} {:>9}\n", "footprint", "samples", "RMSE %", "mean %");
    const Pixels truth = truthOf(setup);
    Pictures pictures(setup);
    for (const double footprint : {0.0, 0.5, 1.0, 2.0})
        for (const double count : {100.0, 400.0, 1600.0, 6400.0, 25600.0}) {
            const auto error = pictures.error({{"samples", count}, {"footprint", footprint}}, truth);
            fmt::print("{:>9} {:>8} {:>9.3f} {:>9.3f}\n", footprint, count, 100 * error.single, 100 * error.mean);
            std::fflush(stdout);
        }
}

void sizes(Setup setup) {
    fmt::print("{:>5} {:>9} {:>9} {:>12}\n", "mm", "1600: %", "6400: %", "for 2 %");
    for (const double size : {10.0, 20.0, 30.0, 40.0, 55.0, 70.0}) {
        setup.scene.scale = size;
        const Pixels truth = truthOf(setup);
        Pictures pictures(setup);
        const double few = pictures.error({{"samples", 1600.0}}, truth).single;
        const double more = pictures.error({{"samples", 6400.0}}, truth).single;
        double wanted = 100;
        while (wanted < 200'000 && pictures.error({{"samples", std::round(wanted)}}, truth).single > 0.02)
            wanted *= std::sqrt(2.0);
        fmt::print("{:>5} {:>9.3f} {:>9.3f} {:>12.0f}\n", size, 100 * few, 100 * more, wanted);
        std::fflush(stdout);
    }
}

void atlas(const Setup& setup) {
    fmt::print("{:>6} {:<10} {:<8} {:>9} {:>9} {:>7} {:>6} {:>8}\n", "texels", "uvs", "light", "RMSE %", "mean %",
               "charts", "L2", "largest");
    const Pixels truth = truthOf(setup);
    for (const char* uvs : {"own", "conformal"})
        for (const double side : {16.0, 32.0, 64.0, 128.0, 256.0, 512.0})
            for (const bool own_light : {false, true}) {
                Pictures pictures(setup);
                try {
                    const auto error = pictures.error(
                        {{"samples", 6400.0}, {"atlas", side}, {"uvs", std::string(uvs)}, {"own_light", own_light}},
                        truth);
                    const auto& numbers = pictures.report().technique.numbers;
                    fmt::print("{:>6} {:<10} {:<8} {:>9.3f} {:>9.3f} {:>7} {:>6.3f} {:>8.1f}\n", side, uvs,
                               own_light ? "samples" : "texels", 100 * error.single, 100 * error.mean,
                               numbers.at("charts"), numbers.at("stretch_l2"), numbers.at("largest_area"));
                } catch (const std::exception& refused) {
                    fmt::print("{:>6} {:<10} {}\n", side, uvs, refused.what());
                }
                std::fflush(stdout);
            }
}

void time(Setup setup) {
    fmt::print("{:<34} {:>9} {:>9} {:>9} {:>9}\n", "", "receivers", "RMSE %", "CPU ms", "sum ms");
    const auto row = [&](const std::string& name, const std::string& technique, const ParamValues& options) {
        Pictures pictures(setup);
        pictures.technique(technique, technique == "hierarchical" ? 100'000 : 0);
        const Pixels truth = truthOf(setup);
        const double error = rmse(pictures.take(options), truth);
        std::vector<double> cpu, sum;
        for (int i = 0; i < 5; ++i) {
            pictures.scene().camera.azimuth_deg += 1;
            const double before = userMs();
            pictures.take(options);
            cpu.push_back(userMs() - before);
            double total = 0;
            for (const auto& [stage, ms] : pictures.report().technique.stage_ms) total += ms;
            sum.push_back(total);
        }
        std::ranges::sort(cpu), std::ranges::sort(sum);
        fmt::print("{:<34} {:>9} {:>9.3f} {:>9.1f} {:>9.1f}\n", name, pictures.report().receivers, 100 * error, cpu[2],
                   sum[2]);
        std::fflush(stdout);
    };
    for (const char* sum : {"loop", "tree"})
        for (const double count : {49.0, 100.0, 169.0, 256.0, 400.0, 900.0, 1600.0, 2500.0, 6400.0})
            row(fmt::format("texture-space {} {}", sum, count), "texture-space",
                {{"samples", count}, {"sum", std::string(sum)}});
    for (const double error : {0.05, 0.02, 0.01, 0.005})
        row(fmt::format("hierarchical {}", error), "hierarchical", {{"error", error}});
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
        if (flag == "--seeds") setup.seeds = std::atoi(value.c_str());
        if (flag == "--only") only = value;
        if (flag == "--size") std::sscanf(value.c_str(), "%dx%d", &setup.width, &setup.height);
    }
    const auto wanted = [&](const char* name) { return only.empty() || only == name; };
    if (wanted("samples")) samples(setup);
    if (wanted("sizes")) sizes(setup);
    if (wanted("atlas")) atlas(setup);
    if (wanted("time")) time(setup);
}
