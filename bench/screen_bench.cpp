// The filter of a picture: a kernel of 17 taps over a plane that fills 1920 x 1080 pixels, on one core, beside copying
// what a pass has to read and write. CPU time; the machine's other work shows in all of them alike, so take ratios.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/ground_truth.h"
#include "kernel/preintegrated.h"
#include "kernel/taps.h"
#include "model/evaluator.h"
#include "model/plane.h"
#include "render/screen/screen_filter.h"
#include "scene/materials.h"

namespace searchlight {
namespace {

constexpr int width = 1920, height = 1080;

// Tilted about a diagonal, lit in stripes.
struct Picture {
    View view{.width = width,
              .height = height,
              .eye = {0, 0, 200},
              .right = {1, 0, 0},
              .up = {0, 1, 0},
              .forward = {0, 0, -1},
              .tan_half = std::tan(15 * std::numbers::pi / 180)};
    VisibleSurface visible{.width = width, .height = height, .eye = view.eye};
    std::vector<Rgbf> light;
    ScreenSamples samples;

    Picture() {
        const Vec3 normal = normalize(Vec3{0.3, 0.4, 1});
        for (int tile = 0; tile < (width / 64) * ((height + 63) / 64); ++tile)
            for (int y = 64 * (tile / (width / 64)); y < std::min(height, 64 * (tile / (width / 64) + 1)); ++y)
                for (int x = 64 * (tile % (width / 64)); x < 64 * (tile % (width / 64) + 1); ++x) {
                    const Vec3 way = view.direction(x + 0.5, y + 0.5);
                    const Vec3 position = view.eye + (-dot(view.eye, normal) / dot(way, normal)) * way;
                    visible.pixels.push_back(static_cast<std::uint32_t>(y * width + x));
                    visible.coverage.push_back(1);
                    visible.positions.push_back(toFloat(position));
                    visible.normals.push_back(toFloat(normal));
                    visible.geometric_normals.push_back(toFloat(normal));
                    const float lit = std::sin(position.x) > 0 ? 1.0f : 0.1f;
                    light.push_back({lit, lit, lit});
                }
        samples = screenSamples(view, visible, 1);
    }
};

const Picture& picture() {
    static const Picture made;
    return made;
}

Taps tapsOf(const char* material, int count) {
    const Model model = loadModel("dipole");
    const auto evaluator = makeNativeEvaluator(model);
    const Medium medium = findMaterial(material).medium;
    evaluator->set(medium, {});
    const SeparableKernel kernel = preintegrated(GroundTruth(tabulate(*evaluator, model, medium).profile));
    return sampleTaps(kernel, quadraticOffsets(count, tapExtent(kernel)));
}

void perPixelAndPass(benchmark::State& state, std::size_t passes) {
    state.counters["per_pixel_and_pass"] =
        benchmark::Counter(static_cast<double>(picture().samples.count * passes),
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void filter(benchmark::State& state, FilterAxes axes, FilterTrust trust, int count) {
    const Taps taps = tapsOf("skin1", count);
    const ScreenFilterOptions options{.axes = axes, .trust = trust, .reach = 6, .threads = 1};
    ScreenFilter lanes;
    std::vector<Rgbf> result;
    lanes.filter(picture().samples, picture().light, taps, options, result);
    for (auto _ : state) lanes.filter(picture().samples, picture().light, taps, options, result);
    perPixelAndPass(state, 2);
}

// Position and normal of a sample, its light and its depth read, its light and the grid's written.
void copies(benchmark::State& state) {
    constexpr std::size_t read = 3 + 3 + 3 + 4, written = 3 + 3;
    const std::vector<float> from(picture().samples.count * read, 1.0f);
    std::vector<float> to(from.size());
    for (auto _ : state) {
        std::copy(from.begin(), from.end(), to.begin());
        benchmark::DoNotOptimize(to.data());
        benchmark::ClobberMemory();
    }
    static_assert(written < read);
    perPixelAndPass(state, 1);
}

void samplesOfAView(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(screenSamples(picture().view, picture().visible, 1));
    perPixelAndPass(state, 1);
}

void registerAll() {
    constexpr std::pair<const char*, FilterAxes> axes[] = {
        {"screen", FilterAxes::screen}, {"turned", FilterAxes::turned}, {"surface", FilterAxes::surface}};
    constexpr std::pair<const char*, FilterTrust> trusts[] = {
        {"all", FilterTrust::all}, {"depth", FilterTrust::depth}, {"distance", FilterTrust::distance}};
    for (const auto& [axes_name, along] : axes)
        for (const auto& [trust_name, trust] : trusts)
            for (const int count : {11, 17, 33})
                benchmark::RegisterBenchmark(fmt::format("{}_{}/{}", axes_name, trust_name, count).c_str(),
                                             [along = along, trust = trust, count](benchmark::State& state) {
                                                 filter(state, along, trust, count);
                                             });
    benchmark::RegisterBenchmark("samples_of_a_view", samplesOfAView);
    benchmark::RegisterBenchmark("copy", copies);
}

}  // namespace
}  // namespace searchlight

int main(int argc, char** argv) {
    searchlight::registerAll();
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
