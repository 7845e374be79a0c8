#include "gl/linked_program.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "gl/compile_log.h"

namespace searchlight::gl {

namespace {

// The first error of a log, where it stands in the user's file, and how many more there are.
Error rejection(std::string_view log, const Source& source) {
    const std::vector<CompileMessage> errors = compileErrors(log);
    if (errors.empty()) return inputError("the shader was rejected: " + std::string(trim(log)));
    const CompileMessage& first = errors.front();
    const SourcePlace place = source.place(first.line, first.column);
    const std::string more = errors.size() > 1 ? fmt::format("and {} more", errors.size() - 1) : "";
    return inputError(first.text, more).at(place.file, place.line, place.column);
}

struct Shader {
    GLuint handle;
    explicit Shader(GLenum kind) : handle(glCreateShader(kind)) {}
    ~Shader() { glDeleteShader(handle); }
    Shader(const Shader&) = delete;
    Shader& operator=(const Shader&) = delete;

    void compile(const Source& source) {
        const GLchar* text = source.text().c_str();
        glShaderSource(handle, 1, &text, nullptr);
        glCompileShader(handle);
        GLint good = 0, length = 0;
        glGetShaderiv(handle, GL_COMPILE_STATUS, &good);
        if (good) return;
        glGetShaderiv(handle, GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(length), '\0');
        glGetShaderInfoLog(handle, length, &length, log.data());
        throw rejection(std::string_view(log).substr(0, length), source);
    }
};

}  // namespace

LinkedProgram::LinkedProgram(Context& context, std::initializer_list<Stage> stages) : context_(context) {
    context_.makeCurrent();
    std::vector<std::unique_ptr<Shader>> shaders;
    for (const Stage& stage : stages) {
        shaders.push_back(std::make_unique<Shader>(stage.kind));
        shaders.back()->compile(stage.source);
    }
    handle_ = glCreateProgram();
    for (const auto& shader : shaders) glAttachShader(handle_, shader->handle);
    glLinkProgram(handle_);
    for (const auto& shader : shaders) glDetachShader(handle_, shader->handle);
    GLint good = 0, length = 0;
    glGetProgramiv(handle_, GL_LINK_STATUS, &good);
    if (!good) {
        glGetProgramiv(handle_, GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(length), '\0');
        glGetProgramInfoLog(handle_, length, &length, log.data());
        glDeleteProgram(handle_);
        throw rejection(std::string_view(log).substr(0, length), (stages.end() - 1)->source);
    }
    context_.checkpoint();
}

LinkedProgram::~LinkedProgram() {
    // A context that was lost has taken it along.
    if (context_.tryMakeCurrent()) glDeleteProgram(handle_);
}

void LinkedProgram::set(const char* uniform, int value) {
    context_.makeCurrent();
    glProgramUniform1i(handle_, glGetUniformLocation(handle_, uniform), value);
}

void LinkedProgram::set(const char* uniform, float value) {
    context_.makeCurrent();
    glProgramUniform1f(handle_, glGetUniformLocation(handle_, uniform), value);
}

void LinkedProgram::set(const char* uniform, const Rgb& value) { set(uniform, Vec3{value.r, value.g, value.b}); }

void LinkedProgram::set(const char* uniform, const Vec3& value) {
    context_.makeCurrent();
    const Vec3f single = toFloat(value);
    glProgramUniform3f(handle_, glGetUniformLocation(handle_, uniform), single.x, single.y, single.z);
}

std::size_t LinkedProgram::blockSize(const char* block) const {
    context_.makeCurrent();
    const GLuint index = glGetProgramResourceIndex(handle_, GL_SHADER_STORAGE_BLOCK, block);
    if (index == GL_INVALID_INDEX) return 0;
    const GLenum property = GL_BUFFER_DATA_SIZE;
    GLint bytes = 0;
    glGetProgramResourceiv(handle_, GL_SHADER_STORAGE_BLOCK, index, 1, &property, 1, nullptr, &bytes);
    return static_cast<std::size_t>(bytes);
}

void LinkedProgram::use(std::initializer_list<Binding> buffers, std::initializer_list<TextureBinding> textures) {
    context_.makeCurrent();
    glUseProgram(handle_);
    for (const Binding& binding : buffers)
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding.point, binding.buffer.handle());
    for (const TextureBinding& binding : textures) glBindTextureUnit(binding.unit, binding.handle);
}

}  // namespace searchlight::gl
