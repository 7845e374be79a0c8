// Meshes from memory, beside one pass over the same bytes: bin/shape_bench. 500,000 triangles each.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "io/shape_file.h"
#include "io/shape_formats.h"

namespace searchlight {
namespace {

// A wavy square: 250,000 positions without short decimals.
Mesh wavySquare(bool normals) {
    constexpr std::uint32_t n = 500;
    Mesh mesh;
    for (std::uint32_t i = 0; i <= n; ++i)
        for (std::uint32_t j = 0; j <= n; ++j) {
            mesh.positions.push_back(toFloat(Vec3{i / 3.0, j / 7.0, std::sin(0.1 * i) * std::cos(0.2 * j)}));
            if (normals) mesh.normals.push_back({0, 0, 1});
        }
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
            mesh.triangles.push_back({a, b, a + 1});
            mesh.triangles.push_back({b, b + 1, a + 1});
        }
    return mesh;
}

std::string stlBytes(const Mesh& mesh) {
    std::string bytes(80, '\0');
    const auto append = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
    append(static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
        append(Vec3f{0, 0, 1});
        for (const std::uint32_t vertex : triangle) append(mesh.positions[vertex]);
        append(std::uint16_t{0});
    }
    return bytes;
}

void parse(benchmark::State& state, const std::string& bytes, const std::string& path) {
    for (auto _ : state) benchmark::DoNotOptimize(parseShape(bytes, path));
    state.SetBytesProcessed(static_cast<std::int64_t>(bytes.size()) * state.iterations());
}

void countLines(benchmark::State& state, const std::string& bytes) {
    for (auto _ : state) benchmark::DoNotOptimize(std::count(bytes.begin(), bytes.end(), '\n'));
    state.SetBytesProcessed(static_cast<std::int64_t>(bytes.size()) * state.iterations());
}

}  // namespace
}  // namespace searchlight

int main(int argc, char** argv) {
    using namespace searchlight;
    const std::string obj = objBytes(wavySquare(false)), obj_normals = objBytes(wavySquare(true));
    const std::string ply = plyBytes(wavySquare(false)), stl = stlBytes(wavySquare(false));
    const auto add = [](const char* name, auto run) {
        benchmark::RegisterBenchmark(name, run)->Unit(benchmark::kMillisecond);
    };
    add("lines of the OBJ counted", [&](benchmark::State& state) { countLines(state, obj); });
    add("OBJ", [&](benchmark::State& state) { parse(state, obj, "a.obj"); });
    add("OBJ with normals", [&](benchmark::State& state) { parse(state, obj_normals, "a.obj"); });
    add("PLY", [&](benchmark::State& state) { parse(state, ply, "a.ply"); });
    add("STL", [&](benchmark::State& state) { parse(state, stl, "a.stl"); });
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
