#include "gl/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "base/error.h"
#include "base/text.h"
#include "gl/egl.h"

namespace searchlight::gl {

/// What the driver said that is an error, since the last checkpoint.
struct Context::Messages {
    std::vector<std::string> errors;

    static void APIENTRY receive(GLenum source, GLenum type, GLuint, GLenum severity, GLsizei length,
                                 const GLchar* text, const void* self) {
        // The compiler's notices come with the compile log, which Program reads.
        if (source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;
        if (type != GL_DEBUG_TYPE_ERROR && severity != GL_DEBUG_SEVERITY_HIGH) return;
        auto& errors = static_cast<Messages*>(const_cast<void*>(self))->errors;
        if (errors.size() < 8) errors.emplace_back(trim({text, static_cast<std::size_t>(length)}));
    }
};

namespace {

std::string glText(GLenum name) {
    const GLubyte* text = glGetString(name);
    return text ? reinterpret_cast<const char*>(text) : "";
}

bool isSoftware(std::string_view renderer) {
    return renderer.find("llvmpipe") != renderer.npos || renderer.find("softpipe") != renderer.npos ||
           renderer.find("SWR") != renderer.npos;
}

Error lostError() { return deviceError("the OpenGL context was lost: the GPU was reset or taken away"); }

// Hardware devices, then surfaceless (Mesa's choice, mostly llvmpipe), then what is left.
int rank(const Platform& platform) { return platform.hardware ? 0 : platform.device ? 2 : 1; }

std::vector<Platform> chosenPlatforms(std::string_view wish) {
    std::vector<Platform> found = platforms();
    const std::vector<Platform> all = found;
    if (wish.empty()) {
        std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return rank(a) < rank(b); });
        return found;
    }
    const std::string name = parseNumber(wish) ? fmt::format("device {}", wish) : std::string(wish);
    std::erase_if(found, [&](const Platform& p) { return name == "device" ? !p.hardware : p.name != name; });
    if (found.empty()) {
        std::vector<std::string> valid;
        for (const Platform& platform : all) valid.push_back(platform.name);
        throw deviceError(fmt::format("no OpenGL platform '{}' on this machine", wish), "found: " + join(valid, ", "));
    }
    return found;
}

}  // namespace

Context::Context(std::string_view platform) : messages_(std::make_unique<Messages>()) {
    if (const char* wish = std::getenv("SEARCHLIGHT_GL"); platform.empty() && wish) platform = wish;
    std::optional<Error> failure;
    for (const Platform& candidate : chosenPlatforms(platform)) {
        try {
            display_ = openDisplay(candidate);
            context_ = openContext(display_);
            info_.platform = candidate.name;
            break;
        } catch (const Error& error) {
            failure = error;
        }
    }
    if (!context_) throw *failure;
    makeCurrent();
    info_.vendor = glText(GL_VENDOR);
    info_.renderer = glText(GL_RENDERER);
    info_.version = glText(GL_VERSION);
    info_.glsl_version = glText(GL_SHADING_LANGUAGE_VERSION);
    info_.hardware = !isSoftware(info_.renderer);
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(&Messages::receive, messages_.get());
}

Context::~Context() {
    release();
    eglDestroyContext(display_, context_);
}

bool Context::tryMakeCurrent() noexcept {
    return eglGetCurrentContext() == context_ ||
           eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE;
}

void Context::makeCurrent() {
    if (tryMakeCurrent()) return;
    if (lost()) throw lostError();
    throw deviceError("the OpenGL context could not be made current", "another thread holds it");
}

void Context::release() {
    if (eglGetCurrentContext() == context_) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

void Context::checkpoint() {
    if (lost()) throw lostError();
    if (messages_->errors.empty()) return;
    const std::string text = join(messages_->errors, "; ");
    messages_->errors.clear();
    throw deviceError("OpenGL: " + text);
}

double Context::finish() {
    makeCurrent();
    glFinish();
    GLint64 ns = 0;
    glGetInteger64v(GL_TIMESTAMP, &ns);
    checkpoint();
    return static_cast<double>(ns) * 1e-6;
}

bool Context::lost() {
    if (!lost_)
        lost_ = tryMakeCurrent() ? glGetGraphicsResetStatus() != GL_NO_ERROR : eglGetError() == EGL_CONTEXT_LOST;
    return lost_;
}

std::vector<DeviceReport> probe() {
    std::vector<DeviceReport> reports;
    const auto failed = [&](std::string_view platform, const Error& error) {
        reports.push_back({std::string(platform), false, {}, error.message, error.hint});
    };
    try {
        for (const Platform& platform : platforms()) {
            try {
                const std::string wish =
                    platform.device ? platform.name.substr(platform.name.find(' ') + 1) : platform.name;
                const Context context(wish);
                reports.push_back({platform.name, true, context.info(), {}, {}});
            } catch (const Error& error) {
                failed(platform.name, error);
            }
        }
    } catch (const Error& error) {
        failed("EGL", error);
    }
    return reports;
}

}  // namespace searchlight::gl
