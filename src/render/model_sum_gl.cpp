#include "render/model_sum_gl.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>

#include "base/embedded.h"
#include "base/error.h"
#include "gl/context.h"
#include "model/sum_model.h"
#include "render/radial_table_gl.h"

namespace searchlight {

namespace {

using Texel = std::array<float, 4>;

constexpr std::size_t points_per_leaf = 8;
// Entries of a list in one dispatch. Where the driver counts iterations, those of the model's loops count, too.
constexpr unsigned list_part = 4096, counted_list_part = 64;
constexpr int leaves_per_part = 32;  // of one invocation of the direct sum

Texel texel(Vec3f v, double w = 0) { return {v.x, v.y, v.z, static_cast<float>(w)}; }

gl::Source evaluateSource(const BssrdfFile& file, const LoopBudget& budget) {
    constexpr std::string_view path = "src/render/hierarchical_gl.model.comp.glsl";
    gl::Source source = modelShader(file, GlStage::functions, budget);
    source.add(file.normals ? "#define SL_SET_NORMALS(ni, no) Ni = ni; No = no;" : "#define SL_SET_NORMALS(ni, no)",
               "searchlight");
    source.add(embeddedText(path).value(), path);
    return source;
}

}  // namespace

ModelSumGl::ModelSumGl(gl::Context& context)
    : SumGl(context),
      lists_pass_(context, hierarchicalPassGl("src/render/hierarchical_gl.lists.comp.glsl")),
      radial_(context),
      spheres_(context),
      leaf_begins_(context),
      counters_(context, 3 * sizeof(unsigned)),
      lists_(context),
      values_(context),
      direct_values_(context),
      chosen_(context),
      budget_(loopBudget(context.info())),
      receiver_data_(context) {}

ModelSumGl::Part::Part(gl::Context& context, const BssrdfFile& file_, const LoopBudget& budget)
    : file(file_), evaluate(context, evaluateSource(file, budget)), state(context, 4) {
    if (!file.initializer.present()) return;
    init.emplace(context, modelShader(file, GlStage::init, budget));
    state.reserve(std::max(init->blockSize("sl_State"), evaluate.blockSize("sl_State")));
}

bool ModelSumGl::knows(std::span<const Model> parts) const {
    return std::ranges::equal(parts_, parts, [](const std::unique_ptr<Part>& known, const Model& part) {
        return known->file.path == part.file.path && known->file.shader.text == part.file.shader.text &&
               known->file.initializer.text == part.file.initializer.text;
    });
}

void ModelSumGl::setModel(const Model& model, const Medium& medium, const ParamValues& parameters,
                          const Profile& mean) {
    const std::span<const Model> parts = model.parts.empty() ? std::span(&model, 1) : std::span(model.parts);
    for (const Model& part : parts)
        if (part.measured)
            throw usageError(fmt::format("OpenGL cannot add the measured '{}' to models that read directions", part.id),
                             "--backend cpu can");
    if (!knows(parts)) {
        parts_.clear();
        for (const Model& part : parts) parts_.push_back(std::make_unique<Part>(context_, part.file, budget_));
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Part& part = *parts_[i];
        const ParamValues own = model.parts.empty() ? parameters : partParameters(model, parts[i], parameters);
        setModelUniforms(part.evaluate, part.file, medium, own);
        part.evaluate.set("sl_scatters", Vec3{medium.scatters(0) ? 1.0 : 0.0, medium.scatters(1) ? 1.0 : 0.0,
                                              medium.scatters(2) ? 1.0 : 0.0});
        if (!part.init) continue;
        setModelUniforms(*part.init, part.file, medium, own);
        direct_values_.reserve(4 * sizeof(float));
        part.init->dispatch(1, {{GlBinding::state, part.state}, {GlBinding::values, direct_values_}});
        checkLoops(part, direct_values_);
    }
    const RadialTableGl table =
        makeRadialTableGl(RadialKernel(mean, area_mm2_ / static_cast<double>(points_.positions.size())), area_mm2_);
    table_entries_ = table.entries();
    table_first_bits_ = table.firstBits();
    table_offset_ = table.offset;
    radial_.upload(context_, table.texels);
}

void ModelSumGl::setPoints(const PointCloud& points, int threads) {
    assert(!points.positions.empty() && points.areas.size() == points.positions.size() &&
           points.normals.size() == points.positions.size());
    points_ = points;
    area_mm2_ = std::accumulate(points.areas.begin(), points.areas.end(), 0.0);
    tree_ = buildHeapTree(points_.positions, points_per_leaf, threads);
    fill<int>(leaf_begins_, begins(tree_));
    beams_.clear();
}

void ModelSumGl::setLight(const Irradiance& irradiance, bool reads_wi, int threads) {
    beams_.clear();
    sphere_texels_ = tree_.spheres;
    if (!reads_wi)
        addBeam(modelPoints(points_, points_.normals, irradiance.transmitted), threads);
    else
        for (const searchlight::Beam& beam : irradiance.beams)
            addBeam(modelPoints(points_, beam.wi, beam.flux), threads);
    spheres_.upload(context_, sphere_texels_);
}

void ModelSumGl::addBeam(std::span<const ModelPoint> points, int threads) {
    auto beam = std::make_unique<Beam>(context_);
    const std::vector<ModelNode> nodes = modelNodes(tree_, points, threads);
    beam->nodes.upload(context_, modelNodesGl(nodes, threads));
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (isFolded(nodes[i])) sphere_texels_[i][3] = -1;
    std::vector<Texel> texels;
    texels.reserve(4 * points.size());
    for (const std::uint32_t i : tree_.order) {
        const ModelPoint& point = points[i];
        const Rgbf flux = toFloat(point.flux);
        texels.push_back(texel(points_.positions[i], leastDistance(points_.areas[i])));
        texels.push_back(texel(points_.normals[i]));
        texels.push_back(texel(toFloat(point.wi)));
        texels.push_back({flux.r, flux.g, flux.b, 0});
    }
    beam->points.upload(context_, texels);
    beams_.push_back(std::move(beam));
}

void ModelSumGl::setReceivers(const VisibleSurface& visible, int threads) {
    SumGl::setReceivers(visible.positions, threads);
    receivers_and_normals_.clear();
    receivers_and_normals_.reserve(2 * visible.positions.size());
    for (const std::uint32_t i : receiver_tree_.order) {
        receivers_and_normals_.push_back(texel(visible.positions[i]));
        receivers_and_normals_.push_back(texel(visible.normals[i]));
    }
    fill<Texel>(receiver_data_, receivers_and_normals_);
    eye_ = visible.eye;
    values_.reserve((1 + 3 * visible.positions.size()) * sizeof(float));
}

unsigned ModelSumGl::makeLists(const Chains& chains, double error, Work& work) {
    const int depth = receiver_tree_.depth;
    const auto groups = static_cast<std::size_t>(groupsOf(chains, depth));
    for (;;) {
        lists_.reserve(groups * static_cast<std::size_t>(list_size_) * sizeof(int));
        std::array<unsigned, 3> counters{};
        counters_.upload<unsigned>(counters);
        setChains(lists_pass_, chains, depth);
        lists_pass_.set("table_last", table_entries_ - 1);
        lists_pass_.set("table_first_bits", table_first_bits_);
        lists_pass_.set("table_offset", static_cast<float>(table_offset_));
        lists_pass_.set("opening", static_cast<float>(std::cbrt(error)));
        lists_pass_.set("group_count", static_cast<int>(groups));
        lists_pass_.set("list_size", list_size_);
        lists_pass_.set("leaf_begin", 1 << tree_.depth);
        lists_pass_.dispatch(workGroups(groups), {{0, lists_}, {1, counters_}},
                             {{0, *radial_.texture}, {1, *spheres_.texture}, {4, *group_spheres_.texture}});
        counters_.download<unsigned>(counters);
        if (counters[0] == failed_loop)
            throw deviceError("the driver ended a loop of the hierarchical sum before its time",
                              "ask for a larger error, or use the CPU");
        if (counters[0] == 0) {
            work.expanded = counters[2] * static_cast<std::uint64_t>(slots());
            return counters[1];
        }
        list_size_ *= 2;
    }
}

void ModelSumGl::dispatch(Part& part, std::size_t invocations, const gl::Buffer& receivers, const gl::Buffer& values) {
    part.evaluate.set("sl_count", static_cast<int>(invocations));
    part.evaluate.set("sl_eye", eye_);
    bool first = true;
    for (const auto& beam : beams_) {
        // Another part of the same lists adds to what is there.
        if (!first) part.evaluate.set("sl_first", 0);
        first = false;
        part.evaluate.dispatch(workGroups(invocations),
                               {{GlBinding::state, part.state},
                                {1, lists_},
                                {GlBinding::values, values},
                                {3, receivers},
                                {4, group_begins_},
                                {5, leaf_begins_}},
                               {{0, *beam->nodes.texture}, {1, *beam->points.texture}});
    }
}

void ModelSumGl::checkLoops(const Part& part, const gl::Buffer& values) {
    int failed = 0;
    values.download(std::span(&failed, 1));
    if (failed != 0) throw loopError(part.file, budget_, failed);
}

SumGl::Work ModelSumGl::run(const Chains& chains, double error) {
    Work work;
    const unsigned longest = makeLists(chains, error, work);
    const auto invocations = static_cast<std::size_t>(slots() * groupsOf(chains, receiver_tree_.depth));
    constexpr int good = 0;
    values_.upload(std::span(&good, 1));
    const unsigned step = budget_.driver_cuts ? counted_list_part : list_part;
    for (const auto& part : parts_) {
        part->evaluate.set("sl_direct", 0);
        part->evaluate.set("sl_slots", slots());
        part->evaluate.set("sl_list_size", list_size_);
        for (unsigned from = 0; from < longest; from += step) {
            part->evaluate.set("sl_from", static_cast<int>(from));
            part->evaluate.set("sl_to", static_cast<int>(from + step));
            part->evaluate.set("sl_first", from == 0 && part == parts_.front() ? 1 : 0);
            dispatch(*part, invocations, receiver_data_, values_);
        }
        checkLoops(*part, values_);
    }
    return work;
}

std::vector<Rgb> ModelSumGl::direct(std::span<const std::uint32_t> places) {
    std::vector<Texel> chosen;
    for (const std::uint32_t place : places)
        for (std::size_t k = 0; k < 2; ++k) chosen.push_back(receivers_and_normals_[2 * place + k]);
    fill<Texel>(chosen_, chosen);
    const int leaves = 1 << tree_.depth;
    const std::size_t slices = static_cast<std::size_t>((leaves + leaves_per_part - 1) / leaves_per_part);
    std::vector<float> values(1 + 3 * slices * places.size());
    lists_.reserve(sizeof(int));
    direct_values_.reserve(values.size() * sizeof(float));
    constexpr int good = 0;
    direct_values_.upload(std::span(&good, 1));
    for (const auto& part : parts_) {
        part->evaluate.set("sl_direct", static_cast<int>(places.size()));
        part->evaluate.set("sl_leaves", leaves);
        part->evaluate.set("sl_to", leaves_per_part);
        part->evaluate.set("sl_first", part == parts_.front() ? 1 : 0);
        dispatch(*part, slices * places.size(), chosen_, direct_values_);
        checkLoops(*part, direct_values_);
    }
    direct_values_.download<float>(values);
    std::vector<Rgb> sums(places.size());
    if (beams_.empty()) return sums;
    for (std::size_t i = 0; i < slices * places.size(); ++i) {
        Rgb& sum = sums[i % places.size()];
        sum = sum + Rgb{values[1 + 3 * i], values[2 + 3 * i], values[3 + 3 * i]};
    }
    return sums;
}

std::vector<Rgbf> ModelSumGl::exitance(std::size_t first, std::size_t last) const {
    std::vector<Rgbf> values(last - first);
    if (!beams_.empty()) values_.download<Rgbf>(values, sizeof(float) + first * sizeof(Rgbf));
    return values;
}

}  // namespace searchlight
