#include "render/radial_sum_gl.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "gl/context.h"
#include "render/point_moments_gl.h"
#include "render/radial_table_gl.h"

namespace searchlight {

namespace {

using Texel = std::array<float, 4>;

constexpr std::size_t points_per_leaf = 8;
constexpr int list_part = 512;   // nodes of a list in one dispatch
constexpr int part_size = 1024;  // points in one invocation of the direct sum

Texel texel(Vec3f v) { return {v.x, v.y, v.z, 0}; }

}  // namespace

RadialSumGl::RadialSumGl(gl::Context& context)
    : SumGl(context),
      groups_(context, hierarchicalPassGl("src/render/hierarchical_gl.groups.comp.glsl")),
      receivers_pass_(context, hierarchicalPassGl("src/render/hierarchical_gl.receivers.comp.glsl")),
      direct_(context, hierarchicalPassGl("src/render/hierarchical_gl.direct.comp.glsl")),
      radial_(context),
      spheres_(context),
      moments_(context),
      points_(context),
      leaf_begins_(context),
      exitance_(context),
      counters_(context, 3 * sizeof(unsigned)),
      sums_(context),
      chosen_(context),
      even_(context),
      odd_(context) {}

void RadialSumGl::setPoints(const PointCloud& points, int threads) {
    assert(!points.positions.empty() && points.areas.size() == points.positions.size());
    positions_ = points.positions;
    areas_ = points.areas;
    area_mm2_ = std::accumulate(areas_.begin(), areas_.end(), 0.0);
    tree_ = buildHeapTree(positions_, points_per_leaf, threads);
    spheres_.upload(context_, tree_.spheres);
    fill<int>(leaf_begins_, begins(tree_));
    uploadPoints(std::vector<Rgb>(positions_.size()), threads);
}

void RadialSumGl::setTransmitted(std::span<const Rgbf> transmitted, int threads) {
    assert(transmitted.size() == positions_.size());
    std::vector<Rgb> flux(transmitted.size());
    for (std::size_t i = 0; i < flux.size(); ++i) flux[i] = double(areas_[i]) * toDouble(transmitted[i]);
    uploadPoints(flux, threads);
}

void RadialSumGl::uploadPoints(std::span<const Rgb> flux, int threads) {
    moments_.upload(context_, pointMomentsGl(tree_, positions_, flux, threads));
    std::vector<Texel> texels;
    texels.reserve(2 * flux.size());
    for (const std::uint32_t point : tree_.order) {
        const Rgbf f = toFloat(flux[point]);
        texels.push_back(texel(positions_[point]));
        texels.push_back({f.r, f.g, f.b, 0});
    }
    points_.upload(context_, texels);
}

void RadialSumGl::setProfile(const Profile& profile) {
    const double cell_area = area_mm2_ / static_cast<double>(positions_.size());
    const RadialTableGl table = makeRadialTableGl(RadialKernel(profile, cell_area), area_mm2_);
    table_entries_ = table.entries();
    table_first_bits_ = table.firstBits();
    table_offset_ = table.offset;
    radial_.upload(context_, table.texels);
}

void RadialSumGl::reserveLists(const Chains& chains) {
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        const auto groups = static_cast<std::size_t>(groupsOf(chains, levels_[i]));
        Level& level = i % 2 == 0 ? even_ : odd_;
        level.expansions.reserve(groups * 10 * sizeof(Texel));
        level.lists.reserve(groups * static_cast<std::size_t>(list_size_) * sizeof(int));
    }
}

void RadialSumGl::setCommon(gl::Program& program, const Chains& chains, int level, double error) {
    program.set("table_last", table_entries_ - 1);
    program.set("table_first_bits", table_first_bits_);
    program.set("table_offset", static_cast<float>(table_offset_));
    program.set("opening", static_cast<float>(std::cbrt(error)));
    setChains(program, chains, level);
    program.set("list_size", list_size_);
    program.set("leaf_begin", 1 << tree_.depth);
}

void RadialSumGl::runGroups(const Chains& chains, std::size_t index, double error) {
    const int groups = groupsOf(chains, levels_[index]);
    setCommon(groups_, chains, levels_[index], error);
    groups_.set("group_count", groups);
    groups_.set("parent_level", index > 0 ? levels_[index - 1] : -1);
    const Level& own = index % 2 == 0 ? even_ : odd_;
    const Level& parent = index % 2 == 0 ? odd_ : even_;
    groups_.dispatch(workGroups(static_cast<std::size_t>(groups)),
                     {{0, parent.expansions}, {1, parent.lists}, {2, own.expansions}, {3, own.lists}, {4, counters_}},
                     {{0, *radial_.texture},
                      {1, *spheres_.texture},
                      {2, *moments_.texture},
                      {3, *points_.texture},
                      {4, *group_spheres_.texture}});
}

void RadialSumGl::runReceivers(const Chains& chains, double error) {
    const int depth = receiver_tree_.depth;
    const int invocations = slots() * groupsOf(chains, depth);
    const Level& level = levels_.size() % 2 == 1 ? even_ : odd_;
    setCommon(receivers_pass_, chains, depth, error);
    receivers_pass_.set("slots", slots());
    receivers_pass_.set("receiver_count", invocations);
    for (int from = 0; from < list_size_; from += list_part) {
        receivers_pass_.set("list_from", from);
        receivers_pass_.set("list_to", from + list_part);
        receivers_pass_.dispatch(workGroups(static_cast<std::size_t>(invocations)),
                                 {{0, level.expansions},
                                  {1, level.lists},
                                  {2, receivers_},
                                  {3, exitance_},
                                  {4, counters_},
                                  {5, group_begins_},
                                  {6, leaf_begins_}},
                                 {{0, *radial_.texture},
                                  {1, *spheres_.texture},
                                  {2, *moments_.texture},
                                  {3, *points_.texture},
                                  {4, *group_spheres_.texture}});
    }
}

RadialSumGl::Work RadialSumGl::run(const Chains& chains, double error) {
    exitance_.reserve(3 * sizeof(float) * receiver_texels_.size());
    for (;;) {
        reserveLists(chains);
        std::array<unsigned, 3> counters{};
        counters_.upload<unsigned>(counters);
        for (std::size_t i = 0; i < levels_.size(); ++i) runGroups(chains, i, error);
        runReceivers(chains, error);
        counters_.download<unsigned>(counters);
        if (counters[0] == failed_loop)
            throw deviceError("the driver ended a loop of the hierarchical sum before its time",
                              "ask for a larger error, or use the CPU");
        if (counters[0] == 0) return {counters[1], counters[2]};
        list_size_ *= 2;
    }
}

std::vector<Rgbf> RadialSumGl::exitance(std::size_t first, std::size_t last) const {
    std::vector<Rgbf> values(last - first);
    exitance_.download<Rgbf>(values, first * sizeof(Rgbf));
    return values;
}

std::vector<Rgb> RadialSumGl::direct(std::span<const std::uint32_t> places) {
    std::vector<Texel> chosen;
    for (const std::uint32_t place : places) chosen.push_back(receiver_texels_[place]);
    fill<Texel>(chosen_, chosen);
    const std::size_t parts = (positions_.size() + part_size - 1) / part_size;
    std::vector<Texel> sums(places.size() * parts);
    sums_.reserve(sums.size() * sizeof(Texel));
    setCommon(direct_, {}, 0, 0);
    direct_.set("receiver_count", static_cast<int>(places.size()));
    direct_.set("point_count", static_cast<int>(positions_.size()));
    direct_.set("parts", static_cast<int>(parts));
    direct_.set("part_size", part_size);
    direct_.dispatch(workGroups(sums.size()), {{0, chosen_}, {1, sums_}},
                     {{0, *radial_.texture}, {3, *points_.texture}});
    sums_.download<Texel>(sums);
    std::vector<Rgb> totals(places.size());
    for (std::size_t i = 0; i < sums.size(); ++i)
        totals[i / parts] = totals[i / parts] + Rgb{sums[i][0], sums[i][1], sums[i][2]};
    return totals;
}

}  // namespace searchlight
