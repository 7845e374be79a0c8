#include "gl/texture.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>

#include "base/error.h"

namespace searchlight::gl {

namespace {

struct GlFormat {
    GLenum internal, layout, type;
    std::size_t bytes;
};

GlFormat glFormat(Format format) {
    switch (format) {
        case Format::r32f: return {GL_R32F, GL_RED, GL_FLOAT, 4};
        case Format::r32ui: return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4};
        case Format::depth32f: return {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4};
        case Format::rgba32f: break;
    }
    return {GL_RGBA32F, GL_RGBA, GL_FLOAT, 16};
}

GLint limit(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

}  // namespace

std::size_t bytesOf(Format format) { return glFormat(format).bytes; }

Texture::Texture(Context& context, const TextureOptions& options) : context_(context), options_(options) {
    assert(options.width > 0 && options.height > 0 && options.layers > 0);
    assert(!options.cube || (options.width == options.height && options.layers == 1));
    context_.makeCurrent();
    const int largest = limit(options.cube ? GL_MAX_CUBE_MAP_TEXTURE_SIZE : GL_MAX_TEXTURE_SIZE);
    if (std::max(options.width, options.height) > largest || options.layers > limit(GL_MAX_ARRAY_TEXTURE_LAYERS))
        throw deviceError(fmt::format("a texture of {} x {} x {} is too large: the device takes at most {} a side",
                                      options.width, options.height, options.layers, largest));
    const GLenum target = options.cube ? GL_TEXTURE_CUBE_MAP : options.layers > 1 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D;
    const GlFormat format = glFormat(options.format);
    const auto side = static_cast<unsigned>(std::max(options.width, options.height));
    const int levels = options.mipmaps ? static_cast<int>(std::bit_width(side)) : 1;
    glCreateTextures(target, 1, &handle_);
    if (options.layers > 1)
        glTextureStorage3D(handle_, levels, format.internal, options.width, options.height, options.layers);
    else
        glTextureStorage2D(handle_, levels, format.internal, options.width, options.height);
    if (options.format != Format::depth32f)
        for (int level = 0; level < levels; ++level)
            glClearTexImage(handle_, level, format.layout, format.type, nullptr);
    const GLint filter = options.linear ? GL_LINEAR : GL_NEAREST;
    const GLint smaller = options.linear ? GL_LINEAR_MIPMAP_LINEAR : GL_NEAREST_MIPMAP_NEAREST;
    glTextureParameteri(handle_, GL_TEXTURE_MAG_FILTER, filter);
    glTextureParameteri(handle_, GL_TEXTURE_MIN_FILTER, options.mipmaps ? smaller : filter);
    for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        glTextureParameteri(handle_, axis, options.repeat ? GL_REPEAT : GL_CLAMP_TO_EDGE);
    if (options.compare) {
        glTextureParameteri(handle_, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
        glTextureParameteri(handle_, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    }
    // Else filtering ends at the edges of a cube's faces, and shows them.
    if (options.cube) glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    context_.checkpoint();
}

Texture::~Texture() {
    // A context that was lost has taken it along.
    if (context_.tryMakeCurrent()) glDeleteTextures(1, &handle_);
}

void Texture::uploadBytes(std::span<const std::byte> bytes, int layer) {
    const GlFormat format = glFormat(options_.format);
    assert(layer < layers());
    assert(bytes.size() == format.bytes * options_.width * options_.height);
    context_.makeCurrent();
    if (layers() > 1)
        glTextureSubImage3D(handle_, 0, 0, 0, layer, options_.width, options_.height, 1, format.layout, format.type,
                            bytes.data());
    else
        glTextureSubImage2D(handle_, 0, 0, 0, options_.width, options_.height, format.layout, format.type,
                            bytes.data());
}

void Texture::update() {
    context_.makeCurrent();
    glGenerateTextureMipmap(handle_);
    context_.checkpoint();
}

void Texture::downloadBytes(std::span<std::byte> bytes) const {
    const GlFormat format = glFormat(options_.format);
    assert(bytes.size() == format.bytes * options_.width * options_.height * layers());
    context_.makeCurrent();
    glGetTextureImage(handle_, 0, format.layout, format.type, static_cast<GLsizei>(bytes.size()), bytes.data());
    context_.checkpoint();
}

BufferTexture::BufferTexture(Context& context, const Buffer& buffer, Format format) : context_(context) {
    context_.makeCurrent();
    const auto largest = static_cast<std::size_t>(limit(GL_MAX_TEXTURE_BUFFER_SIZE));
    const std::size_t texels = buffer.size() / bytesOf(format);
    if (texels > largest)
        throw deviceError(
            fmt::format("a table of {} entries is too large: the device addresses at most {}", texels, largest));
    glCreateTextures(GL_TEXTURE_BUFFER, 1, &handle_);
    glTextureBuffer(handle_, glFormat(format).internal, buffer.handle());
    context_.checkpoint();
}

BufferTexture::~BufferTexture() {
    if (context_.tryMakeCurrent()) glDeleteTextures(1, &handle_);
}

}  // namespace searchlight::gl
