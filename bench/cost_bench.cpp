// What a frame's sum costs by the number of points and pixels, the error and the size of the object: curves as figures.
//
//   cost_bench FOLDER       writes cost_points.svg, cost_pixels.svg, cost_error.svg and cost_size.svg, each with a .csv
//
// A dented sphere under one lamp, dipole profiles, one core, CPU time, least of three. The camera moves by a little
// between two sums: each has new receivers, and is judged.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <optional>

#include "draw/draw.h"
#include "model/evaluator.h"
#include "model/plane.h"
#include "render/exitance_sum.h"
#include "scene/materials.h"

namespace searchlight {
namespace {

constexpr const char* materials[] = {"skin1", "marble"};

// Orange and blue of the palette.
constexpr int colors[] = {1, 0};

rusage usage() {
    rusage now{};
    getrusage(RUSAGE_SELF, &now);
    return now;
}

double cpuMs() {
    const rusage now = usage();
    const auto ms = [](timeval t) {
        return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
    };
    return ms(now.ru_utime) + ms(now.ru_stime);
}

template <class Body>
double leastMs(int times, const Body& body) {
    double least = INFINITY;
    for (int i = 0; i < times; ++i) {
        const double begin = cpuMs();
        body(i);
        least = std::min(least, cpuMs() - begin);
    }
    return least;
}

Vec3 dented(Vec3 unit, double radius) {
    return radius * (1 + 0.2 * std::sin(5 * unit.x + 1) * std::sin(4 * unit.y) * std::sin(6 * unit.z + 2)) * unit;
}

Profile profileOf(const char* material) {
    const Model model = loadModel("dipole");
    const auto evaluator = makeNativeEvaluator(model);
    const Medium medium = findMaterial(material).medium;
    evaluator->set(medium, {});
    return tabulate(*evaluator, model, medium).profile;
}

struct Case {
    double radius_mm = 10;
    std::size_t points = 200'000;
    int side = 640;  // of a square picture: a fourth less are covered
    double error = 0.005;
};

struct Cost {
    double tree_ms = 0, light_ms = 0, frame_ms = 0;
    std::size_t receivers = 0;
    double megabytes = 0;
};

// Pixels in blocks of 8 x 8, seen by a camera that was turned by that angle.
std::vector<Vec3f> pixels(const Case& c, double angle) {
    std::vector<Vec3f> receivers;
    for (int tile = 0; tile < c.side * c.side / 64; ++tile)
        for (int i = 0; i < 64; ++i) {
            const double x = 8 * (tile % (c.side / 8)) + i % 8, y = 8 * (tile / (c.side / 8)) + i / 8;
            const double u = (x + 0.5) / c.side * 2.04 - 1.02, v = 1.02 - (y + 0.5) / c.side * 2.04;
            const double w = 1 - u * u - v * v;
            if (w <= 0) continue;
            const double z = std::sqrt(w), cosine = std::cos(angle), sine = std::sin(angle);
            receivers.push_back(toFloat(dented({cosine * u + sine * z, v, cosine * z - sine * u}, c.radius_mm)));
        }
    return receivers;
}

Cost measure(const Case& c, const Profile& profile) {
    PointCloud cloud;
    std::vector<Rgbf> transmitted;
    const Vec3 lamp = normalize(Vec3{1, 1, 1});
    for (std::size_t i = 0; i < c.points; ++i) {
        const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(c.points);
        const double ring = std::sqrt(1 - z * z), turn = 2.399963229728653 * static_cast<double>(i);
        const Vec3 unit{ring * std::cos(turn), ring * std::sin(turn), z};
        cloud.positions.push_back(toFloat(dented(unit, c.radius_mm)));
        cloud.areas.push_back(
            static_cast<float>(4 * std::numbers::pi * c.radius_mm * c.radius_mm / static_cast<double>(c.points)));
        const auto cosine = static_cast<float>(std::max(0.0, dot(unit, lamp)));
        transmitted.push_back({cosine, cosine, cosine});
    }
    Cost cost;
    std::optional<PointTree> tree;
    cost.tree_ms = leastMs(1, [&](int) { tree.emplace(cloud, 1); });
    cost.light_ms = leastMs(3, [&](int) { tree->setTransmitted(transmitted, 1); });
    const RadialTable table(profile, tree->meanArea());
    SumCalibration calibration;
    SumMemory memory;
    const SumOptions options{.error = c.error, .threads = 1, .calibration = &calibration, .memory = &memory};
    std::vector<Rgbf> exitance;
    std::vector<std::vector<Vec3f>> views;
    for (int i = 0; i < 4; ++i) views.push_back(pixels(c, 0.02 * i));
    sumExitance(*tree, table, ReceiverTree(views.back(), 1), options, exitance);
    cost.frame_ms = leastMs(3, [&](int i) {
        sumExitance(*tree, table, ReceiverTree(views[static_cast<std::size_t>(i)], 1), options, exitance);
    });
    cost.receivers = views[0].size();
    cost.megabytes = static_cast<double>(usage().ru_maxrss) / 1024;
    return cost;
}

struct Curve {
    const char* id;
    const char* title;
    Axis x;
    std::vector<double> at;
    std::function<Case(double)> make;
    std::function<double(double, const Cost&)> place;  // on the x axis
};

void draw(const Curve& curve, const std::filesystem::path& folder) {
    Figure figure{.title = curve.title,
                  .caption =
                      "CPU time of one core for a frame's sum after the camera moved (receivers' tree, sum, its "
                      "judgement). Dented sphere under one lamp; unless varied 10 mm radius, 200,000 points, "
                      "309,000 pixels, 0.5 % error.",
                  .x = curve.x,
                  .y = {.label = "CPU time", .unit = "ms", .scale = AxisScale::logarithmic}};
    Series tree{.label = "tree of the points, once per object", .color = -1, .dashed = true};
    Series light{.label = "moments of a new light", .color = -1};
    for (std::size_t m = 0; m < std::size(materials); ++m) {
        const Profile profile = profileOf(materials[m]);
        Series series{.label = materials[m], .color = colors[m]};
        for (const double value : curve.at) {
            const Cost cost = measure(curve.make(value), profile);
            const double x = curve.place(value, cost);
            series.x.push_back(x);
            series.y.push_back(cost.frame_ms);
            // What depends on no material is measured with each: the lesser of both counts.
            if (m == 0) {
                for (Series* once : {&tree, &light}) {
                    once->x.push_back(x);
                    once->y.push_back(INFINITY);
                }
            }
            const std::size_t i = series.x.size() - 1;
            tree.y[i] = std::min(tree.y[i], cost.tree_ms);
            light.y[i] = std::min(light.y[i], cost.light_ms);
            fmt::print(
                "{} {} {:.4g}: tree {:.1f} ms, light {:.1f} ms, frame {:.1f} ms, {} receivers, up to {:.0f} MiB so "
                "far\n",
                curve.id, materials[m], x, cost.tree_ms, cost.light_ms, cost.frame_ms, cost.receivers, cost.megabytes);
            std::fflush(stdout);
        }
        figure.series.push_back(std::move(series));
    }
    if (std::string_view(curve.id) == "points") {
        figure.series.push_back(std::move(tree));
        figure.series.push_back(std::move(light));
    }
    for (const char* ending : {".svg", ".csv"}) drawFigure(figure, folder / (std::string("cost_") + curve.id + ending));
}

int main(int argc, char** argv) {
    if (argc != 2) {
        fmt::print(stderr, "cost_bench FOLDER\n");
        return 2;
    }
    const auto logarithmic = [](const char* label, const char* unit) {
        return Axis{.label = label, .unit = unit, .scale = AxisScale::logarithmic};
    };
    const auto itself = [](double value, const Cost&) { return value; };
    const Curve curves[] = {
        {"pixels",
         "A frame by its pixels",
         logarithmic("Covered pixels", ""),
         {80, 160, 320, 640, 1280, 2240},
         [](double side) { return Case{.side = static_cast<int>(side)}; },
         [](double, const Cost& cost) { return static_cast<double>(cost.receivers); }},
        {"error",
         "A frame by its error",
         logarithmic("Relative RMSE asked for", ""),
         {0.0002, 0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05},
         [](double error) { return Case{.error = error}; },
         itself},
        {"size",
         "A frame by the object's size",
         logarithmic("Radius", "mm"),
         {1, 2.5, 5, 10, 20, 40, 80, 160},
         [](double radius) { return Case{.radius_mm = radius}; },
         itself},
        {"points",
         "A frame by its points",
         logarithmic("Points", ""),
         {1e4, 3e4, 1e5, 3e5, 1e6, 3e6, 1e7},
         [](double points) { return Case{.points = static_cast<std::size_t>(points)}; },
         itself},
    };
    std::filesystem::create_directories(argv[1]);
    for (const Curve& curve : curves) draw(curve, argv[1]);
    return 0;
}

}  // namespace
}  // namespace searchlight

int main(int argc, char** argv) { return searchlight::main(argc, argv); }
