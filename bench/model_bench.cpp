// How long models take: batches of RGB queries native and on GL, tables, integrals. Run on an idle machine.
#include <benchmark/benchmark.h>

#include <memory>

#include "gl/context.h"
#include "model/evaluator.h"
#include "model/plane.h"

namespace searchlight {
namespace {

Medium skin() { return {{0.032, 0.17, 0.48}, {0.74, 0.88, 1.01}, {0, 0, 0}, 1.3, 3}; }

// `count` exits along a radius, 1e-3 to 30 mm.
std::vector<Query> radii(std::size_t count) {
    std::vector<Query> queries(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double r = 1e-3 * std::pow(3e4, static_cast<double>(i) / static_cast<double>(count - 1));
        queries[i] = {{}, {0, 0, 1}, {0, 0, 1}, {r, 0, 0}, {0, 0, 1}, {0, 0, 1}};
    }
    return queries;
}

void evaluate(benchmark::State& state, Evaluator& evaluator) {
    const std::vector<Query> queries = radii(4096);
    std::vector<Rgb> values(queries.size());
    evaluator.set(skin(), {});
    for (auto _ : state) {
        evaluator.evaluate(queries, values);
        benchmark::DoNotOptimize(values.data());
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(queries.size()));
}

void registerModel(const Model& model, gl::Context& context) {
    benchmark::RegisterBenchmark(("native_double/" + model.id).c_str(), [&model](benchmark::State& state) {
        evaluate(state, *makeNativeEvaluator(model, Precision::double_));
    });
    benchmark::RegisterBenchmark(("native_float/" + model.id).c_str(), [&model](benchmark::State& state) {
        evaluate(state, *makeNativeEvaluator(model, Precision::single_));
    });
    benchmark::RegisterBenchmark(("gl/" + model.id).c_str(), [&model, &context](benchmark::State& state) {
        evaluate(state, *makeGlEvaluator(model, context));
    })->UseRealTime();
    benchmark::RegisterBenchmark(("gl_compile/" + model.id).c_str(),
                                 [&model, &context](benchmark::State& state) {
                                     // A changed file: compile, init, one batch.
                                     const std::vector<Query> queries = radii(256);
                                     std::vector<Rgb> values(queries.size());
                                     for (auto _ : state) {
                                         const std::unique_ptr<Evaluator> evaluator = makeGlEvaluator(model, context);
                                         evaluator->set(skin(), {});
                                         evaluator->evaluate(queries, values);
                                     }
                                 })
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("tabulate/" + model.id).c_str(), [&model](benchmark::State& state) {
        const std::unique_ptr<Evaluator> evaluator = makeNativeEvaluator(model);
        evaluator->set(skin(), {});
        for (auto _ : state) benchmark::DoNotOptimize(tabulate(*evaluator, model, skin()));
    });
    benchmark::RegisterBenchmark(("total/" + model.id).c_str(), [&model](benchmark::State& state) {
        const std::unique_ptr<Evaluator> evaluator = makeNativeEvaluator(model);
        evaluator->set(skin(), {});
        for (auto _ : state) benchmark::DoNotOptimize(totalRd(*evaluator, model, skin()));
    });
}

}  // namespace
}  // namespace searchlight

int main(int argc, char** argv) {
    searchlight::gl::Context context;
    for (const searchlight::Model& model : searchlight::shippedModels()) searchlight::registerModel(model, context);
    const searchlight::Model sum = searchlight::loadModel("better_dipole+single");
    searchlight::registerModel(sum, context);
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
