// What sums over points on a device have in common: receivers in groups, worked on in slices.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "base/vec.h"
#include "gl/buffer.h"
#include "gl/program.h"
#include "render/heap_tree.h"

namespace searchlight {

/// An array of texels that shaders read through a samplerBuffer.
struct TableGl {
    gl::Buffer buffer;
    std::optional<gl::BufferTexture> texture;

    explicit TableGl(gl::Context& context) : buffer(context) {}
    void upload(gl::Context& context, std::span<const std::array<float, 4>> texels);
};

/// Makes the buffer hold just these values, or more room.
template <typename T>
void fill(gl::Buffer& buffer, std::span<const T> values) {
    buffer.reserve(values.size_bytes());
    buffer.upload(values);
}

/// A pass of the hierarchical sums: src/render/hierarchical_gl.glsl, then that file.
gl::Source hierarchicalPassGl(std::string_view file);

class SumGl {
public:
    explicit SumGl(gl::Context& context);
    virtual ~SumGl() = default;
    SumGl(const SumGl&) = delete;
    SumGl& operator=(const SumGl&) = delete;

    /// At least one, mm.
    void setReceivers(std::span<const Vec3f> receivers, int threads);

    /// Groups of receivers, as a slice of work: those of level `level` that are numbered first, first + stride, ...
    struct Chains {
        int level = 0;
        int first = 0, stride = 1, count = 1;
    };
    struct Work {
        std::uint64_t expanded = 0, summed = 0;  ///< nodes; pairs of point and receiver
    };

    /// Levels whose groups are a slice of work, and the least that a pilot looks at.
    int coarseLevel() const { return levels_.front(); }
    int fineLevel() const { return levels_[levels_.size() > 1 ? levels_.size() - 2 : 0]; }
    static int groups(int level) { return 1 << level; }

    /// What a pilot compares: so many groups of the fine level, and receivers of each; and how many in one direct().
    struct Pilot {
        int groups = 32, receivers = 8, at_once = 32;
    };
    virtual Pilot pilot() const { return {}; }

    /// Sums for the receivers of those groups, and waits. The error of the result grows with `error`, by which a term
    /// may be wrong relative to what stands there; with 0 nothing is gathered. Throws a device Error when the driver
    /// gives a loop up.
    virtual Work run(const Chains& chains, double error) = 0;

    /// The full sum for some places in the receivers' tree: few at a time.
    virtual std::vector<Rgb> direct(std::span<const std::uint32_t> places) = 0;

    /// What run() has summed for places [first, last) of the tree.
    virtual std::vector<Rgbf> exitance(std::size_t first, std::size_t last) const = 0;

    /// Receivers of a group, as places in the receivers' tree, and the receiver at each place.
    std::pair<std::size_t, std::size_t> receiversOf(int level, int group) const;
    std::span<const std::uint32_t> order() const { return receiver_tree_.order; }

protected:
    static constexpr unsigned group_size = 64;  // local_size_x of the passes
    static constexpr unsigned failed_list = 1, failed_loop = 2;

    static unsigned workGroups(std::size_t invocations);
    static std::vector<int> begins(const HeapTree& tree);

    /// Largest number of receivers in a group of the coarsest level.
    virtual std::size_t receiversPerSlice() const = 0;

    int groupsOf(const Chains& chains, int level) const { return chains.count << std::max(0, level - chains.level); }
    int slots() const;  // receivers of the largest group of the finest level
    static void setChains(gl::Program& program, const Chains& chains, int level);

    gl::Context& context_;
    TableGl group_spheres_;
    gl::Buffer group_begins_, receivers_;
    HeapTree receiver_tree_;
    std::vector<std::array<float, 4>> receiver_texels_;
    std::vector<int> levels_;  // of the receivers' tree that are visited, from coarse to fine
};

}  // namespace searchlight
