// What compute and raster programs share: shader text becomes a program with uniforms. Internal to this folder.
#pragma once

#include <cstddef>
#include <initializer_list>

#include "base/vec.h"
#include "gl/buffer.h"
#include "gl/source.h"
#include "gl/texture.h"

namespace searchlight::gl {

/// A buffer at a binding point of the shader.
struct Binding {
    unsigned point;
    const Buffer& buffer;
};

class LinkedProgram {
public:
    LinkedProgram(const LinkedProgram&) = delete;
    LinkedProgram& operator=(const LinkedProgram&) = delete;

    /// Sets a uniform (bool, int, uint: the first two). One that the shader does not use is passed over.
    void set(const char* uniform, int value);
    void set(const char* uniform, float value);
    void set(const char* uniform, const Rgb& value);
    void set(const char* uniform, const Vec3& value);

    /// Bytes that the shader's buffer block of that name needs; 0 when the shader does not use it.
    std::size_t blockSize(const char* block) const;

protected:
    /// A shader stage, as GL counts them, and its text.
    struct Stage {
        unsigned kind;
        const Source& source;
    };

    /// Compiles and links. Throws an input Error at the file, line and column of the first thing that the driver
    /// rejects; an error of linking stands in the last stage.
    LinkedProgram(Context& context, std::initializer_list<Stage> stages);
    ~LinkedProgram();

    /// Makes the program and what it reads current.
    void use(std::initializer_list<Binding> buffers, std::initializer_list<TextureBinding> textures);

    Context& context_;
    unsigned handle_ = 0;
};

}  // namespace searchlight::gl
