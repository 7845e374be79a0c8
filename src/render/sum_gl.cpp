#include "render/sum_gl.h"

#include <fmt/format.h>

#include <cassert>

#include "base/embedded.h"
#include "gl/context.h"
#include "render/radial_table_gl.h"

namespace searchlight {

namespace {

constexpr std::size_t receivers_per_group = 8;
constexpr int levels_per_pass = 3;  // a group has eight subgroups in the next pass

}  // namespace

void TableGl::upload(gl::Context& context, std::span<const std::array<float, 4>> texels) {
    fill(buffer, texels);
    texture.emplace(context, buffer, gl::Format::rgba32f);
}

gl::Source hierarchicalPassGl(std::string_view file) {
    gl::Source source;
    source.add(fmt::format("#version 450 core\n#define TABLE_SHIFT {}", 23 - RadialTableGl::bits), "searchlight");
    for (const std::string_view part : {std::string_view("src/render/hierarchical_gl.glsl"), file})
        source.add(embeddedText(part).value(), part);
    return source;
}

SumGl::SumGl(gl::Context& context)
    : context_(context), group_spheres_(context), group_begins_(context), receivers_(context) {}

void SumGl::setReceivers(std::span<const Vec3f> receivers, int threads) {
    assert(!receivers.empty());
    receiver_tree_ = buildHeapTree(receivers, receivers_per_group, threads);
    group_spheres_.upload(context_, receiver_tree_.spheres);
    fill<int>(group_begins_, begins(receiver_tree_));
    receiver_texels_.clear();
    receiver_texels_.reserve(receivers.size());
    for (const std::uint32_t i : receiver_tree_.order)
        receiver_texels_.push_back({receivers[i].x, receivers[i].y, receivers[i].z, 0});
    fill<std::array<float, 4>>(receivers_, receiver_texels_);
    levels_.clear();
    for (int level = receiver_tree_.depth; level >= 0; level -= levels_per_pass) {
        if (!levels_.empty() && receivers.size() >> level > receiversPerSlice()) break;
        levels_.insert(levels_.begin(), level);
    }
}

std::pair<std::size_t, std::size_t> SumGl::receiversOf(int level, int group) const {
    const auto k = static_cast<std::size_t>(group);
    return {receiver_tree_.first(level, k), receiver_tree_.first(level, k + 1)};
}

unsigned SumGl::workGroups(std::size_t invocations) {
    return static_cast<unsigned>((invocations + group_size - 1) / group_size);
}

std::vector<int> SumGl::begins(const HeapTree& tree) {
    std::vector<int> list((std::size_t{1} << tree.depth) + 1);
    for (std::size_t k = 0; k < list.size(); ++k) list[k] = static_cast<int>(tree.first(tree.depth, k));
    return list;
}

int SumGl::slots() const {
    const std::size_t groups = std::size_t{1} << receiver_tree_.depth;
    return static_cast<int>((receiver_tree_.order.size() + groups - 1) / groups);
}

void SumGl::setChains(gl::Program& program, const Chains& chains, int level) {
    program.set("level", level);
    program.set("chain_level", chains.level);
    program.set("chain_first", chains.first);
    program.set("chain_stride", chains.stride);
    program.set("two", 2);
}

}  // namespace searchlight
