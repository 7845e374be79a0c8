// A compute program.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string_view>

#include "base/vec.h"
#include "gl/buffer.h"
#include "gl/source.h"

namespace searchlight::gl {

/// A buffer at a binding point of the shader.
struct Binding {
    unsigned point;
    const Buffer& buffer;
};

class Program {
public:
    /// Compiles and links. Throws an input Error at the file, line and column of the first thing that the driver
    /// rejects. The context outlives the program.
    Program(Context& context, const Source& source);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    /// Sets a uniform (bool, int, uint: the first two). One that the shader does not use is passed over.
    void set(const char* uniform, int value);
    void set(const char* uniform, float value);
    void set(const char* uniform, const Rgb& value);

    /// Bytes that the shader's buffer block of that name needs; 0 when the shader does not use it.
    std::size_t blockSize(const char* block) const;

    /// Runs groups_x work groups over the buffers. Returns before they are done; Buffer::download waits. Throws what
    /// Context::checkpoint throws.
    void dispatch(unsigned groups_x, std::initializer_list<Binding> buffers);

private:
    Context& context_;
    unsigned handle_ = 0;
};

}  // namespace searchlight::gl
