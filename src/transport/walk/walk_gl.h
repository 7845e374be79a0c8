// The analogue walk on OpenGL: through plane layers or in a ball, with isotropic or Henyey-Greenstein scattering.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/vec.h"
#include "transport/walk/walk_state.h"

namespace searchlight {

namespace gl {
class Context;
}

/// Where walks go. Lengths are in any unit: that of the layers.
struct WalkGlPlace {
    struct Layer {
        double mfp = 1;       ///< a huge number where nothing happens
        double absorbed = 0;  ///< 1 - albedo
        double g = 0;
        double thickness = 1;             ///< infinity: the last layer has no lower surface
        double eta_up = 1, eta_down = 1;  ///< refractive index of this layer over those above and below
    };
    std::vector<Layer> layers;  ///< of a ball: one, whose eta_up is that over the outside
    std::size_t first_layer = 0;
    double sin_beam = 0, cos_beam = 1;  ///< of walks in layers, in the first of them; leans towards +x
    double ball_radius = 0;             ///< above 0: a ball about the origin instead of plane layers
};

/// Where a walk in a ball begins.
struct WalkGlStart {
    Vec3f position, direction;
};

/// A chunk to be walked: so many walks, in a ball one from each start.
struct WalkGlChunk {
    std::uint32_t walks = 0;
    std::vector<WalkGlStart> starts;
};

/// What became of the walks of a chunk; all spans have the same length.
struct WalkGlEnds {
    enum Fate {
        above,
        below,
        absorbed,
        killed
    };  ///< killed: by the roulette of long_walk.h; above: also out of a ball

    std::vector<float> x, y, z;            ///< z of exits from layers: cosine outside; of others: depth in the layer
    std::vector<std::int32_t> collisions;  ///< with the one that absorbed the walk
    std::vector<std::uint32_t> fates;

    std::size_t size() const { return x.size(); }
    Fate fate(std::size_t i) const { return static_cast<Fate>(fates[i] & 3u); }
    /// The layer that absorbed the walk; in a ball the number of its flights.
    std::uint32_t detail(std::size_t i) const { return fates[i] >> 2; }
};

/// Walks chunks. What becomes of a walk depends on the seed, its chunk, its place there and the device alone: neither
/// on how many lanes there are nor on when dispatches end. A dispatch takes some 20 ms, so that a desktop stays alive;
/// walks that are longer go on in the next, beside those of chunks to come.
class WalkGl {
public:
    using ChunkFunction = std::function<WalkGlChunk(std::uint64_t chunk)>;

    struct Chunks {
        std::uint64_t first = 0, step = 1;  ///< those that will be asked for: first, first + step, ...
        std::uint64_t end = 0;              ///< below this
        std::uint32_t largest = 1;          ///< walks in a chunk, at most
    };

    /// `chunkOf` is asked once for each chunk, in order, some ahead of ends(). The context outlives this. Throws a
    /// device Error when the device cannot hold it.
    WalkGl(gl::Context& context, const WalkGlPlace& place, std::uint64_t seed, const Chunks& chunks,
           ChunkFunction chunkOf);
    ~WalkGl();
    WalkGl(const WalkGl&) = delete;
    WalkGl& operator=(const WalkGl&) = delete;

    /// Walks until all walks of a chunk have ended. Each chunk once, at most 4 from their order.
    WalkGlEnds ends(std::uint64_t chunk);

    /// "GL llvmpipe (LLVM 15.0.6, 256 bits)".
    std::string device() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The chunks that this process walks: its share when processes share them, from where the saved sums end.
WalkGl::Chunks chunksOnGl(const WalkControl& control, std::uint64_t chunks, std::uint64_t largest);

}  // namespace searchlight
