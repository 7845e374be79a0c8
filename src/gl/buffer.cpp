#include "gl/buffer.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <cassert>

#include "base/error.h"

namespace searchlight::gl {

Buffer::Buffer(Context& context, std::size_t bytes) : context_(context) {
    context_.makeCurrent();
    glCreateBuffers(1, &handle_);
    reserve(bytes);
}

Buffer::~Buffer() {
    // A context that was lost has taken it along.
    if (context_.tryMakeCurrent()) glDeleteBuffers(1, &handle_);
}

void Buffer::reserve(std::size_t bytes) {
    if (bytes <= bytes_) return;
    context_.makeCurrent();
    GLint64 largest = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
    if (bytes > static_cast<std::size_t>(largest))
        throw deviceError(
            fmt::format("a buffer of {} bytes is too large: the device binds at most {}", bytes, largest));
    glNamedBufferData(handle_, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_DRAW);
    glClearNamedBufferData(handle_, GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, nullptr);
    context_.checkpoint();
    bytes_ = bytes;
}

void Buffer::upload(std::span<const std::byte> bytes, std::size_t first_byte) {
    assert(first_byte + bytes.size() <= bytes_);
    if (bytes.empty()) return;
    context_.makeCurrent();
    glNamedBufferSubData(handle_, static_cast<GLintptr>(first_byte), static_cast<GLsizeiptr>(bytes.size()),
                         bytes.data());
}

void Buffer::download(std::span<std::byte> bytes, std::size_t first_byte) const {
    assert(first_byte + bytes.size() <= bytes_);
    if (bytes.empty()) return;
    context_.makeCurrent();
    glGetNamedBufferSubData(handle_, static_cast<GLintptr>(first_byte), static_cast<GLsizeiptr>(bytes.size()),
                            bytes.data());
    context_.checkpoint();
}

}  // namespace searchlight::gl
