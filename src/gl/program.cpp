#include "gl/program.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

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
    GLuint handle = glCreateShader(GL_COMPUTE_SHADER);
    ~Shader() { glDeleteShader(handle); }
};

}  // namespace

Program::Program(Context& context, const Source& source) : context_(context) {
    context_.makeCurrent();
    const Shader shader;
    const GLchar* text = source.text().c_str();
    glShaderSource(shader.handle, 1, &text, nullptr);
    glCompileShader(shader.handle);
    GLint good = 0, length = 0;
    glGetShaderiv(shader.handle, GL_COMPILE_STATUS, &good);
    if (!good) {
        glGetShaderiv(shader.handle, GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(length), '\0');
        glGetShaderInfoLog(shader.handle, length, &length, log.data());
        throw rejection(std::string_view(log).substr(0, length), source);
    }
    handle_ = glCreateProgram();
    glAttachShader(handle_, shader.handle);
    glLinkProgram(handle_);
    glDetachShader(handle_, shader.handle);
    glGetProgramiv(handle_, GL_LINK_STATUS, &good);
    if (!good) {
        glGetProgramiv(handle_, GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(length), '\0');
        glGetProgramInfoLog(handle_, length, &length, log.data());
        glDeleteProgram(handle_);
        throw rejection(std::string_view(log).substr(0, length), source);
    }
    context_.checkpoint();
}

Program::~Program() {
    // A context that was lost has taken it along.
    if (context_.tryMakeCurrent()) glDeleteProgram(handle_);
}

void Program::set(const char* uniform, int value) {
    context_.makeCurrent();
    glProgramUniform1i(handle_, glGetUniformLocation(handle_, uniform), value);
}

void Program::set(const char* uniform, float value) {
    context_.makeCurrent();
    glProgramUniform1f(handle_, glGetUniformLocation(handle_, uniform), value);
}

void Program::set(const char* uniform, const Rgb& value) {
    context_.makeCurrent();
    glProgramUniform3f(handle_, glGetUniformLocation(handle_, uniform), static_cast<float>(value.r),
                       static_cast<float>(value.g), static_cast<float>(value.b));
}

std::size_t Program::blockSize(const char* block) const {
    context_.makeCurrent();
    const GLuint index = glGetProgramResourceIndex(handle_, GL_SHADER_STORAGE_BLOCK, block);
    if (index == GL_INVALID_INDEX) return 0;
    const GLenum property = GL_BUFFER_DATA_SIZE;
    GLint bytes = 0;
    glGetProgramResourceiv(handle_, GL_SHADER_STORAGE_BLOCK, index, 1, &property, 1, nullptr, &bytes);
    return static_cast<std::size_t>(bytes);
}

void Program::dispatch(unsigned groups_x, std::initializer_list<Binding> buffers) {
    context_.makeCurrent();
    glUseProgram(handle_);
    for (const Binding& binding : buffers)
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding.point, binding.buffer.handle());
    glDispatchCompute(groups_x, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    context_.checkpoint();
}

}  // namespace searchlight::gl
