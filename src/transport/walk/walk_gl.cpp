#include "transport/walk/walk_gl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "base/embedded.h"
#include "base/ranks.h"
#include "gl/buffer.h"
#include "gl/context.h"
#include "gl/program.h"
#include "transport/walk/long_walk.h"

namespace searchlight {

namespace {

constexpr unsigned kGroup = 64;            // local_size_x
constexpr double kSlice_ms = 20;           // of a dispatch
constexpr int kMostSteps = 1 << 15;        // llvmpipe ends all loops of an invocation after 65,535 iterations
constexpr std::uint32_t kFewestSlots = 8;  // chunks are asked for at most 4 from their order
constexpr std::uint32_t kWalksAhead = 16;  // per lane: what the longest walk of a chunk is given time for
constexpr float kEndless = 1e38f;          // thickness
constexpr std::size_t kRuns = 5;           // words of an end

// As the shader has them, std430.
struct Layer {
    float mfp, thickness, g, eta_up, eta_down;
    std::uint32_t absorbed;
    float unused[2];
};
struct Slot {
    std::uint32_t walks, chunk_low, chunk_high, unused;
};
using Texel = std::array<float, 4>;
constexpr std::size_t kLaneBytes = 4 * sizeof(Texel);

gl::Source source(bool ball) {
    gl::Source source;
    source.add("#version 450 core", "searchlight");
    if (ball) source.add("#define BALL", "searchlight");
    for (const std::string_view file : {"physics/fresnel.glsl", "physics/scatter.glsl",
                                        "src/transport/walk/philox.glsl", "src/transport/walk/walk.comp.glsl"})
        source.add(embeddedText(file).value(), file);
    return source;
}

std::vector<Layer> layersOf(const WalkGlPlace& place) {
    std::vector<Layer> layers;
    for (const WalkGlPlace::Layer& from : place.layers)
        layers.push_back({static_cast<float>(from.mfp),
                          std::isinf(from.thickness) ? kEndless : static_cast<float>(from.thickness),
                          static_cast<float>(from.g),
                          static_cast<float>(from.eta_up),
                          static_cast<float>(from.eta_down),
                          static_cast<std::uint32_t>(std::min(std::llround(from.absorbed * 0x1p32), 0xFFFFFFFFll)),
                          {}});
    return layers;
}

}  // namespace

struct WalkGl::Impl {
    gl::Context& context;
    WalkGlPlace place;
    std::uint64_t seed;
    Chunks chunks;
    ChunkFunction chunkOf;

    int chunk_bits;       // a chunk has a run of 2^chunk_bits numbers, of which it may use fewer
    std::uint32_t slots;  // a power of 2, so that numbers may wrap
    unsigned lanes;
    std::uint64_t opened = 0;    // chunks, in their order
    std::uint64_t taken = 0;     // chunks whose ends were taken, before the first that was not
    std::vector<bool> is_taken;  // per slot, of chunks from `taken` on
    std::vector<Slot> info;
    std::vector<std::uint32_t> ended;     // per slot, as the device counts them
    std::vector<std::uint32_t> expected;  // of those, when all have ended
    int steps = 64;

    gl::Program program;
    gl::Buffer lane_buffer, slot_buffer, counter_buffer, end_buffer, layer_buffer, start_buffer;

    Impl(gl::Context& context_, const WalkGlPlace& place_, std::uint64_t seed_, const Chunks& chunks_,
         ChunkFunction chunkOf_)
        : context(context_),
          place(place_),
          seed(seed_),
          chunks(chunks_),
          chunkOf(std::move(chunkOf_)),
          chunk_bits(std::bit_width(chunks.largest - 1)),
          lanes(context.info().hardware ? 1u << 17 : 1u << 12),
          program(context, source(place.ball_radius > 0)),
          lane_buffer(context),
          slot_buffer(context),
          counter_buffer(context),
          end_buffer(context),
          layer_buffer(context),
          start_buffer(context) {
        assert(chunks.largest >= 1 && chunks.step >= 1 && !place.layers.empty());
        slots = std::max(kFewestSlots, std::bit_ceil(kWalksAhead * lanes) >> chunk_bits);
        is_taken.assign(slots, false);
        info.resize(slots);
        ended.resize(slots);
        expected.resize(slots);
        lane_buffer.reserve(lanes * kLaneBytes);
        slot_buffer.reserve(slots * sizeof(Slot));
        counter_buffer.reserve((1 + slots) * sizeof(std::uint32_t));
        end_buffer.reserve(kRuns * slots * run() * sizeof(std::uint32_t));
        start_buffer.reserve(place.ball_radius > 0 ? 2 * slots * run() * sizeof(Texel) : sizeof(Texel));
        const std::vector<Layer> layers = layersOf(place);
        layer_buffer.reserve(layers.size() * sizeof(Layer));
        layer_buffer.upload(std::span<const Layer>(layers));
    }

    std::size_t run() const { return std::size_t{1} << chunk_bits; }
    std::uint64_t numberOf(std::uint64_t order) const { return chunks.first + order * chunks.step; }
    std::uint64_t count() const {
        return chunks.end > chunks.first ? (chunks.end - chunks.first + chunks.step - 1) / chunks.step : 0;
    }

    // Lets walks of further chunks begin, as far as the ring has room.
    void open() {
        const std::uint64_t before = opened;
        for (; opened < count() && opened < taken + slots; ++opened) {
            const std::uint64_t chunk = numberOf(opened);
            const auto at = static_cast<std::size_t>(opened % slots);
            const WalkGlChunk content = chunkOf(chunk);
            assert(content.walks <= run());
            info[at] = {content.walks, static_cast<std::uint32_t>(chunk), static_cast<std::uint32_t>(chunk >> 32), 0};
            expected[at] += static_cast<std::uint32_t>(run());
            is_taken[at] = false;
            std::vector<Texel> starts;
            for (const WalkGlStart& start : content.starts) {
                starts.push_back({start.position.x, start.position.y, start.position.z, 0});
                starts.push_back({start.direction.x, start.direction.y, start.direction.z, 0});
            }
            start_buffer.upload(std::span<const Texel>(starts), 2 * at * run() * sizeof(Texel));
        }
        if (opened > before) slot_buffer.upload(std::span<const Slot>(info));
    }

    void setUniforms() {
        program.set("lane_count", static_cast<int>(lanes));
        program.set("chunk_bits", chunk_bits);
        program.set("slot_mask", static_cast<int>(slots - 1));
        program.set("seed_low", static_cast<int>(static_cast<std::uint32_t>(seed)));
        program.set("seed_high", static_cast<int>(static_cast<std::uint32_t>(seed >> 32)));
        program.set("layer_count", static_cast<int>(place.layers.size()));
        program.set("first_layer", static_cast<int>(place.first_layer));
        program.set("sin_beam", static_cast<float>(place.sin_beam));
        program.set("cos_beam", static_cast<float>(place.cos_beam));
        program.set("radius", static_cast<float>(place.ball_radius));
        // In a ball every walk comes to an end.
        program.set("long_walk", place.ball_radius > 0 ? 0x7FFFFFFF : kLongWalk);
        program.set("endless_walk", kEndlessWalk);
        program.set("steps", steps);
        program.set("limit", static_cast<int>(static_cast<std::uint32_t>(opened << chunk_bits)));
    }

    void dispatch() {
        const double begin = context.finish();
        setUniforms();
        program.dispatch({(lanes + kGroup - 1) / kGroup}, {{0, lane_buffer},
                                                           {1, slot_buffer},
                                                           {2, counter_buffer},
                                                           {3, end_buffer},
                                                           {4, layer_buffer},
                                                           {5, start_buffer}});
        const double ms = context.finish() - begin;
        counter_buffer.download(std::span(ended), sizeof(std::uint32_t));
        const double fitting = steps * kSlice_ms / std::max(ms, 0.1);
        steps = std::clamp(static_cast<int>(std::min(fitting, 2.0 * steps)), 16, kMostSteps);
    }

    WalkGlEnds ends(std::uint64_t chunk) {
        assert(chunk >= chunks.first && (chunk - chunks.first) % chunks.step == 0);
        const std::uint64_t order = (chunk - chunks.first) / chunks.step;
        open();
        assert(order >= taken && order < opened);
        const auto at = static_cast<std::size_t>(order % slots);
        while (ended[at] != expected[at]) dispatch();
        std::vector<std::uint32_t> words(kRuns * run());
        end_buffer.download(std::span(words), at * words.size() * sizeof(std::uint32_t));
        is_taken[at] = true;
        for (; taken < opened && is_taken[static_cast<std::size_t>(taken % slots)]; ++taken)
            is_taken[static_cast<std::size_t>(taken % slots)] = false;

        WalkGlEnds result;
        const std::size_t walks = info[at].walks;
        const auto runOf = [&](std::size_t i) { return std::span(words).subspan(i * run(), walks); };
        const auto toFloats = [&](std::size_t i) {
            std::vector<float> values;
            values.reserve(walks);
            for (const std::uint32_t word : runOf(i)) values.push_back(std::bit_cast<float>(word));
            return values;
        };
        result.x = toFloats(0);
        result.y = toFloats(1);
        result.z = toFloats(2);
        result.collisions.assign(runOf(3).begin(), runOf(3).end());
        result.fates.assign(runOf(4).begin(), runOf(4).end());
        return result;
    }
};

WalkGl::WalkGl(gl::Context& context, const WalkGlPlace& place, std::uint64_t seed, const Chunks& chunks,
               ChunkFunction chunkOf)
    : impl_(std::make_unique<Impl>(context, place, seed, chunks, std::move(chunkOf))) {}
WalkGl::~WalkGl() = default;

WalkGlEnds WalkGl::ends(std::uint64_t chunk) { return impl_->ends(chunk); }
std::string WalkGl::device() const { return "GL " + impl_->context.info().renderer; }

WalkGl::Chunks chunksOnGl(const WalkControl& control, std::uint64_t chunks, std::uint64_t largest) {
    WalkGl::Chunks share{.end = chunks, .largest = static_cast<std::uint32_t>(largest)};
    if (control.state && !control.state->empty()) share.first = control.state->chunks;
    if (control.share) {
        share.first += static_cast<std::uint64_t>(rank());
        share.step = static_cast<std::uint64_t>(rankCount());
    }
    return share;
}

}  // namespace searchlight
