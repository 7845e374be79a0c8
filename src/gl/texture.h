// Pictures and arrays that shaders look things up in.
#pragma once

#include <cstddef>
#include <span>

#include "gl/buffer.h"

namespace searchlight::gl {

enum class Format {
    r32f,     ///< one float
    rgba32f,  ///< four floats
    r32ui,    ///< one unsigned integer, never filtered
    depth32f  ///< what a draw keeps of the nearest fragment: 0 to 1
};

/// Bytes of a texel.
std::size_t bytesOf(Format format);

struct TextureOptions {
    Format format = Format::rgba32f;
    int width = 1, height = 1;  ///< equal for a cube
    int layers = 1;             ///< above 1: an array
    bool cube = false;          ///< six layers in GL's order: +x, -x, +y, -y, +z, -z
    bool mipmaps = false;       ///< down to one texel; update() fills them
    bool linear = false;        ///< filtered
    bool repeat = false;        ///< beyond the edges; else the edge's texel
    bool compare = false;       ///< depth only: sampler2DShadow, 1 where the reference is not behind
};

class Texture {
public:
    /// All zero (a depth: undefined until cleared). Throws a device Error beyond the device's sizes. The context
    /// outlives the texture.
    Texture(Context& context, const TextureOptions& options);
    ~Texture();
    Texture(const Texture&) = delete;
    Texture& operator=(const Texture&) = delete;

    int width() const { return options_.width; }
    int height() const { return options_.height; }
    unsigned handle() const { return handle_; }
    const TextureOptions& options() const { return options_; }

    /// Sets a layer of the largest level, row by row, the row of v = 0 first.
    template <typename T>
    void upload(std::span<const T> texels, int layer = 0) {
        uploadBytes(std::as_bytes(texels), layer);
    }

    /// Fills the smaller levels from the largest.
    void update();

    /// Waits for the device, then copies out the whole largest level, layer after layer.
    template <typename T>
    void download(std::span<T> texels) const {
        downloadBytes(std::as_writable_bytes(texels));
    }

private:
    void uploadBytes(std::span<const std::byte> bytes, int layer);
    void downloadBytes(std::span<std::byte> bytes) const;
    int layers() const { return options_.cube ? 6 : options_.layers; }

    Context& context_;
    TextureOptions options_;
    unsigned handle_ = 0;
};

/// A buffer read through a samplerBuffer (usamplerBuffer for r32ui): on some devices the fastest way to read an array.
class BufferTexture {
public:
    /// Sees the buffer as it is now: Buffer::reserve of more memory needs a new one. Throws a device Error for a buffer
    /// of more texels than the device addresses. The buffer outlives it.
    BufferTexture(Context& context, const Buffer& buffer, Format format);
    ~BufferTexture();
    BufferTexture(const BufferTexture&) = delete;
    BufferTexture& operator=(const BufferTexture&) = delete;

    unsigned handle() const { return handle_; }

private:
    Context& context_;
    unsigned handle_ = 0;
};

/// A texture at a unit of the shader: layout(binding = unit) uniform sampler...
struct TextureBinding {
    TextureBinding(unsigned unit_, const Texture& texture) : unit(unit_), handle(texture.handle()) {}
    TextureBinding(unsigned unit_, const BufferTexture& texture) : unit(unit_), handle(texture.handle()) {}

    unsigned unit;
    unsigned handle;
};

}  // namespace searchlight::gl
